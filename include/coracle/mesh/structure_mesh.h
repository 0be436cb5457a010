// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>

#include <coracle/base/parameters.h>
#include <coracle/mesh/body_mesh.h>

#include <functional>
#include <utility>
#include <vector>

namespace coracle
{
/// What refinement carries from a mesh to the next one, and what it tells of that.
template <int dim>
struct CarriedState
{
  /// One row for each local node: new nodes get the mean of the nodes around them, on an edge, in a
  /// face or in an element; the others keep theirs, bit by bit. All ranks know all they have.
  Columns &nodes;
  /// One row for each element.
  Columns &elements;
  /// Row of a part of an element; bit b of `child` tells its side in direction b.
  std::function<void(const double *parent, const unsigned int child, double *row)> child_row;

  /// Afterwards: which elements are parts of one that was there before, and which nodes are new.
  std::vector<bool> is_child = {}, is_new_node = {};
};

/**
 * The mesh of one structural body: elements, nodes and boundary facets of this
 * rank with local numbers, owned nodes first.
 *
 * Kept in a parallel::distributed::Triangulation: every rank stores the whole
 * coarse mesh (about 1 kB an element), refined elements are distributed. Node
 * numbers are those of FE_Q(1). A rank may have no elements and no nodes. Elements
 * are numbered along the forest's curve, so that the numbers do not depend on how
 * the mesh has come about.
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

  /**
   * Halves the elements asked for in all directions, and others so that neighbours differ by one
   * level at most; then shares the elements out by their weights, parts being as heavy as the
   * whole. Parts of elements fill them exactly, as shape functions say, so that the surface stays
   * where it is. Collective.
   *
   * @param wanted by element
   * @return has anything changed, on any rank?
   */
  bool refine(const std::vector<bool> &wanted, CarriedState<dim> &state);

  /// Elements are shared out by these from now on; before they count alike. Collective.
  /// @param by_element more than 0; a thousandth of 1 is the finest difference that counts
  void set_weights(const std::vector<double> &by_element);
  /// The same elements on other ranks, by their weights. Collective.
  void share_out(CarriedState<dim> &state);
  /// Those that the elements were last shared out by; all 1 if they count alike.
  const std::vector<double> &weights() const { return weight; }
  bool                       is_weighted() const { return weighted; }

  /// Which of the elements with these keys are wanted? Collective.
  using AreThere = std::function<std::vector<bool>(const std::vector<std::uint64_t> &keys)>;
  /// Refines until all elements are wanted ones; the positions of nodes are those of the mesh as it
  /// was. Collective.
  void refine_to(const AreThere &are_there);

  /// How often the mesh has changed, or has been shared out anew, since it was made.
  unsigned int n_changes() const { return changes; }

  /// How often an element has been halved since the coarse mesh.
  unsigned int level(const unsigned int element) const { return levels[element]; }
  /// No element may be halved more often.
  static constexpr unsigned int deepest_level = 11;

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

private:
  class Carrier;

  /// Does what changes the forest, and takes the state along.
  void carry(CarriedState<dim> &state, const std::function<void()> &change);
  void refine_region(const Parameters &section);
  /// Fill everything from the triangulation as it is.
  void number_nodes();
  void number_elements();
  void add_facets(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell);
  /// Vertices of this rank's cells become the nodes, also where refinement has put them elsewhere.
  void move_vertices();

  unsigned int              changes = 0;
  std::vector<unsigned int> levels;
  std::vector<double>       weight;
  bool                      weighted = false;
};

extern template class StructureMesh<2>;
extern template class StructureMesh<3>;
} // namespace coracle
