// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/node_exchange.h>

namespace coracle
{
namespace
{
constexpr int tag_sum = 7301, tag_update = 7302;

// One message per neighbour: blocks of `records` are sent, blocks of the other are received.
template <typename Targets>
void
swap_blocks(const NodeRecord *const send_from,
            const Targets          &send_targets,
            NodeRecord *const       receive_to,
            const Targets          &receive_targets,
            const int               tag,
            MPI_Comm                comm)
{
  std::vector<MPI_Request> requests(send_targets.size() + receive_targets.size());
  std::size_t              offset = 0, r = 0;
  for (const auto &[rank, count] : receive_targets)
    {
      MPI_Irecv(receive_to + offset, 8 * count, MPI_DOUBLE, rank, tag, comm, &requests[r++]);
      offset += count;
    }
  offset = 0;
  for (const auto &[rank, count] : send_targets)
    {
      MPI_Isend(send_from + offset, 8 * count, MPI_DOUBLE, rank, tag, comm, &requests[r++]);
      offset += count;
    }
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}
} // namespace

void
NodeExchange::reinit(const dealii::IndexSet &owned, const dealii::IndexSet &relevant, MPI_Comm comm)
{
  partitioner  = std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, relevant, comm);
  const int me = dealii::Utilities::MPI::this_mpi_process(comm);
  owners.assign(n_owned(), me);
  for (const auto &[rank, count] : partitioner->ghost_targets())
    owners.insert(owners.end(), count, rank);
  imported.clear();
  for (const auto &[first, last] : partitioner->import_indices())
    for (unsigned int i = first; i < last; ++i)
      imported.push_back(i);
  buffer.resize(imported.size());
}

void
NodeExchange::sum_to_owners(NodeRecords &records) const
{
  if (n_ghosts() == 0 && imported.empty())
    return;
  swap_blocks(records.data() + n_owned(),
              partitioner->ghost_targets(),
              buffer.data(),
              partitioner->import_targets(),
              tag_sum,
              partitioner->get_mpi_communicator());
  for (std::size_t i = 0; i < imported.size(); ++i)
    for (unsigned int k = 0; k < 8; ++k)
      records[imported[i]][k] += buffer[i][k];
  std::fill_n(records.begin() + n_owned(), n_ghosts(), NodeRecord());
}

void
NodeExchange::update_ghosts(NodeRecords &records) const
{
  if (n_ghosts() == 0 && imported.empty())
    return;
  for (std::size_t i = 0; i < imported.size(); ++i)
    buffer[i] = records[imported[i]];
  swap_blocks(buffer.data(),
              partitioner->import_targets(),
              records.data() + n_owned(),
              partitioner->ghost_targets(),
              tag_update,
              partitioner->get_mpi_communicator());
}

std::size_t
NodeExchange::bytes_per_exchange() const
{
  return n_ghosts() * sizeof(NodeRecord);
}
} // namespace coracle
