// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <utility>
#include <vector>

namespace coracle::meshless
{
/// The simplices of a Delaunay triangulation.
template <int dim>
struct DelaunayCells
{
  static constexpr unsigned int none = -1;

  /// Points of each cell, positively oriented: det(x1 - x0, ..., xd - x0) > 0 but for round-off.
  std::vector<std::array<unsigned int, dim + 1>> node;
  /// The cell beyond the facet that lacks the i-th point, none outside the convex hull.
  std::vector<std::array<unsigned int, dim + 1>> neighbor;
  /// A pair of points that are at the same place, and how many more points are at one already
  /// taken.
  std::pair<unsigned int, unsigned int> coincident   = {none, none};
  unsigned int                          n_coincident = 0;
};

/**
 * Delaunay triangulation by CGAL with exact predicates. Points on one sphere are
 * triangulated in a way that depends on where they are, not on their order. Of
 * points at the same place all but one are left out. Points in one plane (in
 * 2-D, on one line) have no cells.
 *
 * @param points [m]
 *
 * Source: CGAL's manual, 2D and 3D Triangulations; Devillers & Teillaud (2011),
 * Perturbations for Delaunay and weighted Delaunay 3D triangulations.
 */
template <int dim>
DelaunayCells<dim> delaunay(const std::vector<dealii::Point<dim>> &points);

/// Is the radius of the sphere through these points at most `radius` [m]? In 3-D decided exactly,
/// also for points so near to one circle that a computed centre would be anywhere.
bool radius_is_within(const std::array<dealii::Point<2>, 3> &points, const double radius);
bool radius_is_within(const std::array<dealii::Point<3>, 4> &points, const double radius);
} // namespace coracle::meshless
