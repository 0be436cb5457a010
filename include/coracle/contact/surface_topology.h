// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/nearest_point.h>

#include <unordered_map>

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
 * edge or vertex is a minimum for all facets there, and the pseudonormal. Where a
 * node hangs (3-D), the edge of the larger facet and its halves, which smaller facets
 * have, are one edge.
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

  /// A facet at an edge: the corner that the edge starts from there, and a position along it.
  struct AtEdge
  {
    unsigned int facet, corner;
    double       s;
  };
  static constexpr unsigned int none = -1;

  /// Node that hangs in the middle of an edge, or none.
  unsigned int middle_of(const unsigned int a, const unsigned int b) const;
  /// Calls action(AtEdge) for the facets with exactly this edge, at s along it from a to b.
  template <typename Action>
  void
  on_edge(const unsigned int a, const unsigned int b, const double s, const Action &action) const;
  /// For all facets at the edge of `nearest`, also larger and smaller ones.
  template <typename Action>
  void
  at_edge(const unsigned int facet, const NearestPoint<dim> &nearest, const Action &action) const;
  /// For the larger facets in the middle of whose edge a node hangs.
  template <typename Action>
  void                   at_middle(const unsigned int node, const Action &action) const;
  dealii::Tensor<1, dim> inward(const AtEdge &at) const;
  Pseudonormal normal_inside(const unsigned int facet, const NearestPoint<dim> &nearest) const;
  Pseudonormal normal_at_vertex(const unsigned int node, const unsigned int body) const;

  const Surface<dim>       *surface = nullptr;
  std::vector<unsigned int> begin;
  std::vector<unsigned int> facets;
  /// Hanging nodes by the ends of their edges, the lower one first.
  std::unordered_map<std::uint64_t, unsigned int> middles;
};

template <>
typename SurfaceTopology<2>::Pseudonormal
SurfaceTopology<2>::pseudonormal(const unsigned int, const NearestPoint<2> &) const;
template <>
typename SurfaceTopology<3>::Pseudonormal
SurfaceTopology<3>::pseudonormal(const unsigned int, const NearestPoint<3> &) const;
template <>
dealii::Tensor<1, 3> SurfaceTopology<3>::inward(const AtEdge &) const;
} // namespace coracle::contact
