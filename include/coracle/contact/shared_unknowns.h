// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <coracle/contact/lanes.h>
#include <coracle/contact/rows.h>

namespace coracle::contact
{
/**
 * The unknowns that contacts of several ranks act on. An unknown that n ranks
 * touch is split among them: each works with n times its inverse mass, and its
 * velocity then changes by the mean of what the ranks have changed it by
 * (mass splitting; Tonge, Benevolenski & Voroshilov 2012). That is the sum of
 * their impulses divided by the true mass.
 */
template <int dim>
class SharedUnknowns
{
public:
  explicit SharedUnknowns(MPI_Comm communicator);

  /// Collective. Finds out who shares what.
  void reinit(const std::vector<Unknown<dim>> &unknowns);

  /// Number of ranks that have contacts at this unknown, at least 1.
  unsigned int multiplicity(const unsigned int unknown) const { return counts[unknown]; }

  /**
   * Collective. Where an unknown is shared, replaces value[unknown] by
   * before[unknown] plus the mean of (value - before) over its ranks.
   */
  void average_change(std::vector<Lanes<dim>> &value, const std::vector<Lanes<dim>> &before);

private:
  /// What is sent to, or received from, one rank.
  struct Exchange
  {
    int                       rank;
    std::vector<unsigned int> index;
    std::vector<double>       buffer;
  };

  void keep_shared(const std::vector<std::vector<unsigned int>> &sent,
                   const std::vector<std::vector<unsigned int>> &received);

  MPI_Comm                  communicator;
  std::vector<unsigned int> counts;
  /// Unknowns that others own, by owner; slots that others asked for, by asking rank.
  std::vector<Exchange> to_owner, from_users;
  /// Sums that this rank, as owner, builds up: one slot a key; its own unknown, or -1.
  std::vector<Lanes<dim>>   slot_sum;
  std::vector<int>          slot_unknown;
  std::vector<unsigned int> slot_count;
  std::vector<MPI_Request>  requests;
};
} // namespace coracle::contact
