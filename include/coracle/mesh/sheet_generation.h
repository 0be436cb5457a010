// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <coracle/base/parameters.h>

#include <array>
#include <vector>

namespace coracle
{
/// Points and the facets between them, the same on all ranks. Corners as in BoundaryFacet.
template <int dim>
struct FacetList
{
  using Corners = std::array<unsigned int, (dim == 2 ? 2 : 4)>;

  std::vector<dealii::Point<dim>> points;
  std::vector<Corners>            facets;
};

/// The options of Mesh/Type that are surfaces without volume.
extern const std::vector<std::string> sheet_types;

/// Their entries, in a section that has the choice `Type`.
void declare_sheets(Declaration &section);

/**
 * The surface that a section `Mesh` describes, scaled, turned and moved as it
 * says. Points at the same place (to 1e-9 of the whole size) are one point, so
 * that lines and parts of a file meet where their points do. In 3-D lines are
 * extruded along z. Throws a UserError for facets without extent and files that
 * cannot be read.
 */
template <int dim>
FacetList<dim> generate_sheets(const Parameters &section);
} // namespace coracle
