// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>

#include <coracle/base/parameters.h>
#include <coracle/mesh/body_mesh.h>

#include <utility>
#include <vector>

namespace coracle
{
/// A node on an edge or face of a larger neighbour: it moves as the mean of its parents.
struct HangingNode
{
  unsigned int                                 node;
  std::vector<std::pair<unsigned int, double>> parents;
};

/**
 * The mesh of one structural body: elements, nodes and boundary facets of this
 * rank with local numbers, owned nodes first.
 *
 * Kept in a parallel::distributed::Triangulation: every rank stores the whole
 * coarse mesh (about 1 kB an element), refined elements are distributed. Node
 * numbers are those of FE_Q(1). A rank may have no elements and no nodes.
 */
template <int dim>
class StructureMesh : public BodyMesh<dim>
{
public:
  static constexpr unsigned int nodes_per_element = 1u << dim;

  static void declare(Declaration &section);

  /// From a section `Mesh`, see mesh_generation.h for what it may hold.
  StructureMesh(const Parameters &section, MPI_Comm comm);
  /// From a coarse mesh that every rank has, refined as often as given.
  StructureMesh(const dealii::Triangulation<dim> &coarse,
                MPI_Comm                          comm,
                const unsigned int                n_refinements = 0);

  unsigned int  n_elements() const { return elements.size(); }
  std::uint64_t n_global_elements() const override { return triangulation.n_global_active_cells(); }

  unsigned int        n_sheets() const override { return 0; }
  unsigned int        cell_dimension() const override { return dim; }
  unsigned int        n_cells() const override { return elements.size(); }
  const unsigned int *cells() const override
  {
    return elements.empty() ? nullptr : elements.front().data();
  }

  dealii::parallel::distributed::Triangulation<dim> triangulation;
  const dealii::FE_Q<dim>                           fe;
  dealii::DoFHandler<dim>                           dof_handler;

  /// Local nodes of each owned element in deal.II's order (first coordinate runs fastest).
  std::vector<std::array<unsigned int, nodes_per_element>> elements;
  /// Numbers of the elements that do not depend on the ranks.
  std::vector<std::uint64_t> element_keys;
  /// Each element's number among the active cells, for cell data in output.
  std::vector<unsigned int> active_cell_index;
  /// Of owned elements; none in a mesh without local refinement.
  std::vector<HangingNode> hanging_nodes;

private:
  void refine_region(const Parameters &section);
  /// Fill everything from the triangulation as it is.
  void number_nodes();
  void number_elements();
};

extern template class StructureMesh<2>;
extern template class StructureMesh<3>;
} // namespace coracle
