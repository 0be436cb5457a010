// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/mpi.h>
#include <coracle/meshless/point_cloud.h>

namespace coracle::meshless
{
/**
 * Copies of other ranks' points that are near this rank's own, and columns of
 * values on their way between points and their copies. Every function is
 * collective; a rank without points takes part.
 */
class Halo
{
public:
  explicit Halo(const MPI_Comm comm) : comm(comm) {}

  /// Forget all copies, and append those of at least all points within `width` [m] of an own one,
  /// by rising id.
  template <int dim>
  void rebuild(PointCloud<dim> &points, const double width);

  /// Rows behind the own ones become what their owners have; the column is resized to fit.
  template <typename T>
  void update(std::vector<T> &column) const;

  /// What copies hold is added to their owners' rows, in the order of the ranks, and becomes zero.
  template <typename T>
  void sum_to_owners(std::vector<T> &column) const;

  std::size_t n_own() const { return n_own_rows; }
  std::size_t n_copies() const { return owner_of_copy.size(); }
  /// Rank that owns a copy, counted from the first one.
  unsigned int owner(const std::size_t copy) const { return owner_of_copy[copy]; }

private:
  using Rows = std::map<unsigned int, std::vector<unsigned int>>;

  /// Values of rows here to the rows that answer to them there.
  template <typename T, typename Take>
  void send(const std::vector<T> &column, const Rows &from, const Rows &to, const Take &take) const;

  MPI_Comm    comm;
  std::size_t n_own_rows = 0;
  /// By rank: own rows that are copies there, and rows that are copies of that rank's.
  Rows                      lent, borrowed;
  std::vector<unsigned int> owner_of_copy;
};
} // namespace coracle::meshless
