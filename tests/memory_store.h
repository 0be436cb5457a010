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
  bool has(const unsigned int part, const std::string &name) const override
  {
    return parts[part].count(name) > 0;
  }
  unsigned int n_parts() const override { return parts.size(); }

  unsigned int                               writer = 0;
  std::vector<std::map<std::string, Stored>> parts;
};
} // namespace coracle
