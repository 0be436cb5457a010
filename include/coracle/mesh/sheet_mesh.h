// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>
#include <coracle/mesh/body_mesh.h>
#include <coracle/mesh/sheet_generation.h>

#include <string>

namespace coracle
{
/**
 * The mesh of a body that is a surface without volume: one sheet or several,
 * with free edges, folds and junctions, see sheet_patches.h.
 *
 * Every rank reads the whole surface and keeps an even share of its facets,
 * neighbouring ones as they are listed. A node belongs to the first rank that
 * has a facet there; node and facet numbers do not depend on the number of ranks.
 */
template <int dim>
class SheetMesh : public BodyMesh<dim>
{
public:
  static constexpr unsigned int nodes_per_facet = BoundaryFacet<dim>::n_nodes;

  /// From a section `Mesh` whose Type is one of sheet_types. Collective; throws UserError.
  SheetMesh(const Parameters &section, MPI_Comm comm);

  unsigned int  n_sheets() const override { return n_patches; }
  std::uint64_t n_global_elements() const override { return n_global_facets; }

  unsigned int        cell_dimension() const override { return dim - 1; }
  unsigned int        n_cells() const override { return output_cells.size(); }
  const unsigned int *cells() const override
  {
    return output_cells.empty() ? nullptr : output_cells.front().data();
  }

private:
  using Corners = typename FacetList<dim>::Corners;

  /// Points in the order in which facets meet them; others are dropped.
  static void renumber(FacetList<dim> &surface);
  void        distribute(const FacetList<dim> &surface, MPI_Comm comm);

  unsigned int              n_patches       = 0;
  std::uint64_t             n_global_facets = 0;
  std::vector<unsigned int> patch_of_facet;
  std::vector<Corners>      output_cells;
};

extern template class SheetMesh<2>;
extern template class SheetMesh<3>;
} // namespace coracle
