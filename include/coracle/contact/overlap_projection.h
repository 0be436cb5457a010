// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/initial_overlaps.h>

namespace coracle::contact
{
/// Where a point that overlaps a surface is to be put.
template <int dim>
struct Projection
{
  /// The point, as in Overlap.
  unsigned int       set, point;
  dealii::Point<dim> place;
};

/**
 * Places at the contact distance for points that overlap surfaces: out along the
 * normal of every contact that is too near, again and again, so that a point in a
 * corner gets away from all its walls; from deep inside a body first to its
 * nearest face. A point keeps the side of a sheet that it starts on (it is
 * written to PointSet::side).
 *
 * Where there is no such place, as between two walls that are too close, the
 * result is as good as the iteration got; the caller finds out by
 * initial_overlaps(). Collective.
 *
 * @param overlaps of this rank's points, from initial_overlaps()
 * @return one for each point in the list, in the order of set and point
 */
template <int dim>
std::vector<Projection<dim>> project_overlaps(const Surface<dim>               &owned,
                                              const std::vector<PointSet<dim>> &points,
                                              const std::vector<Overlap<dim>>  &overlaps,
                                              MPI_Comm                          communicator);
} // namespace coracle::contact
