// SPDX-License-Identifier: GPL-3.0-or-later
// An octree that was saved and loaded has the same leaves, owners and node numbers, bit by bit,
// though it is not the one that the description makes; other ranks get the same leaves. Leaves that
// do not fill the box are refused.
#include "grid/scene.h"
#include "memory_store.h"

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

/// What all ranks have saved, on each.
template <int dim>
MemoryStore
save(const Octree<dim> &octree)
{
  MemoryStore mine(1);
  Archive     archive(mine, Archive::Mode::save, 0, 1);
  octree.save(archive);
  MemoryStore all(mpi::n_ranks(comm));
  const auto &stored = mine.parts[0].at("octree/leaves");
  const auto  bytes  = dealii::Utilities::MPI::all_gather(comm, stored.bytes);
  for (unsigned int rank = 0; rank < bytes.size(); ++rank)
    {
      all.writer = rank;
      all.put("octree/leaves",
              {stored.block.type, bytes[rank].size() / sizeof(int), 1},
              bytes[rank].data());
    }
  return all;
}

template <int dim>
std::unique_ptr<Octree<dim>>
load(const OctreeDescription<dim> &description, MemoryStore &store, const MPI_Comm ranks)
{
  Archive archive(store, Archive::Mode::load, mpi::rank(ranks), mpi::n_ranks(ranks));
  return std::make_unique<Octree<dim>>(
    description,
    std::function<double(const dealii::Point<dim> &, const double)>(),
    ranks,
    &archive);
}

/// Why the leaves cannot be used after a change to those of the rank that has most.
template <int dim>
void
damage(const std::string                             &name,
       const OctreeDescription<dim>                  &description,
       MemoryStore                                    store,
       const std::function<void(std::vector<int> &)> &change)
{
  const auto most =
    std::max_element(store.parts.begin(), store.parts.end(), [](const auto &a, const auto &b) {
      return a.at("octree/leaves").bytes.size() < b.at("octree/leaves").bytes.size();
    });
  auto            &stored = most->at("octree/leaves");
  std::vector<int> leaves(stored.bytes.size() / sizeof(int));
  std::copy_n(stored.bytes.data(), stored.bytes.size(), reinterpret_cast<char *>(leaves.data()));
  change(leaves);
  store.writer = most - store.parts.begin();
  store.put("octree/leaves", {Block::Type::integer_32, leaves.size(), 1}, leaves.data());
  try
    {
      load(description, store, comm);
      deallog << name << ": taken" << std::endl;
    }
  catch (const RunFailure &failure)
    {
      deallog << name << ": " << failure.title << std::endl;
    }
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
  const Octree<dim> octree(refined, weight, comm);
  MemoryStore       store  = save(octree);
  const auto        loaded = load(plain, store, comm);
  deallog << "the same on as many ranks: " << !mpi::any(!is_same(octree, *loaded), comm)
          << ", and not what the description makes: "
          << (octree.triangulation.n_global_active_cells() !=
              Octree<dim>(plain, {}, comm).triangulation.n_global_active_cells())
          << std::endl;

  MPI_Comm first_ranks;
  MPI_Comm_split(comm, mpi::rank(comm) < (mpi::n_ranks(comm) + 1) / 2, 0, &first_ranks);
  const auto expected = sums_of(octree);
  bool       good     = true;
  if (mpi::rank(comm) < (mpi::n_ranks(comm) + 1) / 2)
    good = sums_of(*load(plain, store, first_ranks)) == expected;
  deallog << "the same leaves on fewer: " << !mpi::any(!good, comm) << std::endl;
  MPI_Comm_free(&first_ranks);

  constexpr int n = dim + 2;
  damage("half a leaf", plain, store, [](auto &leaves) { leaves.pop_back(); });
  damage("a leaf twice", plain, store, [](auto &leaves) {
    leaves.insert(leaves.begin(), leaves.begin(), leaves.begin() + n);
  });
  damage("the last leaf left out", plain, store, [](auto &leaves) {
    leaves.resize(leaves.size() - n);
  });
  damage("no leaf", plain, store, [](auto &leaves) { leaves.clear(); });
  damage("a tree that is not there", plain, store, [](auto &leaves) { leaves[0] = 1 << 30; });
  damage("a negative tree", plain, store, [](auto &leaves) { leaves[0] = -1; });
  damage("a level below all", plain, store, [](auto &leaves) { leaves[n - 1] = 1000; });
  damage("a negative level", plain, store, [](auto &leaves) { leaves[n - 1] = -1; });
  damage("a leaf elsewhere", plain, store, [](auto &leaves) { leaves[1] += 1; });
  damage("another level", plain, store, [](auto &leaves) { leaves[n - 1] += 1; });
  damage("two leaves swapped", plain, store, [](auto &leaves) {
    std::swap_ranges(leaves.begin(), leaves.begin() + n, leaves.begin() + n);
  });
  damage("a leaf in parts of parts of parts", plain, store, [](auto &leaves) {
    // Of the first leaf's children the last is divided, and so on: its neighbours are coarse.
    std::vector<int> parts, last(leaves.begin(), leaves.begin() + n);
    const int        deepest = last[n - 1] + 3;
    while (last[n - 1] < deepest)
      {
        ++last[n - 1];
        const int size = 1 << ((dim == 2 ? 30 : 19) - last[n - 1]);
        for (int child = 0; child + 1 < (1 << dim); ++child)
          {
            std::vector<int> leaf = last;
            for (int d = 0; d < dim; ++d)
              leaf[1 + d] += (child >> d & 1) * size;
            parts.insert(parts.end(), leaf.begin(), leaf.end());
          }
        for (int d = 0; d < dim; ++d)
          last[1 + d] += size;
      }
    parts.insert(parts.end(), last.begin(), last.end());
    leaves.erase(leaves.begin(), leaves.begin() + n);
    leaves.insert(leaves.begin(), parts.begin(), parts.end());
  });
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi_initialization(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test<2>();
  deallog.pop();
  deallog.push("3d");
  test<3>();
}
