// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/distributed/p4est_wrappers.h>

#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/affine_constraints.h>

#include <coracle/base/mpi.h>
#include <coracle/grid/octree.h>

#include <map>

namespace coracle
{
template <int dim>
Octree<dim>::Octree(const OctreeDescription<dim> &description,
                    const std::function<double(const dealii::Point<dim> &, const double)> &weight,
                    MPI_Comm communicator,
                    Archive *saved)
  : triangulation(communicator,
                  dealii::Triangulation<dim>::none,
                  dealii::parallel::distributed::Triangulation<dim>::default_setting)
  , dof_handler(triangulation)
  , description(description)
  , fe(1)
{
  make_coarse_grid();
  if (saved == nullptr)
    refine();
  else
    load(*saved);
  if (weight && saved == nullptr)
    partition(weight);
  number();
}

template <int dim>
void
Octree<dim>::number()
{
  dof_handler.distribute_dofs(fe);
  dealii::DoFRenumbering::hierarchical(dof_handler);
  enumerate();
  make_hanging_nodes();
  find_first_places();
}

template <int dim>
void
Octree<dim>::make_coarse_grid()
{
  const auto &[lower, upper] = description.box.get_boundary_points();
  std::vector<unsigned int> n_cells(dim);
  for (unsigned int d = 0; d < dim; ++d)
    n_cells[d] = std::lround((upper[d] - lower[d]) / description.cell_size);
  n_coarse_cells      = n_cells;
  const auto all_even = [&] {
    return std::all_of(n_coarse_cells.begin(), n_coarse_cells.end(), [](const unsigned int n) {
      return n % 2 == 0;
    });
  };
  while (all_even())
    {
      for (unsigned int &n : n_coarse_cells)
        n /= 2;
      ++base_level;
    }
  dealii::GridGenerator::subdivided_hyper_rectangle(
    triangulation, n_coarse_cells, lower, upper, true);
}

template <int dim>
void
Octree<dim>::refine()
{
  triangulation.refine_global(base_level);
  for (bool changed = true; changed;)
    {
      changed = false;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const auto &refinement : description.refinements)
            if (cell->level() < static_cast<int>(base_level + refinement.level) &&
                refinement.meets(cell->vertex(0), cell->extent_in_direction(0)))
              {
                cell->set_refine_flag();
                changed = true;
              }
      changed = dealii::Utilities::MPI::logical_or(changed, triangulation.get_communicator());
      if (changed)
        triangulation.execute_coarsening_and_refinement();
    }
}

template <int dim>
void
Octree<dim>::partition(
  const std::function<double(const dealii::Point<dim> &, const double)> &weight)
{
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
  const auto connection =
    triangulation.signals.weight.connect([&](const typename Triangulation::cell_iterator &cell,
                                             const typename Triangulation::CellStatus) {
      // Nothing is added to these weights: the cell itself counts here.
      return static_cast<unsigned int>(1000. *
                                       (1. + weight(cell->center(), cell->extent_in_direction(0))));
    });
  triangulation.repartition();
  connection.disconnect();
}

template <int dim>
void
Octree<dim>::enumerate()
{
  // Order of the space-filling curve, through all ranks: coarse cell, then child by child.
  using NumberedCell = typename dealii::DoFHandler<dim>::active_cell_iterator;
  std::vector<NumberedCell> cells;
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (!cell->is_artificial())
      cells.push_back(cell);
  // Coarse cells of ids are p4est's trees.
  const auto curve = [](const NumberedCell &a, const NumberedCell &b) {
    if (a->is_locally_owned() != b->is_locally_owned())
      return a->is_locally_owned();
    return a->id() < b->id();
  };
  std::sort(cells.begin(), cells.end(), curve);

  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  exchange.reinit(dof_handler.locally_owned_dofs(), relevant, triangulation.get_communicator());
  positions.resize(exchange.n_owned() + exchange.n_ghosts());

  std::array<unsigned int, dim> n;
  std::copy(n_coarse_cells.begin(), n_coarse_cells.end(), n.begin());
  const auto  &corners     = description.box.get_boundary_points();
  const double coarse_size = std::ldexp(description.cell_size, base_level);
  tree.reinit(corners.first, corners.second, n);

  n_owned = 0;
  leaf_nodes.clear();
  leaf_lower.clear();
  leaf_size.clear();
  leaf_owner.clear();
  leaf_level.clear();
  leaf_of_active_cell.assign(triangulation.n_active_cells(), -1);
  std::vector<dealii::types::global_dof_index> dofs(n_corners);
  for (const NumberedCell &cell : cells)
    {
      const unsigned int leaf = leaf_nodes.size();
      n_owned += cell->is_locally_owned();
      cell->get_dof_indices(dofs);
      leaf_nodes.emplace_back();
      for (unsigned int c = 0; c < n_corners; ++c)
        {
          leaf_nodes.back()[c]            = exchange.indices().global_to_local(dofs[c]);
          positions[leaf_nodes.back()[c]] = cell->vertex(c);
        }
      leaf_lower.push_back(cell->vertex(0));
      leaf_size.push_back(std::ldexp(coarse_size, -cell->level()));
      leaf_owner.push_back(cell->subdomain_id());
      leaf_level.push_back(cell->level() - base_level);
      leaf_of_active_cell[cell->active_cell_index()] = leaf;
      tree.insert(cell->center(), cell->level(), leaf);
    }
}

// Parents of the hanging nodes between leaves that this rank knows.
template <int dim>
std::vector<typename Octree<dim>::Parent>
Octree<dim>::find_parents() const
{
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  dealii::AffineConstraints<double> constraints(relevant);
  dealii::DoFTools::make_hanging_node_constraints(dof_handler, constraints);
  constraints.close();
  std::vector<Parent> result;
  for (const auto &line : constraints.get_lines())
    for (const auto &[node, weight] : line.entries)
      {
        Assert(relevant.is_element(line.index) && relevant.is_element(node),
               dealii::ExcInternalError());
        Parent parent{line.index, node, weight, {}};
        for (unsigned int d = 0; d < dim; ++d)
          parent.place[d] = positions[exchange.indices().global_to_local(node)][d];
        result.push_back(parent);
      }
  return result;
}

// Nodes on the far side of ghost leaves may hang on leaves that this rank does not know. Their
// owners know, and tell all that have such a node as a ghost.
template <int dim>
std::vector<typename Octree<dim>::Parent>
Octree<dim>::find_far_parents(const std::vector<Parent> &known) const
{
  std::multimap<dealii::types::global_dof_index, Parent> parents;
  for (const Parent &parent : known)
    parents.emplace(parent.hanging, parent);

  std::map<unsigned int, std::vector<Parent>> to_send;
  auto                                        range = exchange.indices().import_indices().begin();
  for (const auto &[rank, count] : exchange.indices().import_targets())
    for (unsigned int n = 0; n < count; ++range)
      for (unsigned int i = range->first; i < range->second; ++i, ++n)
        {
          const auto [first, last] = parents.equal_range(global_node(i));
          for (auto p = first; p != last; ++p)
            to_send[rank].push_back(p->second);
        }

  std::vector<Parent> result;
  for (const auto &[rank, received] :
       mpi::exchange_values(to_send, exchange.indices().get_mpi_communicator()))
    for (const Parent &parent : received)
      if (parents.count(parent.hanging) == 0)
        result.push_back(parent);
  return result;
}

// Ghost nodes get new local numbers; owned ones keep theirs.
template <int dim>
void
Octree<dim>::add_ghosts(const std::vector<Parent> &parents)
{
  const NodeExchange before = exchange;
  dealii::IndexSet   known(dof_handler.n_dofs());
  known.add_indices(before.indices().locally_owned_range());
  known.add_indices(before.indices().ghost_indices());
  for (const Parent &parent : parents)
    known.add_index(parent.parent);
  exchange.reinit(dof_handler.locally_owned_dofs(), known, triangulation.get_communicator());

  std::vector<unsigned int>       number(positions.size());
  std::vector<dealii::Point<dim>> places(exchange.n_owned() + exchange.n_ghosts());
  for (const Parent &parent : parents)
    for (unsigned int d = 0; d < dim; ++d)
      places[exchange.indices().global_to_local(parent.parent)][d] = parent.place[d];
  for (unsigned int node = 0; node < positions.size(); ++node)
    {
      number[node] = exchange.indices().global_to_local(before.indices().local_to_global(node));
      places[number[node]] = positions[node];
    }
  positions.swap(places);
  for (auto &nodes : leaf_nodes)
    for (unsigned int &node : nodes)
      node = number[node];
}

template <int dim>
void
Octree<dim>::make_hanging_nodes()
{
  std::vector<Parent>       parents = find_parents();
  const std::vector<Parent> far     = find_far_parents(parents);
  if (mpi::any(!far.empty(), triangulation.get_communicator()))
    {
      add_ghosts(far);
      parents.insert(parents.end(), far.begin(), far.end());
    }
  hanging.clear();
  node_to_hanging.assign(n_nodes(), -1);
  for (const Parent &parent : parents)
    {
      const unsigned int node = exchange.indices().global_to_local(parent.hanging);
      if (node_to_hanging[node] < 0)
        {
          node_to_hanging[node] = hanging.size();
          hanging.push_back({node, {}});
        }
      hanging[node_to_hanging[node]].parents.emplace_back(
        exchange.indices().global_to_local(parent.parent), parent.weight);
    }
  // Sums over parents must not depend on how nodes are numbered.
  for (HangingNode &node : hanging)
    std::sort(node.parents.begin(), node.parents.end(), [this](const auto &a, const auto &b) {
      for (unsigned int d = 0; d < dim; ++d)
        if (positions[a.first][d] != positions[b.first][d])
          return positions[a.first][d] < positions[b.first][d];
      return false;
    });
}

template <int dim>
dealii::types::global_dof_index
Octree<dim>::global_node(const unsigned int node) const
{
  return exchange.indices().local_to_global(node);
}

template <int dim>
int
Octree<dim>::node_owner(const unsigned int node) const
{
  return exchange.owner(node);
}

template <int dim>
dealii::BoundingBox<dim>
Octree<dim>::owned_region() const
{
  auto lower = description.box.get_boundary_points().first, upper = lower;
  for (unsigned int leaf = 0; leaf < n_owned; ++leaf)
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = leaf == 0 ? leaf_lower[0][d] : std::min(lower[d], leaf_lower[leaf][d]);
        upper[d] = std::max(upper[d], leaf_lower[leaf][d] + leaf_size[leaf]);
      }
  return dealii::BoundingBox<dim>(std::make_pair(lower, upper));
}

template <int dim>
double
Octree<dim>::smallest_cell_size() const
{
  double mine = std::numeric_limits<double>::max();
  for (const double size : leaf_size)
    mine = std::min(mine, size);
  return dealii::Utilities::MPI::min(mine, triangulation.get_communicator());
}

template <int dim>
double
Octree<dim>::largest_cell_size() const
{
  double mine = 0;
  for (const double size : leaf_size)
    mine = std::max(mine, size);
  return dealii::Utilities::MPI::max(mine, triangulation.get_communicator());
}

template <int dim>
std::size_t
Octree<dim>::memory_consumption() const
{
  return triangulation.memory_consumption() + dof_handler.memory_consumption() +
         leaf_nodes.size() * (sizeof(leaf_nodes[0]) + sizeof(leaf_lower[0]) + 16) +
         positions.size() * (sizeof(positions[0]) + 4);
}

template class Octree<2>;
template class Octree<3>;
} // namespace coracle
