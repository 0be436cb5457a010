// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/archive.h>
#include <coracle/base/exceptions.h>

#include <cstring>
#include <unordered_map>

namespace coracle
{
namespace
{
RunFailure
does_not_fit(const std::string &name, const std::string &why)
{
  return RunFailure("a checkpoint does not fit this case",
                    "'" + name + "': " + why,
                    "go on with the program and the parameter file that wrote it");
}
/// Some rows of columns as they are stored: all of the first quantity, then all of the next.
struct Piece
{
  std::size_t       first, length;
  std::vector<char> bytes;

  double operator()(const unsigned int column, const std::size_t row) const
  {
    double result;
    std::memcpy(&result,
                bytes.data() + (column * length + row - first) * sizeof(double),
                sizeof(double));
    return result;
  }
};
} // namespace

void
Archive::throw_not_of_a_piece(const std::string &name) const
{
  throw does_not_fit(path + name, "its parts do not belong together");
}

void
Archive::put(const std::string &name, const Block &block, const void *const values)
{
  store.put(path + name, block, values);
}

Block
Archive::look(const unsigned int part, const std::string &name, const Block &block) const
{
  Block found;
  store.get_slice(part, path + name, {0, 0, 0, 0}, found);
  if (found.type != block.type || (block.n_columns > 0 && found.n_columns != block.n_columns) ||
      (block.n_rows > 0 && found.n_rows != block.n_rows))
    throw does_not_fit(path + name,
                       std::to_string(found.n_rows) + " x " + std::to_string(found.n_columns) +
                         " values of kind " + std::to_string(static_cast<int>(found.type)));
  return found;
}

std::vector<char>
Archive::get_slice(const unsigned int part, const std::string &name, const Slice &slice) const
{
  Block found;
  return store.get_slice(part, path + name, slice, found);
}

std::vector<char>
Archive::get(const unsigned int part, const std::string &name, const Block &block) const
{
  look(part, name, block);
  Block found;
  return store.get(part, path + name, found);
}

void
Archive::save_columns(const std::string &name, Columns &columns)
{
  // A row of the block is a column here, so that each lies in one piece.
  std::vector<double> values;
  values.reserve(columns.size() * columns.n_columns());
  for (unsigned int c = 0; c < columns.n_columns(); ++c)
    values.insert(values.end(), columns[c], columns[c] + columns.size());
  put(name, {Block::Type::real, columns.n_columns(), columns.size()}, values.data());
}

void
Archive::load_columns(const unsigned int part, const std::string &name, Columns &columns) const
{
  Block                   block;
  const std::vector<char> bytes = store.get(part, path + name, block);
  if (block.type != Block::Type::real || block.n_rows != columns.n_columns())
    throw does_not_fit(path + name,
                       std::to_string(block.n_rows) + " quantities a row instead of " +
                         std::to_string(columns.n_columns()));
  const std::size_t first = columns.size(), n = block.n_columns;
  columns.resize(first + n);
  for (unsigned int c = 0; c < columns.n_columns(); ++c)
    std::copy_n(bytes.data() + c * n * sizeof(double),
                n * sizeof(double),
                reinterpret_cast<char *>(columns[c] + first));
}

void
Archive::rows(const std::string &name, Columns &columns)
{
  if (!loads())
    return save_columns(name, columns);
  columns.resize(0);
  if (is_exact())
    return load_columns(rank, name, columns);
  for (unsigned int part = rank; part < store.n_parts(); part += n_ranks)
    load_columns(part, name, columns);
}

void
Archive::keyed(const std::string                &name,
               const std::vector<std::uint64_t> &keys,
               const unsigned int                n_owned,
               Columns                          &columns,
               const Summed                     &summed)
{
  const Section section(*this, name);
  if (!loads())
    {
      const std::uint64_t n = n_owned;
      save("n_owned", n);
      save("keys", keys);
      return save_columns("values", columns);
    }
  if (!is_exact())
    return load_by_key(name, keys, n_owned, columns, summed);

  std::vector<std::uint64_t> saved_keys;
  load(rank, "keys", saved_keys);
  const std::size_t n_rows = columns.size();
  columns.resize(0);
  load_columns(rank, "values", columns);
  if (saved_keys != keys || columns.size() != n_rows)
    throw does_not_fit(path, "other nodes or elements than this rank's");
}

void
Archive::load_by_key(const std::string                &name,
                     const std::vector<std::uint64_t> &keys,
                     const unsigned int                n_owned,
                     Columns                          &columns,
                     const Summed                     &summed) const
{
  std::unordered_map<std::uint64_t, unsigned int> row_of_key;
  for (unsigned int row = 0; row < keys.size(); ++row)
    row_of_key.emplace(keys[row], row);
  const auto is_summed = [&summed](const unsigned int c) {
    return c >= summed.first && c < summed.first + summed.n;
  };
  for (unsigned int c = summed.first; c < summed.first + summed.n; ++c)
    std::fill_n(columns[c], columns.size(), 0.);

  const std::size_t n_columns        = columns.n_columns(),
                    at_once          = std::max<std::size_t>(1,
                                                    bytes_at_once / sizeof(double) /
                                                      std::max<std::size_t>(1, n_columns));
  std::size_t                n_found = 0;
  std::vector<std::uint64_t> saved_keys(at_once);
  for (unsigned int part = 0; part < store.n_parts(); ++part)
    {
      std::uint64_t n_saved_owned = 0;
      load(part, "n_owned", n_saved_owned);
      const std::size_t n_keys = look(part, "keys", {Block::Type::natural, 0, 1}).n_rows;
      if (look(part, "values", {Block::Type::real, n_columns, 0}).n_columns < n_keys)
        throw_not_of_a_piece(name);
      for (std::size_t begin = 0; begin < n_keys; begin += at_once)
        {
          const std::size_t n     = std::min(at_once, n_keys - begin);
          const auto        bytes = get_slice(part, "keys", {begin, n, 0, 1});
          std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char *>(saved_keys.data()));
          // Those of this rank: place in the piece, row here.
          std::vector<std::pair<std::size_t, unsigned int>> mine;
          for (std::size_t i = 0; i < n; ++i)
            if (const auto found = row_of_key.find(saved_keys[i]); found != row_of_key.end())
              mine.emplace_back(i, found->second);
          if (mine.empty())
            continue;
          Piece value{mine.front().first, mine.back().first + 1 - mine.front().first, {}};
          value.bytes =
            get_slice(part, "values", {0, n_columns, begin + value.first, value.length});
          for (const auto &[from, to] : mine)
            {
              const bool is_owned = begin + from < n_saved_owned;
              n_found += is_owned;
              for (unsigned int c = 0; c < n_columns; ++c)
                if (!is_summed(c) && is_owned)
                  columns[c][to] = value(c, from);
                else if (is_summed(c) && to < n_owned)
                  columns[c][to] += value(c, from);
            }
        }
    }
  if (n_found != keys.size())
    throw does_not_fit(path + name, "not all nodes or elements are in it");
}
} // namespace coracle
