// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>

#include <coracle/base/mesh_file.h>
#include <coracle/mesh/sheet_generation.h>

namespace coracle
{
/**
 * The quadrilaterals (2-D) or hexahedra (3-D) of a file as a coarse mesh, with
 * the ids of the faces that are in the file, too; turned over where their
 * volume is negative. deal.II takes any connections for granted, so they are
 * checked before: a face belongs to one element or to two on either side of it,
 * every element has a volume, and no other elements of this dimension are there.
 * Throws FileError.
 */
template <int dim>
void make_triangulation(const MeshFile &file, dealii::Triangulation<dim> &triangulation);

/// The quadrilaterals and triangles (in 2-D: lines) of a file, and their points. Throws FileError
/// where there are none, or volumes.
template <int dim>
FacetList<dim> make_facets(const MeshFile &file);
} // namespace coracle
