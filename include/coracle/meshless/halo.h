// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/mpi.h>
#include <coracle/meshless/period.h>
#include <coracle/meshless/point_cloud.h>

#include <algorithm>
#include <cstring>

namespace coracle::meshless
{
/**
 * Copies of other ranks' points that are near this rank's own, among them images
 * of points beyond a periodic face, also of own ones; and columns of values on
 * their way between points and their copies. An image has the id of its point. Every function is
 * collective; a rank without points takes part.
 */
class Halo
{
public:
  explicit Halo(const MPI_Comm comm) : comm(comm) {}

  /// Forget all copies, and append those of at least all points within `width` [m] of an own one,
  /// by rising id. No period is shorter than `width`.
  template <int dim>
  void rebuild(PointCloud<dim> &points, const double width, const Period<dim> &period = {});

  /// Rows behind the own ones become what their owners have; the column is resized to fit.
  template <typename T>
  void update(std::vector<T> &column) const
  {
    column.resize(n_own_rows + n_copies());
    receive(column, lent, borrowed, [](T &row, const T &value) { row = value; });
  }

  /// The same for places: images are a period away from what their owners have.
  template <int dim>
  void update_positions(std::vector<dealii::Point<dim>> &position) const
  {
    update(position);
    for (const auto &[copy, shift] : images)
      for (unsigned int d = 0; d < dim; ++d)
        position[n_own_rows + copy][d] += shift[d];
  }

  /// What copies hold is added to their owners' rows, in the order of the ranks, and becomes zero.
  template <typename T>
  void sum_to_owners(std::vector<T> &column) const
  {
    receive(column, borrowed, lent, [](T &row, const T &value) { row += value; });
    std::fill(column.begin() + n_own_rows, column.end(), T());
  }

  std::size_t n_own() const { return n_own_rows; }
  std::size_t n_copies() const { return owner_of_copy.size(); }
  /// Rank that owns a copy, counted from the first one.
  unsigned int owner(const std::size_t copy) const { return owner_of_copy[copy]; }

private:
  using Rows = std::map<unsigned int, std::vector<unsigned int>>;

  template <typename T, typename Take>
  void receive(std::vector<T> &column, const Rows &from, const Rows &to, const Take &take) const
  {
    static_assert(std::is_trivially_copyable_v<T>, "values travel as bytes");
    std::map<unsigned int, mpi::Buffer> sent, received;
    for (const auto &[rank, rows] : from)
      {
        sent[rank].resize(rows.size() * sizeof(T));
        for (std::size_t i = 0; i < rows.size(); ++i)
          std::memcpy(&sent[rank][i * sizeof(T)], &column[rows[i]], sizeof(T));
      }
    for (const auto &[rank, rows] : to)
      received[rank].resize(rows.size() * sizeof(T));
    exchange(sent, received);
    for (const auto &[rank, rows] : to)
      for (std::size_t i = 0; i < rows.size(); ++i)
        {
          T value;
          std::memcpy(&value, &received[rank][i * sizeof(T)], sizeof(T));
          take(column[rows[i]], value);
        }
  }

  /// Both sides know who sends and how much.
  void exchange(std::map<unsigned int, mpi::Buffer> &sent,
                std::map<unsigned int, mpi::Buffer> &received) const;

  MPI_Comm    comm;
  std::size_t n_own_rows = 0;
  /// By rank: own rows that are copies there, and rows that are copies of that rank's.
  Rows                      lent, borrowed;
  std::vector<unsigned int> owner_of_copy;
  /// Copies that are images, counted from the first copy, and how far they are from their points.
  std::vector<std::pair<unsigned int, std::array<double, 3>>> images;
};
} // namespace coracle::meshless
