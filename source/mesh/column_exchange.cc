// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/mesh/column_exchange.h>

#include <algorithm>
#include <utility>

namespace coracle
{
namespace
{
using Targets = std::vector<std::pair<unsigned int, unsigned int>>;

/// Send to and receive from the ranks of two lists, `n` doubles for each node.
void
exchange(double            *sent,
         const Targets     &to,
         double            *received,
         const Targets     &from,
         const unsigned int n,
         const MPI_Comm     comm)
{
  constexpr int            tag = 4801; // no other exchange may probe for it
  std::vector<MPI_Request> requests;
  requests.reserve(to.size() + from.size());
  for (const auto &[rank, n_nodes] : from)
    {
      MPI_Irecv(received, n_nodes * n, MPI_DOUBLE, rank, tag, comm, &requests.emplace_back());
      received += n_nodes * n;
    }
  for (const auto &[rank, n_nodes] : to)
    {
      MPI_Isend(sent, n_nodes * n, MPI_DOUBLE, rank, tag, comm, &requests.emplace_back());
      sent += n_nodes * n;
    }
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}
} // namespace

ColumnExchange::ColumnExchange(const dealii::IndexSet &owned,
                               const dealii::IndexSet &ghosts,
                               MPI_Comm                comm)
  : partitioner(std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, ghosts, comm))
  , owners(partitioner->locally_owned_size(), partitioner->this_mpi_process())
{
  for (const auto &[rank, n_nodes] : partitioner->ghost_targets())
    owners.insert(owners.end(), n_nodes, rank);
  for (const auto &[begin, end] : partitioner->import_indices())
    for (unsigned int i = begin; i < end; ++i)
      imported.push_back(i);
}

void
ColumnExchange::sum_to_owners(Columns           &columns,
                              const unsigned int first,
                              const unsigned int n) const
{
  const unsigned int n_ghosts = partitioner->n_ghost_indices();
  buffer.resize((n_ghosts + imported.size()) * n);
  double *const sent = buffer.data(), *const received = sent + n_ghosts * n;
  for (unsigned int g = 0; g < n_ghosts; ++g)
    for (unsigned int c = 0; c < n; ++c)
      sent[g * n + c] = std::exchange(columns[first + c][n_owned() + g], 0.);

  exchange(sent,
           partitioner->ghost_targets(),
           received,
           partitioner->import_targets(),
           n,
           partitioner->get_mpi_communicator());

  for (std::size_t i = 0; i < imported.size(); ++i)
    for (unsigned int c = 0; c < n; ++c)
      columns[first + c][imported[i]] += received[i * n + c];
}

void
ColumnExchange::update_ghosts(Columns           &columns,
                              const unsigned int first,
                              const unsigned int n) const
{
  const unsigned int n_ghosts = partitioner->n_ghost_indices();
  buffer.resize((n_ghosts + imported.size()) * n);
  double *const received = buffer.data(), *const sent = received + n_ghosts * n;
  for (std::size_t i = 0; i < imported.size(); ++i)
    for (unsigned int c = 0; c < n; ++c)
      sent[i * n + c] = columns[first + c][imported[i]];

  exchange(sent,
           partitioner->import_targets(),
           received,
           partitioner->ghost_targets(),
           n,
           partitioner->get_mpi_communicator());

  for (unsigned int g = 0; g < n_ghosts; ++g)
    for (unsigned int c = 0; c < n; ++c)
      columns[first + c][n_owned() + g] = received[g * n + c];
}
} // namespace coracle
