// SPDX-License-Identifier: GPL-3.0-or-later
// An octree that was saved and loaded has the same leaves, owners and node numbers, bit by bit,
// though it is not the one that the description makes; other ranks get the same leaves.
#include "grid/scene.h"

using namespace coracle;

namespace
{
const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
bool
is_same(const Octree<dim> &a, const Octree<dim> &b)
{
  bool same = a.n_leaves() == b.n_leaves() && a.n_owned_leaves() == b.n_owned_leaves() &&
              a.n_nodes() == b.n_nodes() && a.n_owned_nodes() == b.n_owned_nodes();
  for (unsigned int leaf = 0; same && leaf < a.n_leaves(); ++leaf)
    same = a.nodes(leaf) == b.nodes(leaf) && a.lower(leaf) == b.lower(leaf) &&
           a.size(leaf) == b.size(leaf) && a.owner(leaf) == b.owner(leaf);
  for (unsigned int node = 0; same && node < a.n_nodes(); ++node)
    same = a.position(node) == b.position(node) && a.global_node(node) == b.global_node(node) &&
           a.hanging_index(node) == b.hanging_index(node);
  return same;
}

/// Sums over all leaves that tell two octrees apart.
template <int dim>
std::array<double, 2>
sums_of(const Octree<dim> &octree)
{
  std::array<double, 2> sums{};
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    {
      sums[0] += 1;
      sums[1] += octree.size(leaf) * (octree.lower(leaf)[0] + 3 * octree.lower(leaf)[1]);
    }
  return {{mpi::sum(sums[0], octree.triangulation.get_communicator()),
           mpi::sum(sums[1], octree.triangulation.get_communicator())}};
}

template <int dim>
void
test()
{
  const auto refined = dyadic_box<dim>();
  auto       plain   = refined;
  plain.refinements.clear();
  // Most of the weight in one corner: ranks may get nothing.
  const auto weight = [](const dealii::Point<dim> &x, const double) {
    return x.norm() < 0.4 ? 1000. : 0.;
  };
  const std::string file = "saved." + std::to_string(dim);
  const Octree<dim> octree(refined, weight, comm);
  octree.save(file);
  const Octree<dim> loaded(plain, {}, comm, file);
  deallog << "the same on as many ranks: " << !mpi::any(!is_same(octree, loaded), comm)
          << ", and not what the description makes: "
          << (octree.triangulation.n_global_active_cells() !=
              Octree<dim>(plain, {}, comm).triangulation.n_global_active_cells())
          << std::endl;

  MPI_Comm first_ranks;
  MPI_Comm_split(comm, mpi::rank(comm) < (mpi::n_ranks(comm) + 1) / 2, 0, &first_ranks);
  const auto expected = sums_of(octree);
  bool       good     = true;
  if (mpi::rank(comm) < (mpi::n_ranks(comm) + 1) / 2)
    good = sums_of(Octree<dim>(plain, {}, first_ranks, file)) == expected;
  deallog << "the same leaves on fewer: " << !mpi::any(!good, comm) << std::endl;
  MPI_Comm_free(&first_ranks);
}
} // namespace

int
main(int argc, char **argv)
{
  setenv("OMPI_MCA_io", "romio321", 0);
  dealii::Utilities::MPI::MPI_InitFinalize mpi_session(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test<2>();
  deallog.pop();
  deallog.push("3d");
  test<3>();
}
