// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/distributed/p4est_wrappers.h>

#include <deal.II/grid/grid_tools.h>

#include <coracle/base/mpi.h>
#include <coracle/grid/octree.h>

namespace coracle
{
namespace
{
/// p4est's own finest level.
template <int dim>
constexpr unsigned int max_level = (dim == 2 ? 30 : 19);
/// Bits of a place that are compared: those that p4est and LeafTree both have.
template <int dim>
constexpr unsigned int n_curve_bits = std::min(max_level<dim>, LeafTree<dim>::max_levels);

template <int dim>
std::uint64_t
curve_place(const typename dealii::internal::p4est::types<dim>::quadrant &quadrant)
{
  std::array<std::uint64_t, dim> c;
  c[0] = quadrant.x;
  c[1] = quadrant.y;
  if constexpr (dim == 3)
    c[2] = quadrant.z;
  std::uint64_t place = 0;
  for (unsigned int l = 0; l < n_curve_bits<dim>; ++l)
    {
      place <<= dim;
      for (unsigned int d = 0; d < dim; ++d)
        place |= ((c[d] >> (max_level<dim> - 1 - l)) & 1u) << d;
    }
  return place;
}
} // namespace

template <int dim>
template <typename Action>
void
Octree<dim>::for_each_cell(const Action &action) const
{
  for (const auto &cell : triangulation.active_cell_iterators())
    if (const int leaf = leaf_of_active_cell[cell->active_cell_index()]; leaf >= 0)
      action(cell, static_cast<unsigned int>(leaf));
}

template <int dim>
int
Octree<dim>::least_level(const unsigned int leaf) const
{
  int result = 0;
  for (const auto &refinement : description.refinements)
    if (refinement.meets(leaf_lower[leaf], leaf_size[leaf]))
      result = std::max<int>(result, refinement.level);
  return result;
}

template <int dim>
void
Octree<dim>::find_first_places()
{
  const auto &tree_of_cell = triangulation.get_coarse_cell_to_p4est_tree_permutation();
  curve_of_coarse_cell.assign(tree.n_coarse_cells(), 0);
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
    {
      std::size_t   slot  = 0;
      std::uint64_t place = 0;
      tree.curve_place(cell->center(), 0, slot, place);
      curve_of_coarse_cell[slot] = tree_of_cell[cell->index()];
    }
  const auto *const forest = triangulation.get_p4est();
  first_places.clear();
  for (unsigned int rank = 0; rank < mpi::n_ranks(triangulation.get_communicator()); ++rank)
    {
      const auto &first = forest->global_first_position[rank];
      first_places.emplace_back(first.p.which_tree, curve_place<dim>(first));
    }
}

template <int dim>
int
Octree<dim>::owner_of(const dealii::Point<dim> &point) const
{
  std::size_t   slot  = 0;
  std::uint64_t place = 0;
  if (!tree.curve_place(point, n_curve_bits<dim>, slot, place))
    return -1;
  const std::pair<std::uint64_t, std::uint64_t> here(curve_of_coarse_cell[slot], place);
  // Of ranks that begin at the same place, all but the last have nothing.
  return std::upper_bound(first_places.begin(), first_places.end(), here) - first_places.begin() -
         1;
}

template <int dim>
void
Octree<dim>::update_ghost_leaves(std::vector<double> &values) const
{
  AssertDimension(values.size(), n_leaves());
  using ActiveCell = typename dealii::Triangulation<dim>::active_cell_iterator;
  dealii::GridTools::exchange_cell_data_to_ghosts<double, dealii::Triangulation<dim>>(
    triangulation,
    [&](const ActiveCell &cell) { return values[leaf_of_active_cell[cell->active_cell_index()]]; },
    [&](const ActiveCell &cell, const double &value) {
      values[leaf_of_active_cell[cell->active_cell_index()]] = value;
    });
}

template <int dim>
unsigned int
Octree<dim>::work_of(const Cell &cell, const Status status, const std::vector<double> &work) const
{
  const auto work_of_leaf = [&](const Cell &active) {
    return work[leaf_of_active_cell[active->active_cell_index()]];
  };
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
  double result       = 0;
  switch (status)
    {
      case Triangulation::CELL_COARSEN:
        for (unsigned int c = 0; c < n_corners; ++c)
          result += work_of_leaf(cell->child(c));
        break;
      case Triangulation::CELL_PERSIST:
        result = work_of_leaf(cell);
        break;
      default:
        // Asked once for each child to be.
        result = work_of_leaf(cell) / n_corners;
    }
  // Nothing is added to these weights: the cell itself counts here.
  return static_cast<unsigned int>(std::min(1000. * (1. + result), 1e9));
}

template <int dim>
void
Octree<dim>::repartition(const std::vector<double> &work)
{
  const auto connection = triangulation.signals.weight.connect(
    [&](const Cell &cell, const Status status) { return work_of(cell, status, work); });
  triangulation.repartition();
  connection.disconnect();
  number();
}

template <int dim>
std::vector<std::vector<unsigned int>>
Octree<dim>::find_families() const
{
  std::vector<std::vector<unsigned int>> result(n_owned);
  for_each_cell([&](const auto &cell, const unsigned int leaf) {
    if (leaf >= n_owned || leaf_level[leaf] == 0)
      return;
    const auto parent = cell->parent();
    for (unsigned int c = 0; c < n_corners; ++c)
      if (!parent->child(c)->is_active() || !parent->child(c)->is_locally_owned())
        {
          result[leaf].clear();
          return;
        }
      else
        result[leaf].push_back(leaf_of_active_cell[parent->child(c)->active_cell_index()]);
  });
  return result;
}

template <int dim>
std::vector<double>
Octree<dim>::close(const std::vector<int> &wanted) const
{
  // Leaves that bind an owned neighbour which is as large as they are, or larger.
  std::vector<std::pair<unsigned int, unsigned int>> bonds;
  for (unsigned int leaf = 0; leaf < n_leaves(); ++leaf)
    for (int direction = 0; direction < (dim == 2 ? 9 : 27); ++direction)
      {
        dealii::Point<dim> x = leaf_lower[leaf];
        for (int d = 0, rest = direction; d < dim; ++d, rest /= 3)
          x[d] += (0.5 + 0.75 * (rest % 3 - 1)) * leaf_size[leaf];
        if (const int other = find(x); other >= 0 && other < static_cast<int>(n_owned) &&
                                       other != static_cast<int>(leaf) &&
                                       leaf_level[other] <= leaf_level[leaf])
          bonds.emplace_back(leaf, other);
      }
  const auto          families = find_families();
  std::vector<double> level(n_leaves());
  for (unsigned int leaf = 0; leaf < n_owned; ++leaf)
    level[leaf] =
      std::max(leaf_level[leaf] - 1,
               std::min({leaf_level[leaf] + 1, std::max(wanted[leaf], least_level(leaf))}));
  for (bool changed = true; changed;)
    {
      changed             = false;
      const auto at_least = [&](const unsigned int leaf, const double value) {
        changed     = changed || level[leaf] < value;
        level[leaf] = std::max(level[leaf], value);
      };
      // A leaf coarsens only with all its siblings.
      for (unsigned int leaf = 0; leaf < n_owned; ++leaf)
        if (level[leaf] < leaf_level[leaf] &&
            (families[leaf].empty() ||
             std::any_of(families[leaf].begin(), families[leaf].end(), [&](const unsigned int i) {
               return level[i] >= leaf_level[i];
             })))
          at_least(leaf, leaf_level[leaf]);
      update_ghost_leaves(level);
      for (const auto &[leaf, other] : bonds)
        at_least(other, level[leaf] - 1);
      changed = mpi::any(changed, triangulation.get_communicator());
    }
  return level;
}

template <int dim>
bool
Octree<dim>::adapt(std::vector<int> wanted, const std::vector<double> &work)
{
  AssertDimension(wanted.size(), n_owned);
  AssertDimension(work.size(), n_owned);
  const std::vector<double> level   = close(wanted);
  bool                      changed = false;
  // Flags on ghosts and their siblings too: deal.II smooths what it sees, p4est takes owned cells.
  for_each_cell([&](const auto &cell, const unsigned int leaf) {
    if (level[leaf] > leaf_level[leaf])
      cell->set_refine_flag();
    else if (level[leaf] < leaf_level[leaf])
      for (unsigned int c = 0; c < n_corners; ++c)
        if (cell->parent()->child(c)->is_active())
          cell->parent()->child(c)->set_coarsen_flag();
    changed = changed || level[leaf] != leaf_level[leaf];
  });
  if (!mpi::any(changed, triangulation.get_communicator()))
    return false;
  const auto connection = triangulation.signals.weight.connect(
    [&](const Cell &cell, const Status status) { return work_of(cell, status, work); });
  triangulation.execute_coarsening_and_refinement();
  connection.disconnect();
  number();
  return true;
}

#define INSTANTIATE(dim)                                                       \
  template int  Octree<dim>::least_level(const unsigned int) const;            \
  template void Octree<dim>::find_first_places();                              \
  template int  Octree<dim>::owner_of(const dealii::Point<dim> &) const;       \
  template void Octree<dim>::update_ghost_leaves(std::vector<double> &) const; \
  template void Octree<dim>::repartition(const std::vector<double> &);         \
  template bool Octree<dim>::adapt(std::vector<int>, const std::vector<double> &);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
