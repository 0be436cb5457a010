// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>

#include <coracle/base/columns.h>

#include <memory>
#include <vector>

namespace coracle
{
/**
 * Sums what ranks have gathered on the mesh nodes they share, and hands
 * results back, for neighbouring columns of node data in one message.
 *
 * Rows are local node numbers: owned nodes first, then ghosts by global number.
 * Contributions are added in the order of the ranks, so that a run repeats
 * bit by bit. Collective: every rank calls, also one without nodes.
 */
class ColumnExchange
{
public:
  ColumnExchange() = default;
  ColumnExchange(const dealii::IndexSet &owned, const dealii::IndexSet &ghosts, MPI_Comm comm);

  /// Ghost rows are added to their owners' and become zero.
  void sum_to_owners(Columns &columns, const unsigned int first, const unsigned int n) const;
  /// Ghost rows become what their owners have.
  void update_ghosts(Columns &columns, const unsigned int first, const unsigned int n) const;

  unsigned int n_owned() const { return partitioner->locally_owned_size(); }
  unsigned int n_local() const { return n_owned() + partitioner->n_ghost_indices(); }
  /// Rank that owns a local row.
  int owner(const unsigned int row) const { return owners[row]; }
  /// Global number of a local row, and vectors of the same layout for output.
  const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &indices() const
  {
    return partitioner;
  }

private:
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  std::vector<int>                                           owners;
  /// Owned rows that are ghosts elsewhere, in the order of the ranks that have them.
  std::vector<unsigned int>   imported;
  mutable std::vector<double> buffer;
};
} // namespace coracle
