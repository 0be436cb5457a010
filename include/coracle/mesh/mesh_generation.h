// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>

#include <coracle/base/parameters.h>

namespace coracle
{
/// Entries of a body's section `Mesh`: the shape, or a file, and how it is placed; with sheets also
/// surfaces without volume (sheet_generation.h).
void declare_mesh(Declaration &section, const bool with_sheets = false);

/**
 * The coarse mesh that a section `Mesh` describes, in its own frame (unmoved,
 * unrefined), the same on every rank; curved shapes carry the manifolds that
 * refinement needs. Boundary ids are listed in the parameters' documentation.
 *
 * Throws a UserError for shapes that do not exist in this dimension, files
 * that cannot be read, and elements other than quadrilaterals and hexahedra.
 */
template <int dim>
void generate_mesh(const Parameters &section, dealii::Triangulation<dim> &triangulation);

/// Scale, turn, then move, as the section says; the same for every rank's copy.
template <int dim>
void place_mesh(const Parameters &section, dealii::Triangulation<dim> &triangulation);
} // namespace coracle
