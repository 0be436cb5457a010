// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/columns.h>

namespace coracle
{
Columns::Columns(const unsigned int n_columns) : columns(n_columns)
{
  for (auto &column : columns)
    column.resize(pack_size);
}

void
Columns::resize(const std::size_t n)
{
  if (n > capacity)
    {
      capacity = std::max(n, capacity + capacity / 2);
      for (auto &column : columns)
        column.resize(capacity + pack_size);
    }
  // Rows given up and taken again must be zero, and so must the spare entries.
  const std::size_t first = std::min(n, n_rows), last = std::max(n, n_rows);
  for (auto &column : columns)
    std::fill(column.data() + first, column.data() + last, 0.);
  n_rows = n;
}

void
Columns::reorder(const std::vector<unsigned int> &source)
{
  if (scratch.size() < capacity + pack_size)
    scratch.resize(capacity + pack_size);
  const std::size_t n = source.size();
  for (auto &column : columns)
    {
      const double *const from = column.data();
      double *const       to   = scratch.data();
      for (std::size_t i = 0; i < n; ++i)
        to[i] = from[source[i]];
      std::fill(to + n, to + capacity + pack_size, 0.);
      column.swap(scratch);
    }
  n_rows = n;
}

void
Columns::get_row(const std::size_t row, double *const values) const
{
  for (unsigned int c = 0; c < columns.size(); ++c)
    values[c] = columns[c][row];
}

void
Columns::set_row(const std::size_t row, const double *const values)
{
  for (unsigned int c = 0; c < columns.size(); ++c)
    columns[c][row] = values[c];
}

std::size_t
Columns::memory_consumption() const
{
  std::size_t bytes = scratch.memory_consumption();
  for (const auto &column : columns)
    bytes += column.memory_consumption();
  return bytes;
}
} // namespace coracle
