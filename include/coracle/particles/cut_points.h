// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/pack.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace coracle
{
/**
 * The particles of a body that a sheet cuts off from some of the grid nodes
 * they would reach, with the nodes that they use instead, for one step.
 *
 * They take a path of their own in all sweeps: whatever goes between such a
 * particle and the grid goes through its entries, which hold its weights on
 * records of non-hanging nodes. The sweeps over packed rows and strays leave
 * these rows out. Filled by CutPointsBuilder; empty where there are no sheets.
 */
template <int dim>
class CutPoints
{
public:
  struct Entry
  {
    /// Record of the nodal field, see NodeSplit.
    unsigned int node;
    /// Weight N [1].
    double value;
    /// Its gradient [1/m].
    dealii::Tensor<1, dim> gradient;
    /// Sum of the weights of the corners that it stands for times their arms from the particle's
    /// centre [m], for the affine part of momenta (APIC).
    dealii::Tensor<1, dim> moment;
  };

  /// Rows in ascending order; the leaf each is in; its place among the means of leaves: particles
  /// of one leaf that see the same corners have a mean of their own.
  std::vector<unsigned int> row, leaf, mean;
  /// Entries of row[i]: entries[begin[i]] up to entries[begin[i + 1]].
  std::vector<std::size_t> begin = {0};
  std::vector<Entry>       entries;
  /// Places that means need behind those of the leaves.
  unsigned int n_means = 0;

  bool         empty() const { return row.empty(); }
  unsigned int size() const { return row.size(); }

  bool contains(const std::size_t r) const { return !row.empty() && is_cut[r] != 0; }

  /// Place of a row in the lists above; the row must be there.
  unsigned int find(const unsigned int r) const
  {
    return std::lower_bound(row.begin(), row.end(), r) - row.begin();
  }

  /// Lanes of the pack that starts at this row that are not in the list.
  Mask8 others(const std::size_t r) const
  {
    Mask8         mask = Mask8{} - 1;
    std::uint64_t cut;
    std::memcpy(&cut, is_cut.data() + r, sizeof(cut));
    if (__builtin_expect(cut != 0, 0))
      for (int l = 0; l < pack_size; ++l)
        mask[l] = is_cut[r + l] ? 0 : -1;
    return mask;
  }

  /// Forget all; the body has so many rows now.
  void reinit(const std::size_t n_rows)
  {
    for (const unsigned int r : row)
      is_cut[r] = 0;
    is_cut.resize(n_rows + pack_size, 0);
    row.clear();
    leaf.clear();
    mean.clear();
    entries.clear();
    begin.assign(1, 0);
    n_means = 0;
  }

  /// The entries since the last call belong to this row, which is higher than all before.
  void add_row(const unsigned int r, const unsigned int in_leaf)
  {
    row.push_back(r);
    leaf.push_back(in_leaf);
    mean.push_back(in_leaf);
    begin.push_back(entries.size());
    is_cut[r] = 1;
  }

  std::size_t memory_consumption() const
  {
    return is_cut.capacity() + entries.capacity() * sizeof(Entry) +
           row.capacity() * (3 * sizeof(unsigned int) + sizeof(std::size_t));
  }

private:
  std::vector<unsigned char> is_cut;
};
} // namespace coracle
