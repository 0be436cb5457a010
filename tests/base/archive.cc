// SPDX-License-Identifier: GPL-3.0-or-later
// State that three ranks have saved comes back to three bit by bit, and to two as the same common
// values, sums, extremes, rows and keyed rows, of which none reads many more than its own at once.
#include <coracle/base/archive.h>
#include <coracle/base/exceptions.h>

#include <numeric>

#include "memory_store.h"
#include "tests.h"

using namespace coracle;

namespace
{
/// What one rank has: nodes in a row, two of which it shares with its neighbours.
struct State
{
  double                                 time = 0, energy = 0, rate = 0, step = 0;
  bool                                   flag = false;
  std::vector<std::string>               names;
  std::vector<std::vector<unsigned int>> lists;
  std::vector<dealii::Tensor<1, 2>>      momenta;
  std::vector<int>                       cells, list;
  Columns                                particles = Columns(2), nodes = Columns(2);
  std::vector<std::uint64_t>             keys;
  unsigned int                           n_owned = 0;

  void serialize(Archive &archive)
  {
    const Archive::Section section(archive, "state");
    archive.same("time", time);
    archive.same("flag", flag);
    archive.same("names", names);
    archive.own("lists", lists);
    archive.share("energy", energy);
    archive.share("momenta", momenta);
    archive.largest("rate", rate);
    archive.smallest("step", step);
    archive.all("cells", cells);
    archive.in_order("list", list, 2);
    archive.rows("particles", particles);
    archive.keyed("nodes", keys, n_owned, nodes, {1, 1});
  }
};

State
state_of(const int rank, const std::vector<std::uint64_t> &keys, const unsigned int n_owned)
{
  State state;
  state.time   = 1. / 3;
  state.flag   = true;
  state.energy = 0.1 * (rank + 1);
  state.rate   = rank == 1 ? 7 : rank;
  state.step   = 2 - rank;
  state.names  = {"a", "", "b c"};
  state.lists  = {{1, 2}, {}, {static_cast<unsigned int>(rank)}};
  state.momenta.resize(2);
  state.momenta[1][0] = rank;
  state.cells.assign(rank, rank);
  // Five pairs in all: none, three and two.
  for (int i = 0; i < 2 * (rank == 0 ? 0 : 4 - rank); ++i)
    state.list.push_back((rank == 2 ? 6 : 0) + i);
  state.particles.resize(rank + 1);
  for (int row = 0; row <= rank; ++row)
    state.particles[1][row] = 10 * rank + row;
  state.keys    = keys;
  state.n_owned = n_owned;
  state.nodes.resize(keys.size());
  for (unsigned int n = 0; n < keys.size(); ++n)
    {
      // Owners know the value, and each copy has a part of the sum.
      state.nodes[0][n] = n < n_owned ? 0.5 * keys[n] : -1;
      state.nodes[1][n] = 1;
    }
  return state;
}

template <typename T>
bool
equal(const T &a, const T &b)
{
  return a == b;
}

bool
equal(const Columns &a, const Columns &b)
{
  for (unsigned int c = 0; c < a.n_columns(); ++c)
    if (a.size() != b.size() || !std::equal(a[c], a[c] + a.size(), b[c]))
      return false;
  return true;
}
} // namespace

int
main()
{
  initlog();
  deallog << std::boolalpha;
  const std::vector<State> saved = {state_of(0, {0, 1, 2, 3}, 3),
                                    state_of(1, {3, 4, 2}, 2),
                                    state_of(2, {5, 4}, 1)};
  MemoryStore              memory(3);
  for (unsigned int rank = 0; rank < 3; ++rank)
    {
      memory.writer = rank;
      Archive archive(memory, Archive::Mode::save, rank, 3);
      State   copy = saved[rank];
      copy.serialize(archive);
    }

  bool exact = true;
  for (unsigned int rank = 0; rank < 3; ++rank)
    {
      Archive archive(memory, Archive::Mode::load, rank, 3);
      State   loaded;
      loaded.keys    = saved[rank].keys;
      loaded.n_owned = saved[rank].n_owned;
      loaded.nodes.resize(loaded.keys.size());
      loaded.serialize(archive);
      const State &s = saved[rank];
      exact          = exact && loaded.time == s.time && loaded.flag && loaded.energy == s.energy &&
              loaded.rate == s.rate && loaded.step == s.step && loaded.names == s.names &&
              loaded.lists == s.lists && loaded.momenta == s.momenta && loaded.cells == s.cells &&
              loaded.list == s.list && equal(loaded.particles, s.particles) &&
              equal(loaded.nodes, s.nodes);
    }
  deallog << "three ranks have their own back: " << exact << std::endl;

  State two[2];
  two[0].keys    = {0, 1, 2, 3, 4};
  two[0].n_owned = 4;
  two[1].keys    = {4, 5, 3};
  two[1].n_owned = 2;
  for (unsigned int rank = 0; rank < 2; ++rank)
    {
      two[rank].nodes.resize(two[rank].keys.size());
      Archive archive(memory, Archive::Mode::load, rank, 2);
      two[rank].serialize(archive);
    }
  deallog << "two know what is common: "
          << (two[1].time == 1. / 3 && two[1].flag && two[1].names == saved[0].names &&
              two[1].lists.empty())
          << ", extremes: " << (two[0].rate == 7 && two[1].step == 0) << std::endl;
  deallog << "sums " << two[0].energy + two[1].energy << ' '
          << two[0].momenta[1][0] + two[1].momenta[1][0] << ", rank 1 has " << two[1].energy
          << std::endl;
  deallog << "rows " << two[0].particles.size() << ' ' << two[1].particles.size() << ", sum of all "
          << std::accumulate(two[0].particles[1], two[0].particles[1] + 4, 0.) +
               std::accumulate(two[1].particles[1], two[1].particles[1] + 2, 0.)
          << ", cells " << two[1].cells.size() << std::endl;
  deallog << "one list: " << (two[0].list == std::vector<int>{0, 1, 2, 3}) << ' '
          << (two[1].list == std::vector<int>{4, 5, 6, 7, 8, 9}) << std::endl;
  for (const State &state : two)
    {
      for (unsigned int n = 0; n < state.keys.size(); ++n)
        deallog << "  node " << state.keys[n] << ": " << state.nodes[0][n] << ' '
                << state.nodes[1][n];
      deallog << std::endl;
    }
  two[0].keys[0] = 17;
  try
    {
      Archive archive(memory, Archive::Mode::load, 0, 2);
      two[0].serialize(archive);
    }
  catch (const RunFailure &failure)
    {
      deallog << failure.title << std::endl;
    }

  // Two ranks saved 300,000 rows each; of four each wants a stretch of them.
  MemoryStore        large(2);
  const unsigned int n_rows = 300000, n_wanted = 2 * n_rows / 4;
  for (unsigned int rank = 0; rank < 2; ++rank)
    {
      large.writer = rank;
      std::vector<std::uint64_t> keys, list;
      Columns                    rows(4);
      rows.resize(n_rows);
      for (unsigned int i = 0; i < n_rows; ++i)
        {
          keys.push_back(rank * n_rows + i);
          rows[2][i] = 0.5 * keys.back();
        }
      list = keys;
      Archive archive(large, Archive::Mode::save, rank, 2);
      archive.keyed("rows", keys, n_rows, rows, {});
      archive.in_order("list", list);
    }
  bool right = true;
  for (unsigned int rank = 0; rank < 4; ++rank)
    {
      large.n_sliced = 0;
      std::vector<std::uint64_t> keys, list;
      for (unsigned int i = 0; i < n_wanted; ++i)
        keys.push_back(rank * n_wanted + i);
      Columns rows(4);
      rows.resize(n_wanted);
      Archive archive(large, Archive::Mode::load, rank, 4);
      archive.keyed("rows", keys, n_wanted, rows, {});
      archive.in_order("list", list);
      for (unsigned int i = 0; i < n_wanted; ++i)
        right = right && rows[2][i] == 0.5 * keys[i];
      right = right && list == keys;
      // All keys, own rows and own part of the list.
      right = right && large.n_sliced < 8 * (2 * n_rows + n_wanted) + 1.01 * 32 * n_wanted;
    }
  deallog << "long ones in pieces: " << right << ", none of more than 4 MiB: "
          << (large.largest_slice <= (1 << 22) && large.largest_slice > (1 << 21)) << std::endl;

  // What does not hold together is refused, not read past its end.
  const auto refused = [&memory](const std::string &name, const std::size_t size) {
    MemoryStore damaged = memory;
    auto       &stored  = damaged.parts[1]["state/" + name];
    stored.block.n_rows = size;
    stored.bytes.resize(size *
                        (stored.bytes.size() / memory.parts[1]["state/" + name].block.n_rows));
    for (const unsigned int n_ranks : {2, 3})
      try
        {
          Archive archive(damaged, Archive::Mode::load, 1, n_ranks);
          State   loaded;
          loaded.keys    = {3, 4, 2};
          loaded.n_owned = 2;
          loaded.nodes.resize(3);
          loaded.serialize(archive);
          deallog << name << " with " << size << " entries is taken by " << n_ranks << std::endl;
        }
      catch (const RunFailure &)
        {
          deallog << name << " with " << size << " entries is refused by " << n_ranks << std::endl;
        }
  };
  refused("names.sizes", 2);
  refused("names", 3);
  refused("lists", 2);
  refused("momenta", 1);
  refused("list", 3);
  refused("nodes/keys", 4);
}
