// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/columns.h>
#include <coracle/base/mpi.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace coracle
{
/**
 * Rows that any rank finds by their keys, wherever they come from: each key has one rank that keeps
 * its row, by a hash, so that each keeps about as many and none all of them.
 */
class KeyDirectory
{
public:
  KeyDirectory(const unsigned int n_columns, const MPI_Comm comm);

  /// Rows with these keys, which may be on any rank; of a key that is there, the first row stays.
  /// Collective.
  void add(const std::vector<std::uint64_t> &keys, const Columns &rows);

  /// The row of each of the keys, where it is there. Collective.
  /// @param rows as many as keys; those of unknown keys stay as they are
  /// @return which are there
  std::vector<bool> find(const std::vector<std::uint64_t> &keys, Columns &rows) const;

  /// Keys that this rank keeps.
  std::size_t n_kept() const { return row_of_key.size(); }

private:
  unsigned int home(const std::uint64_t key) const;

  const unsigned int                               n_columns, n_ranks;
  const MPI_Comm                                   comm;
  std::unordered_map<std::uint64_t, std::uint64_t> row_of_key;
  std::vector<double>                              kept;
};
} // namespace coracle
