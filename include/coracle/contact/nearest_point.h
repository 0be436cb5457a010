// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact.h>
#include <coracle/contact/nearest_point_pack.h>

#include <utility>

namespace coracle::contact
{
/// Where a facet is nearest to a point.
template <int dim>
struct NearestPoint
{
  /// Weights of the facet's nodes, sum 1.
  std::array<double, vertices_per_facet<dim>> weights;
  /// Nearest point x_c and the square of its distance [m, m^2].
  dealii::Point<dim> place;
  double             distance_square;
  Region             region;
  /// Edge: corner at its start (the edge goes on to the next corner). Vertex: the corner.
  unsigned char feature;
};

/**
 * Natural coordinates nearer to the facet's edge than this count as on the
 * edge: round-off must not hide that two facets meet there. The facet measures
 * 2 in these coordinates.
 */
constexpr double edge_tolerance = 1e-10;

/// Nearest point of the segment from vertex 0 to vertex 1.
NearestPoint<2> nearest_point(const dealii::Point<2>                &x_p,
                              const std::array<dealii::Point<2>, 2> &vertices);

/// Nearest point of a triangle; it is the facet {0, 1, 2, 2}, whose last weight is 0.
NearestPoint<3> nearest_point_triangle(const dealii::Point<3>                &x_p,
                                       const std::array<dealii::Point<3>, 4> &vertices);

/**
 * Nearest point of a bilinear facet to a point in space.
 *
 * Minimises |x_p - x(xi, eta)|^2 over the closed square [-1,1]^2, so that the
 * result may lie inside the facet, on an edge or at a vertex; which of them is
 * reported, because only some of these are contacts of the whole surface
 * (see SurfaceMinimum).
 *
 * Newton's iteration on eta, with the best xi of each eta in closed form, ends
 * in a local minimum; that it is the global one is then proven (global_minimum.h)
 * or the search goes on. So the answer is never another local minimum that is
 * farther by more than 1e-10 of the facet's size. Many pairs at once are
 * much faster: NearestPointBatch, whose results are the same.
 *
 * @param x_p      point, current configuration [m]
 * @param vertices four corners, counter-clockwise seen from outside [m]
 *
 * Never fails: a facet that has collapsed to an edge or a point is answered by
 * that edge or point.
 *
 * Source: the definition is Song, Liu & Zhang (2020), Eq. 35; their steepest
 * descent (Eqs. 41-51) is in steepest_descent.h.
 */
NearestPoint<3> nearest_point(const dealii::Point<3>                &x_p,
                              const std::array<dealii::Point<3>, 4> &vertices);

/// The corners as seen from the point.
inline NearestPointBatch::Corners
relative_corners(const dealii::Point<3> &x_p, const std::array<dealii::Point<3>, 4> &vertices)
{
  NearestPointBatch::Corners x;
  for (unsigned int k = 0; k < 4; ++k)
    for (int d = 0; d < 3; ++d)
      x[k][d] = vertices[k][d] - x_p[d];
  return x;
}

/// Weights, place, distance and region of natural coordinates that a search has found.
NearestPoint<3> describe(const dealii::Point<3>                &x_p,
                         const std::array<dealii::Point<3>, 4> &vertices,
                         const double                           xi,
                         const double                           eta);
} // namespace coracle::contact
