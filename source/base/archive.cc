// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/archive.h>
#include <coracle/base/exceptions.h>

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

std::vector<char>
Archive::get(const unsigned int part, const std::string &name, const Block &block) const
{
  Block             found;
  std::vector<char> bytes = store.get(part, path + name, found);
  if (found.type != block.type || found.n_columns != block.n_columns ||
      (block.n_rows > 0 && found.n_rows != block.n_rows))
    throw does_not_fit(path + name,
                       std::to_string(found.n_rows) + " x " + std::to_string(found.n_columns) +
                         " values of kind " + std::to_string(static_cast<int>(found.type)));
  return bytes;
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
Archive::in_order(const std::string &name, std::vector<int> &values, const unsigned int n_together)
{
  if (is_exact())
    return same(name, values);
  // Parts are read twice, so that none has to hold the whole list.
  std::vector<int>         part;
  std::vector<std::size_t> ends;
  for (unsigned int p = 0; p < store.n_parts(); ++p)
    {
      load(p, name, part);
      ends.push_back((p > 0 ? ends.back() : 0) + part.size());
    }
  if (ends.back() % n_together != 0)
    throw_not_of_a_piece(name);
  const std::size_t n     = ends.back() / n_together;
  const std::size_t begin = n * rank / n_ranks * n_together,
                    end   = n * (rank + 1) / n_ranks * n_together;
  values.clear();
  for (unsigned int p = 0; p < store.n_parts(); ++p)
    {
      const std::size_t first = (p > 0 ? ends[p - 1] : 0);
      if (ends[p] <= begin || first >= end)
        continue;
      load(p, name, part);
      if (part.size() != ends[p] - first)
        throw_not_of_a_piece(name);
      values.insert(values.end(),
                    part.begin() + (std::max(begin, first) - first),
                    part.begin() + (std::min(end, ends[p]) - first));
    }
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

  std::size_t n_found = 0;
  for (unsigned int part = 0; part < store.n_parts(); ++part)
    {
      std::vector<std::uint64_t> saved_keys;
      std::uint64_t              n_saved_owned = 0;
      load(part, "keys", saved_keys);
      load(part, "n_owned", n_saved_owned);
      Columns saved(columns.n_columns());
      load_columns(part, "values", saved);
      if (saved.size() < saved_keys.size())
        throw_not_of_a_piece(name);
      for (unsigned int from = 0; from < saved_keys.size(); ++from)
        {
          const auto found = row_of_key.find(saved_keys[from]);
          if (found == row_of_key.end())
            continue;
          const unsigned int to = found->second;
          n_found += from < n_saved_owned;
          for (unsigned int c = 0; c < columns.n_columns(); ++c)
            if (!is_summed(c) && from < n_saved_owned)
              columns[c][to] = saved[c][from];
            else if (is_summed(c) && to < n_owned)
              columns[c][to] += saved[c][from];
        }
    }
  if (n_found != keys.size())
    throw does_not_fit(path + name, "not all nodes or elements are in it");
}
} // namespace coracle
