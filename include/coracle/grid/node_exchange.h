// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <array>
#include <memory>
#include <vector>

namespace coracle
{
/// Eight doubles of one node, one cache line: one scatter touches one line.
struct alignas(64) NodeRecord
{
  std::array<double, 8> data{};

  double       &operator[](const unsigned int i) { return data[i]; }
  const double &operator[](const unsigned int i) const { return data[i]; }
};

using NodeRecords = dealii::AlignedVector<NodeRecord>;

/**
 * Sums what ranks have gathered on the nodes they share, and hands results
 * back. Local numbering: owned nodes, then ghosts by global number.
 */
class NodeExchange
{
public:
  void reinit(const dealii::IndexSet &owned, const dealii::IndexSet &relevant, MPI_Comm comm);

  unsigned int n_owned() const { return partitioner->locally_owned_size(); }
  unsigned int n_ghosts() const { return partitioner->n_ghost_indices(); }

  /// Does this rank share no node with any other?
  bool is_serial() const { return owners.size() == n_owned() && imported.empty(); }

  /// Ghost values are added to their owners and become zero.
  void sum_to_owners(NodeRecords &records) const;
  /// Ghosts become what their owners have.
  void update_ghosts(NodeRecords &records) const;

  const dealii::Utilities::MPI::Partitioner &indices() const { return *partitioner; }
  /// Rank of a local index.
  int owner(const unsigned int local_index) const { return owners[local_index]; }
  /// Bytes sent by this rank in one sum or update.
  std::size_t bytes_per_exchange() const;

private:
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  std::vector<int>                                           owners;
  /// Owned nodes that are ghosts elsewhere, in the order of the partitioner's import targets.
  std::vector<unsigned int> imported;
  mutable NodeRecords       buffer;
};
} // namespace coracle
