// SPDX-License-Identifier: GPL-3.0-or-later
// Leaves are found as a search through all of them finds them, follow the space-filling curve, and
// their nodes have the same numbers, and hang on the same parents, on any number of ranks.
#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

// A leaf of any rank.
template <int dim>
struct Box
{
  std::array<double, dim> lower;
  double                  size;

  bool contains(const dealii::Point<dim> &x, const double tolerance) const
  {
    for (int d = 0; d < dim; ++d)
      if (x[d] < lower[d] - tolerance || x[d] > lower[d] + size + tolerance)
        return false;
    return true;
  }
  bool has_corner(const dealii::Point<dim> &x) const
  {
    for (int d = 0; d < dim; ++d)
      if (std::fabs(x[d] - lower[d]) > 1e-9 && std::fabs(x[d] - lower[d] - size) > 1e-9)
        return false;
    return true;
  }
};

template <int dim>
std::vector<Box<dim>>
all_leaves(const Octree<dim> &octree)
{
  std::map<unsigned int, std::vector<Box<dim>>> mine;
  for (unsigned int r = 0; r < mpi::n_ranks(comm); ++r)
    for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
      {
        Box<dim> box;
        for (int d = 0; d < dim; ++d)
          box.lower[d] = octree.lower(leaf)[d];
        box.size = octree.size(leaf);
        mine[r].push_back(box);
      }
  std::vector<Box<dim>> result;
  for (const auto &[rank, boxes] : mpi::exchange_values(mine, comm))
    result.insert(result.end(), boxes.begin(), boxes.end());
  return result;
}

template <int dim>
void
test_find(const Octree<dim> &octree, const std::vector<Box<dim>> &leaves)
{
  const auto is_right = [&](const dealii::Point<dim> &x) {
    const int  leaf = octree.find(x);
    const bool mine = leaf >= 0 && leaf < int(octree.n_owned_leaves());
    bool       good = mpi::sum<unsigned int>(mine, comm) == 1;
    if (leaf >= 0)
      {
        Box<dim> box;
        for (int d = 0; d < dim; ++d)
          box.lower[d] = octree.lower(leaf)[d];
        box.size = octree.size(leaf);
        good     = good && box.contains(x, 1e-12);
      }
    return !mpi::any(!good, comm);
  };
  Random random;
  bool   good = true;
  for (unsigned int i = 0; i < 300; ++i)
    good = is_right(random.in(octree.box())) && good;
  deallog << "random points have one leaf on one rank: " << good << std::endl;

  // All ranks have the same leaves, in an order of their own: ask for corners by sorted places.
  std::vector<std::array<double, dim>> corners;
  for (const auto &leaf : leaves)
    {
      corners.push_back(leaf.lower);
      for (int d = 0; d < dim; ++d)
        corners.back()[d] += leaf.size;
      corners.push_back(leaf.lower);
    }
  std::sort(corners.begin(), corners.end());
  good = true;
  for (std::size_t i = 0; i < corners.size(); i += 7)
    {
      dealii::Point<dim> x;
      for (int d = 0; d < dim; ++d)
        x[d] = std::min(corners[i][d], octree.box().upper_bound(d));
      good = is_right(x) && good;
    }
  deallog << "so have corners of leaves: " << good << std::endl;
  auto [lower, upper] = octree.box().get_boundary_points();
  good                = is_right(upper) && is_right(lower);
  auto on_face        = octree.box().center();
  for (int d = 0; d < dim; ++d)
    {
      on_face    = octree.box().center();
      on_face[d] = upper[d];
      good       = is_right(on_face) && good;
    }
  deallog << "so has the closed box: " << good << std::endl;
  upper[dim - 1] += 1e-9;
  lower[0] -= 1e-9;
  on_face[0] = std::nan("");
  deallog << "outside is outside: "
          << (octree.find(upper) == -1 && octree.find(lower) == -1 && octree.find(on_face) == -1)
          << std::endl;
}

template <int dim>
void
test_order(const Octree<dim>                   &octree,
           const std::array<unsigned int, dim> &n_coarse,
           const double                         coarse)
{
  bool                                   good    = true;
  std::uint64_t                          current = 0;
  std::map<std::uint64_t, std::uint64_t> reached;
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    {
      // Coarse cells come in an order of their own, each of them in one piece.
      std::uint64_t slot = 0, curve = 0;
      for (int d = dim - 1; d >= 0; --d)
        {
          // In units of 1/16 of a coarse cell, and half a leaf off its corner.
          const double x = (octree.lower(leaf)[d] - octree.box().lower_bound(d)) / coarse;
          const auto   c = static_cast<std::uint64_t>(16 * (x + 0.5 * octree.size(leaf) / coarse));
          slot           = slot * n_coarse[d] + c / 16;
          for (unsigned int bit = 0; bit < 4; ++bit)
            curve |= ((c >> bit) & 1) << (bit * dim + d);
        }
      const auto last = reached.find(slot);
      good          = good && (last == reached.end() || (slot == current && last->second < curve));
      reached[slot] = curve;
      current       = slot;
    }
  deallog << "owned leaves follow the curve: " << !mpi::any(!good, comm) << std::endl;
}

template <int dim>
void
test_nodes(const Octree<dim> &octree, const std::vector<Box<dim>> &leaves)
{
  bool   weights = true, found = true, corners = true;
  double checksum = 0, n_hanging = 0;
  for (unsigned int node = 0; node < octree.n_nodes(); ++node)
    {
      const auto x     = octree.position(node);
      bool       hangs = false;
      for (const auto &leaf : leaves)
        hangs = hangs || (leaf.contains(x, 1e-9) && !leaf.has_corner(x));
      found = found && hangs == (octree.hanging_index(node) >= 0);
      if (hangs && octree.hanging_index(node) >= 0)
        {
          const auto            &hanging = octree.hanging_nodes()[octree.hanging_index(node)];
          double                 sum     = 0;
          dealii::Tensor<1, dim> place;
          for (const auto &[parent, weight] : hanging.parents)
            {
              sum += weight;
              place += weight * octree.position(parent);
              weights = weights && weight > 0 && octree.hanging_index(parent) < 0;
            }
          weights = weights && hanging.node == node && std::fabs(sum - 1) < 1e-14 &&
                    (place - x).norm() < 1e-14;
        }
      if (node < octree.n_owned_nodes())
        {
          n_hanging += hangs;
          for (int d = 0; d < dim; ++d)
            checksum += std::sin(0.01 * octree.global_node(node)) * (d + 1) * x[d];
        }
    }
  for (unsigned int leaf = 0; leaf < octree.n_leaves(); ++leaf)
    for (unsigned int c = 0; c < octree.n_corners; ++c)
      for (int d = 0; d < dim; ++d)
        corners =
          corners && std::fabs(octree.position(octree.nodes(leaf)[c])[d] - octree.lower(leaf)[d] -
                               ((c >> d) & 1) * octree.size(leaf)) < 1e-12;
  deallog << "corners of leaves are where they should be: " << !mpi::any(!corners, comm)
          << std::endl;
  deallog << "all nodes of a rank that hang are known, ghosts too: " << !mpi::any(!found, comm)
          << std::endl;
  deallog << "parents do not hang, their weights are a mean: " << !mpi::any(!weights, comm)
          << std::endl;
  deallog << "leaves, nodes, hanging nodes: " << leaves.size() << ' ' << octree.dof_handler.n_dofs()
          << ' ' << static_cast<int>(mpi::sum(n_hanging, comm)) << std::endl;
  deallog << "numbering: " << mpi::sum(checksum, comm) << std::endl;
}

template <int dim>
void
test_weights()
{
  const auto heavy = [](const dealii::Point<dim> &x, const double) {
    return x[0] < 0.25 ? 20. : 0.;
  };
  const Octree<dim> octree(dyadic_box<dim>(), heavy, comm);
  double            load = 0;
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    load += 1 + (octree.lower(leaf)[0] < 0.25 ? 20. : 0.);
  // Children of one parent stay together.
  const double even = mpi::sum(load, comm) / mpi::n_ranks(comm);
  deallog << "loads are even to one family of cells: "
          << (mpi::max(load, comm) <= even + 21 * (1 << dim)) << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  std::array<unsigned int, dim> coarse;
  coarse.fill(2);
  coarse[0] = 3;
  {
    const Octree<dim> octree(dyadic_box<dim>(), {}, comm);
    const auto        leaves = all_leaves(octree);
    test_find(octree, leaves);
    test_order<dim>(octree, coarse, dim == 2 ? 0.5 : 0.25);
    test_nodes(octree, leaves);
    bool exact = true;
    for (unsigned int leaf = 0; leaf < octree.n_leaves(); ++leaf)
      exact = exact && octree.find(octree.lower(leaf)) == int(leaf);
    deallog << "a lower corner belongs to its leaf: " << !mpi::any(!exact, comm) << std::endl;
  }
  {
    // Numbers that are not represented exactly, an odd number of cells.
    std::array<unsigned int, dim> n;
    n.fill(3);
    n[0] = 11;
    const Octree<dim> octree(refined_box<dim>(n, 0.1, dim == 2 ? 0. : -0.3), {}, comm);
    const auto        leaves = all_leaves(octree);
    test_find(octree, leaves);
    test_nodes(octree, leaves);
  }
  {
    // Two cells: with more ranks some have nothing.
    std::array<unsigned int, dim> n;
    n.fill(1);
    n[0]             = 2;
    auto description = refined_box<dim>(n, 0.7, 0.1);
    description.refinements.clear();
    const Octree<dim> octree(description, {}, comm);
    const auto        leaves = all_leaves(octree);
    test_find(octree, leaves);
    test_nodes(octree, leaves);
    deallog << "smallest cell: " << octree.smallest_cell_size() << std::endl;
  }
  test_weights<dim>();
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
