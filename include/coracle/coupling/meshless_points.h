// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/octree.h>
#include <coracle/meshless/fluid.h>

namespace coracle
{
/// Section `Regions` of a meshless fluid.
void declare_regions(Declaration &body);

/// Densities and viscosities of the regions, in the order of their names.
template <int dim>
void read_regions(const Parameters &body, meshless::FluidOptions<dim> &options);

/**
 * The points of a meshless fluid and of its regions at the start, each of a
 * lattice over the box around its shape, on the ranks whose leaves they are in.
 * Where shapes overlap regions come first, the one named first of all; others
 * keep half a spacing off.
 *
 * Collective; throws UserError.
 */
template <int dim>
void
generate_points(const Parameters &body, const Octree<dim> &octree, meshless::Fluid<dim> &fluid);

/// Points that slide on structures, where these are beside the fluid and it slips. Their ids follow
/// those of the others. Collective.
template <int dim>
void put_points_on_structures(const Parameters     &body,
                              const Octree<dim>    &octree,
                              meshless::Fluid<dim> &fluid);
} // namespace coracle
