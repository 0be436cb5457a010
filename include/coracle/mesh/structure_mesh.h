// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>

#include <coracle/base/parameters.h>
#include <coracle/mesh/column_exchange.h>

#include <array>
#include <cstdint>
#include <vector>

namespace coracle
{
/// A boundary face of an element on this rank.
template <int dim>
struct BoundaryFacet
{
  static constexpr unsigned int n_nodes = (dim == 2 ? 2 : 4);

  /// Local node numbers. 2-D: the body lies to the left of 0 -> 1; 3-D: counter-clockwise from
  /// outside.
  std::array<unsigned int, n_nodes> nodes;
  /// Local number of the element it belongs to.
  unsigned int element;
  unsigned int boundary_id;
  /// Unique over ranks and independent of their number.
  std::uint64_t key;
};

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
class StructureMesh
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
  StructureMesh(const StructureMesh &) = delete;

  unsigned int  n_elements() const { return elements.size(); }
  unsigned int  n_owned_nodes() const { return exchange.n_owned(); }
  unsigned int  n_nodes() const { return exchange.n_local(); }
  std::uint64_t n_global_elements() const { return triangulation.n_global_active_cells(); }
  std::uint64_t n_global_nodes() const { return dof_handler.n_dofs(); }
  /// Global number of a local node, the same for any rank that has it.
  std::uint64_t key(const unsigned int node) const
  {
    return exchange.indices()->local_to_global(node);
  }
  int      owner(const unsigned int node) const { return exchange.owner(node); }
  MPI_Comm communicator() const { return triangulation.get_communicator(); }

  dealii::parallel::distributed::Triangulation<dim> triangulation;
  const dealii::FE_Q<dim>                           fe;
  dealii::DoFHandler<dim>                           dof_handler;

  /// Layout of node columns, and their sums over ranks.
  ColumnExchange exchange;
  /// Reference positions of all local nodes [m].
  std::vector<dealii::Point<dim>> nodes;
  /// Local nodes of each owned element in deal.II's order (first coordinate runs fastest).
  std::vector<std::array<unsigned int, nodes_per_element>> elements;
  /// Each element's number among the active cells, for cell data in output.
  std::vector<unsigned int> active_cell_index;
  /// Boundary faces of owned elements.
  std::vector<BoundaryFacet<dim>> facets;
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
