// SPDX-License-Identifier: GPL-3.0-or-later
// Counts what a program sends through MPI, ours and what deal.II and p4est send: a library for
// LD_PRELOAD that uses MPI's profiling interface. At the end rank 0 prints, for each kind of call,
// the number of calls and bytes summed over the ranks, and the largest of any rank. Bytes are those
// that a rank hands over: of a message once, of a reduction its contribution, of an all-to-all what
// goes to other ranks.
#include <mpi.h>

#include <array>
#include <cstdio>

namespace
{
enum Kind
{
  message,
  reduction,
  all_to_all,
  other_collective,
  n_kinds
};
constexpr const char *names[n_kinds] = {"message", "reduction", "all to all", "other collective"};

struct Count
{
  double calls = 0, bytes = 0;
};
std::array<Count, n_kinds> counts;

void
add(const Kind kind, const double n, MPI_Datatype type)
{
  int size = 0;
  PMPI_Type_size(type, &size);
  ++counts[kind].calls;
  counts[kind].bytes += n * size;
}
} // namespace

extern "C" {
int
MPI_Send(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c)
{
  add(message, n, t);
  return PMPI_Send(b, n, t, to, tag, c);
}

int
MPI_Isend(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r)
{
  add(message, n, t);
  return PMPI_Isend(b, n, t, to, tag, c, r);
}

int
MPI_Issend(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r)
{
  add(message, n, t);
  return PMPI_Issend(b, n, t, to, tag, c, r);
}

int
MPI_Allreduce(const void *in, void *out, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
{
  add(reduction, n, t);
  return PMPI_Allreduce(in, out, n, t, op, c);
}

int
MPI_Reduce(const void *in, void *out, int n, MPI_Datatype t, MPI_Op op, int root, MPI_Comm c)
{
  add(reduction, n, t);
  return PMPI_Reduce(in, out, n, t, op, root, c);
}

int
MPI_Exscan(const void *in, void *out, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
{
  add(reduction, n, t);
  return PMPI_Exscan(in, out, n, t, op, c);
}

int
MPI_Alltoall(const void *in, int n, MPI_Datatype t, void *out, int m, MPI_Datatype u, MPI_Comm c)
{
  int size = 0;
  PMPI_Comm_size(c, &size);
  add(all_to_all, double(n) * (size - 1), t);
  return PMPI_Alltoall(in, n, t, out, m, u, c);
}

int
MPI_Alltoallv(const void  *in,
              const int   *n,
              const int   *begin,
              MPI_Datatype t,
              void        *out,
              const int   *m,
              const int   *begin_out,
              MPI_Datatype u,
              MPI_Comm     c)
{
  int size = 0, rank = 0;
  PMPI_Comm_size(c, &size);
  PMPI_Comm_rank(c, &rank);
  double sum = 0;
  for (int r = 0; r < size; ++r)
    sum += r == rank ? 0 : n[r];
  add(all_to_all, sum, t);
  return PMPI_Alltoallv(in, n, begin, t, out, m, begin_out, u, c);
}

int
MPI_Bcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm c)
{
  int rank = 0;
  PMPI_Comm_rank(c, &rank);
  add(other_collective, rank == root ? n : 0, t);
  return PMPI_Bcast(b, n, t, root, c);
}

int
MPI_Allgather(const void *in, int n, MPI_Datatype t, void *out, int m, MPI_Datatype u, MPI_Comm c)
{
  add(other_collective, n, t);
  return PMPI_Allgather(in, n, t, out, m, u, c);
}

int
MPI_Ibarrier(MPI_Comm c, MPI_Request *r)
{
  add(other_collective, 0, MPI_BYTE);
  return PMPI_Ibarrier(c, r);
}

int
MPI_Finalize()
{
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int kind = 0; kind < n_kinds; ++kind)
    {
      const double mine[2] = {counts[kind].calls, counts[kind].bytes};
      double       sum[2], most[2];
      PMPI_Reduce(mine, sum, 2, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
      PMPI_Reduce(mine, most, 2, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
      if (rank == 0)
        std::printf(
          "MPI, %s: %.0f %.0f %.0f %.0f\n", names[kind], sum[0], sum[1], most[0], most[1]);
    }
  return PMPI_Finalize();
}
}
