// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/nearest_point.h>

namespace coracle::contact
{
/// Corners of a facet: 2 in 2-D, 3 or 4 in 3-D (a triangle repeats its last node).
template <int dim>
inline unsigned int
n_corners(const Facet<dim> &facet)
{
  if constexpr (dim == 3)
    if (facet.nodes[3] == facet.nodes[2])
      return 3;
  return vertices_per_facet<dim>;
}

/**
 * Which facets meet at a node, and what follows from it: whether a point of an
 * edge or vertex is a minimum for all facets there, and the pseudonormal.
 */
template <int dim>
class SurfaceTopology
{
public:
  /// To be called when facets have come, gone or been renumbered. The surface must outlive this
  /// object.
  void reinit(const Surface<dim> &surface);

  /**
   * Does the distance to x_p grow in every direction along the surface from
   * this nearest point of one facet? Always so inside a facet.
   */
  bool is_minimum(const dealii::Point<dim> &x_p,
                  const unsigned int        facet,
                  const NearestPoint<dim>  &nearest) const;

  /// Unit normal; at edges and vertices the sum over the body's facets there, weighted by angle:
  /// where sheets are joined (surfaces of their own, with nodes in common) each has its own sides.
  struct Pseudonormal
  {
    dealii::Tensor<1, dim> normal;
    /// The place is on an edge (in 2-D: a vertex) that only one facet has.
    bool rim;
  };

  /**
   * The side of a surface on which a point lies is the sign of its offset from
   * the nearest point times the pseudonormal there (Baerentzen & Aanaes, Signed
   * distance computation using the angle weighted pseudonormal, 2005).
   */
  Pseudonormal pseudonormal(const unsigned int facet, const NearestPoint<dim> &nearest) const;

  /// Do these name the same edge or vertex?
  bool same_feature(const unsigned int       facet_a,
                    const NearestPoint<dim> &a,
                    const unsigned int       facet_b,
                    const NearestPoint<dim> &b) const;

private:
  const dealii::Point<dim> &position(const unsigned int node) const
  {
    return surface->nodes[node].position;
  }

  const Surface<dim>       *surface = nullptr;
  std::vector<unsigned int> begin;
  std::vector<unsigned int> facets;
};
} // namespace coracle::contact
