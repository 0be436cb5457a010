// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/base/exceptions.h>

#include <map>
#include <string>
#include <vector>

namespace coracle
{
/// An archive in memory, for tests: what each of some ranks has put there.
class MemoryStore : public ArchiveStore
{
public:
  struct Stored
  {
    Block             block;
    std::vector<char> bytes;
  };

  explicit MemoryStore(const unsigned int n) : parts(n) {}

  void put(const std::string &name, const Block &block, const void *values) override
  {
    const std::size_t size  = block.type == Block::Type::real || block.type == Block::Type::natural
                                ? 8
                              : block.type == Block::Type::byte ? 1
                                                                : 4;
    const char *const begin = static_cast<const char *>(values);
    parts[writer][name]     = {block,
                               std::vector<char>(begin, begin + size * block.n_rows * block.n_columns)};
  }
  std::vector<char>
  get(const unsigned int part, const std::string &name, Block &block) const override
  {
    const auto found = parts[part].find(name);
    if (found == parts[part].end())
      throw RunFailure("a checkpoint does not fit this case", name + " is not there", "");
    block = found->second.block;
    return found->second.bytes;
  }
  std::vector<char> get_slice(const unsigned int part,
                              const std::string &name,
                              const Slice       &slice,
                              Block             &block) const override
  {
    const auto        whole = get(part, name, block);
    const std::size_t width =
      whole.size() / std::max<std::size_t>(1, block.n_rows * block.n_columns);
    if (slice.first_row + slice.n_rows > block.n_rows ||
        slice.first_column + slice.n_columns > block.n_columns)
      throw RunFailure("a checkpoint does not fit this case", name + " is too short", "");
    std::vector<char> result;
    for (std::size_t row = slice.first_row; row < slice.first_row + slice.n_rows; ++row)
      {
        const auto begin = whole.begin() + (row * block.n_columns + slice.first_column) * width;
        result.insert(result.end(), begin, begin + slice.n_columns * width);
      }
    if (slice.n_columns > 0 && slice.n_rows > 0)
      largest_slice = std::max(largest_slice, result.size());
    n_sliced += result.size();
    return result;
  }
  bool has(const unsigned int part, const std::string &name) const override
  {
    return parts[part].count(name) > 0;
  }
  unsigned int n_parts() const override { return parts.size(); }

  unsigned int writer = 0;
  /// What was read in slices, in bytes: the largest one, and all of them.
  mutable std::size_t                        largest_slice = 0, n_sliced = 0;
  std::vector<std::map<std::string, Stored>> parts;
};
} // namespace coracle
