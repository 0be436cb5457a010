// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace coracle::contact
{
/**
 * What contact sees of one body of material points, or of the surface nodes of
 * one structural body: a view of the caller's columns, no copies. Valid until the caller moves or
 * resizes the columns.
 *
 * A point's place in the columns is its index; contact lists candidates by
 * index, so that the caller must say when points were renumbered
 * (ContactSystem::points_renumbered). Its id stays with it for life and ties
 * the impulses of one step to those of the next.
 */
template <int dim>
struct PointSet
{
  unsigned int n_points = 0;

  /// Columns of the coordinates [m] and of the velocity at the middle of the step [m/s].
  std::array<const double *, dim> position{};
  std::array<const double *, dim> velocity{};

  /// A bound of all points' speeds if the caller has one [m/s]; negative: contact looks for itself.
  double maximum_speed = -1;

  /// Where a mass is 0, the row is a hole in the columns and no point; null: all are points.
  const double *mass = nullptr;

  /// Radius r per point [m]; where the column is null, the constant holds.
  const double *radius_column   = nullptr;
  double        constant_radius = 0;

  /// Identity of each point; null: id_offset plus the index.
  const std::uint64_t *ids       = nullptr;
  std::uint64_t        id_offset = 0;

  /**
   * Points group_begin[i] up to group_begin[i+1] lie close together (one leaf
   * of the octree). Points before the first and behind the last group, and all
   * if there are no groups, are taken in small chunks as they come.
   */
  std::vector<unsigned int> group_begin;

  /**
   * Per sheet (SurfaceBody::sheet) a column of the side that a point belongs
   * to: -1, +1, or 0 while it is outside the band; twice that once it has passed
   * to the other side. The caller stores it with the point; contact reads and
   * writes it.
   */
  std::vector<double *> side;

  /// Points that are surface nodes of a structural body: its index (its first, where it has
  /// several) in Surface::bodies; else -1.
  int body = -1;
  /// Of each of these points, its index in the nodes of the owned surface. Ids are the nodes' keys.
  const unsigned int *surface_node = nullptr;
  /// Candidates reach at least this much farther than needed [m]: radii of nodes are small.
  double least_skin = 0;

  /**
   * May this point touch this facet? Nodes touch no facet that they belong to, facets of
   * their own body only where that is asked for, and none where neither body can move.
   */
  bool may_touch(const unsigned int i, const Surface<dim> &surface, const Facet<dim> &facet) const
  {
    if (body < 0)
      return true;
    const auto &own = surface.bodies[body], &other = surface.bodies[facet.body];
    if (own.part != other.part)
      return own.movable || other.movable;
    return own.self_contact &&
           std::none_of(facet.nodes.begin(), facet.nodes.end(), [&](const unsigned int node) {
             return surface.nodes[node].key == ids[i];
           });
  }

  bool is_hole(const unsigned int i) const { return mass != nullptr && mass[i] == 0; }

  dealii::Point<dim> point(const unsigned int i) const
  {
    dealii::Point<dim> x;
    for (int d = 0; d < dim; ++d)
      x[d] = position[d][i];
    return x;
  }

  dealii::Tensor<1, dim> point_velocity(const unsigned int i) const
  {
    dealii::Tensor<1, dim> v;
    if (velocity[0] != nullptr)
      for (int d = 0; d < dim; ++d)
        v[d] = velocity[d][i];
    return v;
  }

  double radius(const unsigned int i) const
  {
    return radius_column == nullptr ? constant_radius : radius_column[i];
  }

  std::uint64_t id(const unsigned int i) const { return ids == nullptr ? id_offset + i : ids[i]; }
};

/// Is a point with this entry of a sheet's side column on the side that it does not belong to?
inline bool
has_passed(const double side)
{
  return std::abs(side) > 1.5;
}
} // namespace coracle::contact
