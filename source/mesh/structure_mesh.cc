// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>

#include <coracle/mesh/mesh_generation.h>
#include <coracle/mesh/structure_mesh.h>

#include <algorithm>
#include <string>

namespace coracle
{
namespace
{
/// Vertices of the reference cell on each face, so that the outward normal follows surface.h.
template <int dim>
std::array<std::array<unsigned int, BoundaryFacet<dim>::n_nodes>, 2 * dim>
outward_faces()
{
  if constexpr (dim == 2)
    return {{{{2, 0}}, {{1, 3}}, {{0, 1}}, {{3, 2}}}};
  else
    return {{{{0, 4, 6, 2}},
             {{1, 3, 7, 5}},
             {{0, 1, 5, 4}},
             {{2, 6, 7, 3}},
             {{0, 2, 3, 1}},
             {{4, 5, 7, 6}}}};
}

/// Coarse cell, path through the refinement tree (a leading 1, then three bits a level).
template <typename Cell>
std::uint64_t
element_key(const Cell &cell)
{
  constexpr unsigned int path_bits = 3 * StructureMesh<2>::deepest_level + 1;
  const dealii::CellId   id        = cell->id();
  std::uint64_t          path      = 1;
  for (const auto child : id.get_child_indices())
    path = 8 * path + static_cast<unsigned int>(child);
  const std::uint64_t coarse = id.get_coarse_cell_id();
  return (coarse << path_bits) + path;
}

template <typename Cell>
std::uint64_t
facet_key(const Cell &cell, const unsigned int face)
{
  constexpr unsigned int face_bits = 3;
  return (element_key(cell) << face_bits) + face;
}

} // namespace

template <int dim>
StructureMesh<dim>::StructureMesh(const Parameters &section, MPI_Comm comm)
  : triangulation(comm), fe(1), dof_handler(triangulation)
{
  dealii::Triangulation<dim> coarse;
  generate_mesh(section, coarse);
  triangulation.copy_triangulation(coarse);
  triangulation.refine_global(section.integer("Refinements"));
  place_mesh(section, triangulation);
  // Manifolds know the shape where it was generated, not where it is now.
  triangulation.reset_all_manifolds();
  triangulation.set_all_manifold_ids(dealii::numbers::flat_manifold_id);
  number_nodes();
  refine_region(section);
  changes = 0;
}

template <int dim>
StructureMesh<dim>::StructureMesh(const dealii::Triangulation<dim> &coarse,
                                  MPI_Comm                          comm,
                                  const unsigned int                n_refinements)
  : triangulation(comm), fe(1), dof_handler(triangulation)
{
  triangulation.copy_triangulation(coarse);
  triangulation.refine_global(n_refinements);
  number_nodes();
}

template <int dim>
void
StructureMesh<dim>::declare(Declaration &section)
{
  declare_mesh(section);
}

template <int dim>
void
StructureMesh<dim>::refine_region(const Parameters &section)
{
  const std::vector<double> box = section.list("Refined region");
  if (box.empty())
    return;
  if (box.size() != 2 * dim)
    throw section.error("Refined region",
                        "wrong number of coordinates",
                        std::to_string(box.size()) + " of them",
                        "give lower and upper corner, " + std::to_string(2 * dim) + " numbers");
  std::vector<bool> wanted;
  for (const auto &element : elements)
    {
      dealii::Point<dim> centre;
      for (const unsigned int node : element)
        centre += this->nodes[node] / nodes_per_element;
      bool inside = true;
      for (int d = 0; d < dim; ++d)
        inside = inside && box[d] <= centre[d] && centre[d] <= box[dim + d];
      wanted.push_back(inside);
    }
  Columns           no_node_columns, no_element_columns;
  CarriedState<dim> nothing{no_node_columns, no_element_columns, {}};
  refine(wanted, nothing);
}

template <int dim>
void
StructureMesh<dim>::number_nodes()
{
  dof_handler.distribute_dofs(fe);
  // Along the curve of the forest, so that numbers do not depend on the ranks.
  dealii::DoFRenumbering::hierarchical(dof_handler);
  const dealii::IndexSet owned = dof_handler.locally_owned_dofs();
  dealii::IndexSet       needed, relevant;
  dealii::DoFTools::extract_locally_active_dofs(dof_handler, needed);
  dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);

  // Parents of a hanging node may belong to a neighbour's element only.
  dealii::AffineConstraints<double> constraints(relevant);
  dealii::DoFTools::make_hanging_node_constraints(dof_handler, constraints);
  constraints.close();
  dealii::IndexSet with_parents = needed;
  for (const auto node : needed)
    if (constraints.is_constrained(node))
      for (const auto &[parent, weight] : *constraints.get_constraint_entries(node))
        with_parents.add_index(parent);
  dealii::IndexSet ghosts = with_parents;
  ghosts.subtract_set(owned);

  this->exchange      = ColumnExchange(owned, ghosts, triangulation.get_communicator());
  const auto &indices = *this->exchange.indices();
  this->hanging_nodes.clear();
  for (const auto node : needed)
    if (constraints.is_constrained(node))
      {
        HangingNode hanging{indices.global_to_local(node), {}};
        for (const auto &[parent, weight] : *constraints.get_constraint_entries(node))
          hanging.parents.emplace_back(indices.global_to_local(parent), weight);
        // Sums over them must not depend on local numbers.
        std::sort(hanging.parents.begin(),
                  hanging.parents.end(),
                  [&indices](const auto &a, const auto &b) {
                    return indices.local_to_global(a.first) < indices.local_to_global(b.first);
                  });
        this->hanging_nodes.push_back(hanging);
      }
  number_elements();
}

template <int dim>
void
StructureMesh<dim>::number_elements()
{
  const auto &indices = *this->exchange.indices();
  // Parents that are corners of no element here get their positions from their owners.
  Columns positions(dim);
  positions.resize(this->n_nodes());
  elements.clear();
  this->facets.clear();
  active_cell_index.clear();
  element_keys.clear();
  levels.clear();

  std::vector<typename dealii::DoFHandler<dim>::active_cell_iterator> cells;
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      cells.push_back(cell);
  std::sort(cells.begin(), cells.end(), [](const auto &a, const auto &b) {
    return a->id() < b->id();
  });
  std::vector<dealii::types::global_dof_index> cell_nodes(nodes_per_element);
  for (const auto &cell : cells)
    {
      cell->get_dof_indices(cell_nodes);
      auto &element = elements.emplace_back();
      for (unsigned int v = 0; v < nodes_per_element; ++v)
        {
          element[v] = indices.global_to_local(cell_nodes[v]);
          for (int d = 0; d < dim; ++d)
            positions[d][element[v]] = cell->vertex(v)[d];
        }
      active_cell_index.push_back(cell->active_cell_index());
      element_keys.push_back(element_key(cell));
      levels.push_back(cell->level());
      add_facets(cell);
    }
  weight.assign(elements.size(), 1.);

  this->exchange.update_ghosts(positions, 0, dim);
  this->nodes.resize(this->n_nodes());
  for (unsigned int n = 0; n < this->n_nodes(); ++n)
    for (int d = 0; d < dim; ++d)
      this->nodes[n][d] = positions[d][n];
}

// Of the last element.
template <int dim>
void
StructureMesh<dim>::add_facets(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell)
{
  const auto faces = outward_faces<dim>();
  for (const unsigned int f : cell->face_indices())
    if (cell->face(f)->at_boundary())
      {
        BoundaryFacet<dim> facet{{},
                                 n_elements() - 1,
                                 cell->face(f)->boundary_id(),
                                 facet_key(cell, f)};
        for (unsigned int v = 0; v < facet.n_nodes; ++v)
          facet.nodes[v] = elements.back()[faces[f][v]];
        this->facets.push_back(facet);
      }
}

template class StructureMesh<2>;
template class StructureMesh<3>;
} // namespace coracle
