// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/point_set.h>
#include <coracle/contact/surface.h>

#include <mpi.h>

namespace coracle::contact
{
/// A point that starts where it may not be.
template <int dim>
struct Overlap
{
  unsigned int  set, point;
  std::uint64_t id;
  /// Where the point is [m].
  dealii::Point<dim> place;
  /// How far it must move to be at the contact distance [m]; infinite deep inside a closed body.
  double        depth;
  unsigned int  body;
  std::uint64_t facet_key;
};

/**
 * Points of this rank that lie inside a closed body, or nearer to a surface than
 * the contact distance R (less 1e-6 of it). Collective. For the start of a run:
 * sends all facets to all ranks with points.
 *
 * Whether a point is deep inside is decided by how often a ray from it meets the
 * body, which needs a body without holes; for others only the neighbourhood of
 * the facets is tested.
 */
template <int dim>
std::vector<Overlap<dim>> initial_overlaps(const Surface<dim>               &owned,
                                           const std::vector<PointSet<dim>> &points,
                                           MPI_Comm                          communicator);
} // namespace coracle::contact
