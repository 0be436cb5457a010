// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <coracle/contact/lanes.h>
#include <coracle/contact/rows.h>

namespace coracle::contact
{
/**
 * Unknowns of which each block of contacts has a copy of its own (BlockRows), on
 * whichever rank the block is: like SharedUnknowns with blocks in the place of
 * ranks. The owner of an unknown adds up what its copies have, one by one in the
 * order of the blocks, so that sums do not depend on the ranks.
 */
template <int dim>
class OrderedCopies
{
public:
  using Vector = dealii::Tensor<1, dim>;

  explicit OrderedCopies(MPI_Comm communicator);

  /**
   * Collective. Finds out who shares what.
   * @param copies equal keys mean copies of one unknown
   * @param block  of each copy, unique over ranks
   */
  void reinit(const std::vector<Unknown<dim>> &copies, const std::vector<std::uint64_t> &block);

  /// Number of copies of this copy's unknown on all ranks.
  unsigned int multiplicity(const unsigned int copy) const { return counts[copy]; }

  /// Collective. value[copy] becomes before[copy] plus the mean of (value - before) over all copies
  /// of the unknown.
  void average_change(std::vector<Lanes<dim>> &value, const std::vector<Lanes<dim>> &before);

  /// Collective. The copy in the first block gets the sum of all copies' values, the others zero.
  void sum_to_first(std::vector<Vector> &value);

private:
  /// Copies with others elsewhere, that one rank owns (local copies), or has (places in `order`).
  struct Exchange
  {
    int                       rank;
    std::vector<unsigned int> index;
    std::vector<double>       buffer;
  };
  /// A copy as its owner knows it: which exchange, and where in it.
  struct Place
  {
    unsigned int exchange, entry;
  };

  /// What copies have to their owners, or back.
  void swap(std::vector<Exchange> &from, std::vector<Exchange> &to);
  /// Calls action(first, last) with the places of each unknown's copies, in the order of the
  /// blocks.
  template <typename Action>
  void for_each_unknown(const Action &action) const
  {
    for (std::size_t u = 0; u + 1 < begin.size(); ++u)
      action(order.data() + begin[u], order.data() + begin[u + 1]);
  }

  MPI_Comm                  communicator;
  std::vector<unsigned int> counts;
  std::vector<char>         is_first;
  std::vector<Exchange>     to_owner, from_users;
  std::vector<Place>        order;
  std::vector<std::size_t>  begin;
};
} // namespace coracle::contact
