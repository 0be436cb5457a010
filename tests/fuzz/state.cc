// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever blocks the state of a checkpoint holds, whole or not, it is loaded or refused with a
// RunFailure: what is behind the checksums. The input says which blocks there are, of which kind
// and size, and what is in them; it is loaded by one rank, by two and by three. One input in
// sixteen is written as HDF5 and read again, which is slow.

#include <coracle/base/archive.h>
#include <coracle/base/exceptions.h>
#include <coracle/io/hdf5_archive.h>

#include <fuzzer/FuzzedDataProvider.h>

#include "memory_store.h"
#include "target.h"

namespace
{
using namespace coracle;

/// A member of every kind.
struct State
{
  double                                 time = 0, step = 0;
  std::vector<std::string>               names;
  std::vector<std::vector<unsigned int>> lists;
  std::vector<dealii::Tensor<1, 2>>      momenta;
  std::vector<int>                       cells, list;
  Columns                                particles = Columns(2), nodes = Columns(2);
  std::vector<std::uint64_t>             keys = {1, 2, 3};

  void serialize(Archive &archive)
  {
    nodes.resize(keys.size());
    const Archive::Section section(archive, "s");
    archive.same("time", time);
    archive.smallest("step", step);
    archive.same("names", names);
    archive.same("lists", lists);
    archive.share("momenta", momenta);
    archive.all("cells", cells);
    archive.in_order("list", list, 4);
    archive.rows("particles", particles);
    if (archive.has("nodes"))
      archive.keyed("nodes", keys, 2, nodes, {1, 1});
  }
};

const char *const names[] = {"s/time",
                             "s/step",
                             "s/names",
                             "s/names.sizes",
                             "s/lists",
                             "s/lists.sizes",
                             "s/momenta",
                             "s/cells",
                             "s/list",
                             "s/particles",
                             "s/nodes/n_owned",
                             "s/nodes/keys",
                             "s/nodes/values"};

/// Blocks as they should be, but for those that the input tells otherwise.
void
put_blocks(FuzzedDataProvider &input, ArchiveStore &store)
{
  const Block::Type types[]  = {Block::Type::real,
                                Block::Type::natural,
                                Block::Type::natural_32,
                                Block::Type::integer_32,
                                Block::Type::byte};
  const int         usual[]  = {0, 0, 4, 1, 2, 1, 0, 3, 3, 0, 1, 1, 0};
  const unsigned    n_rows[] = {1, 1, 5, 2, 5, 2, 2, 3, 8, 2, 1, 3, 2},
                 n_columns[] = {1, 1, 1, 1, 1, 1, 2, 1, 1, 3, 1, 1, 3};
  for (unsigned int i = 0; i < 13; ++i)
    {
      const unsigned int choice = input.ConsumeIntegral<std::uint8_t>();
      if (choice == 1)
        continue;
      Block block{types[usual[i]], n_rows[i], n_columns[i]};
      if (choice & 2)
        block.type = types[input.ConsumeIntegral<std::uint8_t>() % 5];
      if (choice & 4)
        block.n_rows = input.ConsumeIntegral<std::uint8_t>() % 40;
      if (choice & 8)
        block.n_columns = input.ConsumeIntegral<std::uint8_t>() % 5;
      std::vector<std::uint64_t> values(block.n_rows * block.n_columns + 1, 2);
      if (choice & 16)
        for (auto &value : values)
          value = input.ConsumeIntegral<std::uint64_t>();
      store.put(names[i], block, values.data());
    }
}

void
load(ArchiveStore &store)
{
  for (const unsigned int n_ranks : {1, 2, 3})
    for (unsigned int rank = 0; rank < n_ranks; ++rank)
      try
        {
          Archive archive(store, Archive::Mode::load, rank, n_ranks);
          State   state;
          state.serialize(archive);
        }
      catch (const RunFailure &)
        {}
}
} // namespace

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  fuzz::start();
  FuzzedDataProvider       input(data, size);
  const bool               hdf5 = (input.ConsumeIntegral<std::uint8_t>() % 16 == 15);
  MemoryStore              memory(2);
  std::vector<std::string> files;
  for (unsigned int part = 0; part < 2; ++part)
    if (hdf5)
      {
        Hdf5Archive store;
        put_blocks(input, store);
        const auto bytes = store.image();
        files.push_back(fuzz::place() + "/state." + std::to_string(part) + ".h5");
        fuzz::write(files.back(), bytes.data(), bytes.size());
      }
    else
      {
        memory.writer = part;
        put_blocks(input, memory);
      }
  if (!hdf5)
    load(memory);
  else
    {
      Hdf5Archive store(files);
      load(store);
    }
  return 0;
}
