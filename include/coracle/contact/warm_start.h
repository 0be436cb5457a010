// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/tensor.h>

#include <coracle/base/archive.h>

#include <cstdint>
#include <vector>

namespace coracle::contact
{
/**
 * The impulses of the last step by point and facet, to start the next solve
 * from: a hash table that is refilled every step without allocating.
 */
template <int dim>
class WarmStart
{
public:
  struct Key
  {
    std::uint64_t point, facet;
  };

  /// Impulses that these contacts had on this rank, zero if they are new here.
  std::vector<dealii::Tensor<1, dim>> find(const std::vector<Key> &keys) const;
  /// Those that they had on any rank. Collective.
  std::vector<dealii::Tensor<1, dim>> find_on_all_ranks(const std::vector<Key> &keys,
                                                        MPI_Comm                communicator) const;

  /// Forget the old impulses and keep these.
  void store(const std::vector<Key> &keys, const std::vector<dealii::Tensor<1, dim>> &impulses);

  /// On other ranks than have saved them, all ranks know all impulses until the next step.
  void serialize(Archive &archive);

private:
  struct Slot
  {
    Key                    key;
    dealii::Tensor<1, dim> impulse;
    bool                   used = false;
  };
  std::size_t            place(const Key &key) const;
  dealii::Tensor<1, dim> find(const Key &key) const;

  std::vector<Slot> slots;
};
} // namespace coracle::contact
