// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <numeric>
#include <vector>

namespace coracle::contact
{
/**
 * Collective. Every rank sends send[r] to rank r and gets what rank r sent it.
 * T must be a plain struct. For set-up; what is repeated every iteration sends
 * to known partners only.
 */
template <typename T>
std::vector<std::vector<T>>
all_to_all(const std::vector<std::vector<T>> &send, MPI_Comm communicator)
{
  const int        n = send.size();
  std::vector<int> send_size(n), receive_size(n), send_begin(n + 1, 0), receive_begin(n + 1, 0);
  for (int r = 0; r < n; ++r)
    send_size[r] = send[r].size() * sizeof(T);
  MPI_Alltoall(send_size.data(), 1, MPI_INT, receive_size.data(), 1, MPI_INT, communicator);
  std::partial_sum(send_size.begin(), send_size.end(), send_begin.begin() + 1);
  std::partial_sum(receive_size.begin(), receive_size.end(), receive_begin.begin() + 1);

  std::vector<T> out, in(receive_begin[n] / sizeof(T));
  for (const auto &part : send)
    out.insert(out.end(), part.begin(), part.end());
  MPI_Alltoallv(out.data(),
                send_size.data(),
                send_begin.data(),
                MPI_BYTE,
                in.data(),
                receive_size.data(),
                receive_begin.data(),
                MPI_BYTE,
                communicator);

  std::vector<std::vector<T>> result(n);
  for (int r = 0; r < n; ++r)
    result[r].assign(in.begin() + receive_begin[r] / sizeof(T),
                     in.begin() + receive_begin[r + 1] / sizeof(T));
  return result;
}

inline int
my_rank(MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  return rank;
}

inline int
n_ranks(MPI_Comm communicator)
{
  int n;
  MPI_Comm_size(communicator, &n);
  return n;
}
} // namespace coracle::contact
