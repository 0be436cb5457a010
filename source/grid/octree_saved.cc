// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/grid/octree.h>

#include <memory>
#include <p4est_bits.h>
#include <p4est_extended.h>
#include <p4est_io.h>
#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_io.h>

namespace coracle
{
namespace
{
/// What p4est has under two names.
template <int dim>
struct Library;

template <>
struct Library<2>
{
  static constexpr auto inflate = p4est_inflate;
  static constexpr auto destroy = p4est_destroy;
  static bool           is_balanced(p4est_t *const forest)
  {
    return p4est_is_balanced(forest, P4EST_CONNECT_FULL) != 0;
  }
  static constexpr int max_level = P4EST_MAXLEVEL, finest = P4EST_QMAXLEVEL;
};

template <>
struct Library<3>
{
  static constexpr auto inflate = p8est_inflate;
  static constexpr auto destroy = p8est_destroy;
  static bool           is_balanced(p8est_t *const forest)
  {
    return p8est_is_balanced(forest, P8EST_CONNECT_FULL) != 0;
  }
  static constexpr int max_level = P8EST_MAXLEVEL, finest = P8EST_QMAXLEVEL;
};

/// As it is saved: tree, lower corner in units of p4est's finest cells, level.
template <int dim>
constexpr unsigned int n_numbers = dim + 2;

RunFailure
does_not_fit(const std::string &why)
{
  return RunFailure("a checkpoint does not fit this case",
                    "its octree: " + why,
                    "go on with the program and the parameter file that wrote it");
}

/// A stretch of the space-filling curve through all trees, in units of p4est's finest cells.
struct Stretch
{
  std::uint64_t tree = 0, begin = 0, end = 0;
};

/// Throws if the numbers are not those of a leaf.
template <int dim>
Stretch
stretch_of(const int *const leaf, const std::uint64_t n_trees)
{
  constexpr int max_level = Library<dim>::max_level;
  const int     level     = leaf[dim + 1];
  if (leaf[0] < 0 || static_cast<std::uint64_t>(leaf[0]) >= n_trees || level < 0 ||
      level > Library<dim>::finest)
    throw does_not_fit("a leaf of tree " + std::to_string(leaf[0]) + " and level " +
                       std::to_string(level));
  const int size = 1 << (max_level - level);
  Stretch   result{static_cast<std::uint64_t>(leaf[0]),
                 0,
                 std::uint64_t(1) << (dim * (max_level - level))};
  for (int d = 0; d < dim; ++d)
    {
      const int x = leaf[1 + d];
      if (x < 0 || x >= (1 << max_level) || x % size != 0)
        throw does_not_fit("a leaf at " + std::to_string(x) + " on level " + std::to_string(level));
      for (int bit = 0; bit < max_level; ++bit)
        result.begin |= static_cast<std::uint64_t>(x >> bit & 1) << (dim * bit + d);
    }
  result.end += result.begin;
  return result;
}

/// The leaves of a rank without a gap: from where to where.
template <int dim>
std::pair<Stretch, Stretch>
check_leaves(const std::vector<int> &leaves, const std::uint64_t n_trees)
{
  constexpr std::uint64_t end_of_tree = std::uint64_t(1) << (dim * Library<dim>::max_level);
  if (leaves.size() % n_numbers<dim> != 0)
    throw does_not_fit("half a leaf");
  std::pair<Stretch, Stretch> ends;
  for (std::size_t i = 0; i < leaves.size(); i += n_numbers<dim>)
    {
      const Stretch  next = stretch_of<dim>(&leaves[i], n_trees);
      const Stretch &last = ends.second;
      if (i == 0)
        ends.first = next;
      else if (next.tree == last.tree
                 ? next.begin != last.end
                 : (next.tree != last.tree + 1 || next.begin != 0 || last.end != end_of_tree))
        throw does_not_fit("the leaves do not follow each other");
      ends.second = next;
    }
  return ends;
}

/// So do those of all ranks, from the first tree to the last. Collective.
template <int dim>
void
check_all_leaves(const std::vector<int> &leaves, const std::uint64_t n_trees, const MPI_Comm comm)
{
  constexpr std::uint64_t     end_of_tree = std::uint64_t(1) << (dim * Library<dim>::max_level);
  std::pair<Stretch, Stretch> ends;
  mpi::agree([&] { ends = check_leaves<dim>(leaves, n_trees); }, comm);
  using Ends     = std::array<std::uint64_t, 5>;
  const auto all = dealii::Utilities::MPI::all_gather(
    comm,
    Ends{{leaves.size(), ends.first.tree, ends.first.begin, ends.second.tree, ends.second.end}});
  std::uint64_t tree = 0, place = 0;
  for (const auto &[n, first_tree, begin, last_tree, end] : all)
    {
      if (n == 0)
        continue;
      if (place == end_of_tree)
        {
          ++tree;
          place = 0;
        }
      if (first_tree != tree || begin != place)
        throw does_not_fit("the leaves of two ranks do not follow each other");
      tree  = last_tree;
      place = end;
    }
  if (tree + 1 != n_trees || place != end_of_tree)
    throw does_not_fit("leaves are missing");
}
} // namespace

template <int dim>
void
Octree<dim>::save(Archive &archive) const
{
  using Tree               = typename dealii::internal::p4est::types<dim>::tree;
  using Quadrant           = typename dealii::internal::p4est::types<dim>::quadrant;
  const auto *const forest = triangulation.get_p4est();
  std::vector<int>  leaves;
  leaves.reserve(n_numbers<dim> * forest->local_num_quadrants);
  for (int t = forest->first_local_tree; t >= 0 && t <= forest->last_local_tree; ++t)
    {
      auto &quadrants = static_cast<Tree *>(sc_array_index_int(forest->trees, t))->quadrants;
      for (std::size_t i = 0; i < quadrants.elem_count; ++i)
        {
          const auto &leaf = *static_cast<const Quadrant *>(sc_array_index(&quadrants, i));
          leaves.insert(leaves.end(), {t, leaf.x, leaf.y});
          if constexpr (dim == 3)
            leaves.push_back(leaf.z);
          leaves.push_back(leaf.level);
        }
    }
  const Archive::Section section(archive, "octree");
  archive.in_order("leaves", leaves, n_numbers<dim>);
}

// Triangulation::load(file) would read a file of p4est's, which ends the program where the disk is
// full on writing, and shares the leaves out anew; here they stay with their ranks if there are as
// many.
template <int dim>
void
Octree<dim>::load(Archive &archive)
{
  const MPI_Comm      comm    = triangulation.get_communicator();
  const std::uint64_t n_trees = triangulation.n_cells(0);
  std::vector<int>    leaves;
  mpi::agree(
    [&] {
      const Archive::Section section(archive, "octree");
      archive.in_order("leaves", leaves, n_numbers<dim>);
    },
    comm);
  check_all_leaves<dim>(leaves, n_trees, comm);

  // Leaves of each tree and of each rank, summed up; all but the trees of the leaves themselves.
  const std::size_t           n = leaves.size() / n_numbers<dim>;
  std::vector<p4est_gloidx_t> of_trees(n_trees + 1, 0), of_ranks(1, 0);
  std::vector<p4est_qcoord_t> quadrants;
  quadrants.reserve((dim + 1) * n);
  for (auto leaf = leaves.begin(); leaf != leaves.end(); leaf += n_numbers<dim>)
    {
      ++of_trees[*leaf + 1];
      quadrants.insert(quadrants.end(), leaf + 1, leaf + n_numbers<dim>);
    }
  dealii::Utilities::MPI::sum(of_trees, comm, of_trees);
  std::partial_sum(of_trees.begin(), of_trees.end(), of_trees.begin());
  for (const p4est_gloidx_t count : dealii::Utilities::MPI::all_gather(comm, p4est_gloidx_t(n)))
    of_ranks.push_back(of_ranks.back() + count);

  sc_array_t view;
  sc_array_init_data(&view, quadrants.data(), sizeof(p4est_qcoord_t), quadrants.size());
  using Forest = typename dealii::internal::p4est::types<dim>::forest;
  const auto *const                                 coarse = triangulation.get_p4est();
  const std::unique_ptr<Forest, void (*)(Forest *)> forest(
    Library<dim>::inflate(
      comm, coarse->connectivity, of_ranks.data(), of_trees.data(), &view, nullptr, nullptr),
    Library<dim>::destroy);
  if (!Library<dim>::is_balanced(forest.get()))
    throw does_not_fit("neighbours differ by more than one level");
  triangulation.load(forest.get());
}

template void Octree<2>::save(Archive &) const;
template void Octree<3>::save(Archive &) const;
template void Octree<2>::load(Archive &);
template void Octree<3>::load(Archive &);
} // namespace coracle
