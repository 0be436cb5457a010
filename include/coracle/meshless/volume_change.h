// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/period.h>
#include <coracle/meshless/tessellation.h>

#include <mpi.h>

namespace coracle::meshless
{
/// A facet of the fluid's boundary that knows its points wherever they are.
template <int dim>
struct BoundaryFacet
{
  std::array<std::uint64_t, dim>      id;
  std::array<dealii::Point<dim>, dim> position;
};

/// This rank's boundary facets, with points where they are now.
template <int dim>
std::vector<BoundaryFacet<dim>> boundary_of(const PointCloud<dim>   &points,
                                            const Tessellation<dim> &tessellation);

/// Volume that the fluid gained and lost [m^dim], both positive.
struct VolumeChange
{
  double appeared = 0., disappeared = 0.;
};

/**
 * Volume that appears and disappears when points that have moved are
 * tessellated anew: the difference between the elements before, carried along,
 * and after.
 *
 * The facets that are boundary only before or only after enclose what has
 * changed. They fall into closed surfaces (facets that share points in 2-D,
 * edges in 3-D); each encloses a volume that appeared or disappeared, whose sum
 * is the change of the total to round-off. Where gain and loss touch along such
 * an edge, their net counts.
 *
 * @param before boundary of the old tessellation, after its points have moved
 * @param after  boundary of the new one
 * @param period where there is one, a surface's facets are taken at the places nearest to its
 *               first; it must be shorter than half a period
 * @return sums over all ranks, on all ranks. Collective.
 *
 * Facets travel to the rank that compares them; those that have changed, to rank 0.
 */
template <int dim>
VolumeChange volume_change(const std::vector<BoundaryFacet<dim>> &before,
                           const std::vector<BoundaryFacet<dim>> &after,
                           const MPI_Comm                         comm,
                           const Period<dim>                     &period = {});
} // namespace coracle::meshless
