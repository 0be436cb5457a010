// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace coracle::meshless
{
/// What a point of the meshless fluid is.
enum class PointKind : unsigned char
{
  fluid,
  /// Face of the box or surface of a structure: bounds the fluid, and is never a free surface.
  wall,
  /// Moves with the fluid, on the surface of a structure: bounds it, as those.
  sliding
};

/**
 * Points of the meshless fluid, a column per quantity. The first n_own rows are
 * this rank's; what follows are copies of other ranks' points (see Halo).
 */
template <int dim>
struct PointCloud
{
  std::size_t n_own = 0;
  /// Current position [m].
  std::vector<dealii::Point<dim>> position;
  /// Distance h(x) to neighbours that the point is meant to have [m].
  std::vector<double> spacing;
  /// Unique through all ranks; ids decide every tie, so that nothing depends on ranks or order.
  std::vector<std::uint64_t> id;
  std::vector<PointKind>     kind;

  std::size_t size() const { return position.size(); }
};
} // namespace coracle::meshless
