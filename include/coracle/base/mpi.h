// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/base/utilities.h>

#include <coracle/base/exceptions.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace coracle::mpi
{
/// Bytes that one rank sends to another.
using Buffer = std::vector<char>;

inline unsigned int
rank(const MPI_Comm comm)
{
  return dealii::Utilities::MPI::this_mpi_process(comm);
}

inline unsigned int
n_ranks(const MPI_Comm comm)
{
  return dealii::Utilities::MPI::n_mpi_processes(comm);
}

/// Sums and extremes over all ranks, known to all ranks. Collective.
template <typename T>
T
sum(const T &value, const MPI_Comm comm)
{
  return dealii::Utilities::MPI::sum(value, comm);
}

template <typename T>
T
min(const T &value, const MPI_Comm comm)
{
  return dealii::Utilities::MPI::min(value, comm);
}

template <typename T>
T
max(const T &value, const MPI_Comm comm)
{
  return dealii::Utilities::MPI::max(value, comm);
}

/// Sum of what lower ranks have: the first of this rank's numbers in a numbering through all ranks.
/// Collective.
template <typename T>
T
offset(const T &value, const MPI_Comm comm)
{
  T result{};
  MPI_Exscan(&value, &result, 1, dealii::Utilities::MPI::mpi_type_id_for_type<T>, MPI_SUM, comm);
  return rank(comm) == 0 ? T{} : result;
}

/// True on all ranks if it is true on any. Collective.
bool any(const bool value, const MPI_Comm comm);

/**
 * Send a buffer to each of some ranks, and receive what others send to this one.
 * Nobody knows beforehand who sends; ranks without partners take part, and an
 * empty buffer arrives as an empty buffer. Collective.
 *
 * Works by consensus (Hoefler, Siebert & Lumsdaine 2010, as in deal.II), so the
 * cost grows with the partners and log(ranks), not with the ranks.
 */
std::map<unsigned int, Buffer> exchange_buffers(const std::map<unsigned int, Buffer> &to_send,
                                                const MPI_Comm                        comm);

/// The same for values of a trivially copyable type.
template <typename T>
std::map<unsigned int, std::vector<T>>
exchange_values(const std::map<unsigned int, std::vector<T>> &to_send, const MPI_Comm comm)
{
  static_assert(std::is_trivially_copyable_v<T>, "values travel as bytes");
  std::map<unsigned int, Buffer> bytes;
  for (const auto &[receiver, values] : to_send)
    {
      const char *const begin = reinterpret_cast<const char *>(values.data());
      bytes[receiver].assign(begin, begin + values.size() * sizeof(T));
    }
  std::map<unsigned int, std::vector<T>> received;
  for (const auto &[sender, buffer] : exchange_buffers(bytes, comm))
    {
      received[sender].resize(buffer.size() / sizeof(T));
      std::copy(buffer.begin(), buffer.end(), reinterpret_cast<char *>(received[sender].data()));
    }
  return received;
}

/**
 * Something may have gone wrong on some ranks: run the function on each, and if
 * it threw a UserError or RunFailure on any, throw that of the lowest such rank
 * on all of them. Every rank must call it, and the function must not communicate
 * (a rank that throws would leave the others waiting). Collective.
 */
void agree(const std::function<void()> &function, const MPI_Comm comm);

/**
 * Run a function on rank 0 and hand its result, or its UserError, to all ranks.
 * The result must be something that dealii::Utilities::pack can store. Collective.
 */
template <typename Result>
Result
on_root(const std::function<Result()> &function, const MPI_Comm comm)
{
  Result result{};
  agree(
    [&] {
      if (rank(comm) == 0)
        result = function();
    },
    comm);
  return dealii::Utilities::MPI::broadcast(comm, result, 0);
}

/**
 * The whole program: run a function that returns an exit code, and turn what it
 * throws into one message on the error stream and an exit code: 2 for a
 * UserError, 3 for a RunFailure, 4 for anything else. If all ranks throw, they
 * return alike; a rank that throws alone prints and ends the others too,
 * without waiting for them.
 */
int run_guarded(const std::function<int()> &function, const MPI_Comm comm);
} // namespace coracle::mpi
