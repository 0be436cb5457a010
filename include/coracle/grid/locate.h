// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/box_boundary.h>
#include <coracle/particles/material_points.h>

namespace coracle
{
/**
 * Particles take their next positions; those outside their home cell become
 * strays, those on another rank's leaves are sent there, those that left
 * through an open face are removed and counted. Collective.
 *
 * Throws RunFailure, on the rank concerned only and after all communication, for a particle that is
 * outside of the box other than through an open face, or where no neighbouring rank has a leaf: it
 * names the particle, the place and the face.
 *
 * @param margin_of_shape 0, or the part of a particle's size that it reaches out (GIMP: 0.5)
 * @return particles that this rank received
 */
template <int dim>
unsigned int move_and_locate(const Octree<dim>      &octree,
                             const BoxBoundary<dim> &boundary,
                             const double            margin_of_shape,
                             const double            time,
                             MaterialPoints<dim>    &points);

/**
 * After the octree has changed: every particle goes to the rank whose leaf it is in, whichever that
 * is now, and all are sorted. Collective.
 */
template <int dim>
void
redistribute(const Octree<dim> &octree, const double margin_of_shape, MaterialPoints<dim> &points);

/// Sort the particles by their leaf. All of them must be on this rank's leaves.
template <int dim>
void
sort_by_leaf(const Octree<dim> &octree, const double margin_of_shape, MaterialPoints<dim> &points);
} // namespace coracle
