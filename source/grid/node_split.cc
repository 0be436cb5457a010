// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/grid/node_split.h>

namespace coracle
{
namespace
{
constexpr int tag_split = 7321;

// Keys of extra records start where no node's number can be.
constexpr std::uint64_t first_key  = std::uint64_t(1) << 47;
constexpr unsigned int  rank_shift = 32;

struct Wanted
{
  std::uint64_t node, sheets;
};
} // namespace

template <int dim>
void
NodeSplit<dim>::reinit()
{
  first.clear();
  extras.clear();
  owners.clear();
  users.clear();
}

template <int dim>
void
NodeSplit<dim>::clear()
{
  for (const Extra &extra : extras)
    first[extra.node] = -1;
  extras.clear();
  owners.clear();
  users.clear();
}

template <int dim>
unsigned int
NodeSplit<dim>::record(const unsigned int node, const std::uint64_t sheets)
{
  Assert(octree.hanging_index(node) < 0, dealii::ExcInternalError());
  if (sheets == 0)
    return node;
  if (first.empty())
    first.assign(octree.n_nodes(), -1);
  for (int i = first[node]; i >= 0; i = extras[i].next)
    if (extras[i].sheets == sheets)
      return octree.n_nodes() + i;
  extras.push_back({node, sheets, 0, first[node]});
  first[node] = extras.size() - 1;
  return octree.n_nodes() + extras.size() - 1;
}

template <int dim>
void
NodeSplit<dim>::share()
{
  const MPI_Comm comm = octree.exchange.indices().get_mpi_communicator();
  if (mpi::n_ranks(comm) > 1)
    {
      std::map<unsigned int, std::vector<Wanted>>       wanted;
      std::map<unsigned int, std::vector<unsigned int>> records;
      for (unsigned int i = 0; i < extras.size(); ++i)
        if (const unsigned int node = extras[i].node; node >= octree.n_owned_nodes())
          {
            wanted[octree.node_owner(node)].push_back({octree.global_node(node), extras[i].sheets});
            records[octree.node_owner(node)].push_back(octree.n_nodes() + i);
          }
      for (const auto &[rank, list] : records)
        owners.push_back({static_cast<int>(rank), list, NodeRecords(list.size())});
      for (const auto &[rank, list] : mpi::exchange_values(wanted, comm))
        {
          Partner user{static_cast<int>(rank), {}, NodeRecords(list.size())};
          for (const auto &[node, sheets] : list)
            user.records.push_back(record(octree.exchange.indices().global_to_local(node), sheets));
          users.push_back(std::move(user));
        }
    }
  make_keys();
}

// An owner numbers its extra records and tells those who use them.
template <int dim>
void
NodeSplit<dim>::make_keys()
{
  const std::uint64_t mine =
    first_key +
    (std::uint64_t(mpi::rank(octree.exchange.indices().get_mpi_communicator())) << rank_shift);
  const unsigned int n_nodes = octree.n_nodes();
  for (unsigned int i = 0; i < extras.size(); ++i)
    extras[i].key = mine + i;
  for (const Partner &user : users)
    for (unsigned int k = 0; k < user.records.size(); ++k)
      std::memcpy(&user.buffer[k], &extras[user.records[k] - n_nodes].key, sizeof(std::uint64_t));
  swap(users, owners);
  for (const Partner &owner : owners)
    for (unsigned int k = 0; k < owner.records.size(); ++k)
      std::memcpy(&extras[owner.records[k] - n_nodes].key, &owner.buffer[k], sizeof(std::uint64_t));
}

template <int dim>
void
NodeSplit<dim>::swap(const std::vector<Partner> &from, const std::vector<Partner> &to) const
{
  const MPI_Comm           comm = octree.exchange.indices().get_mpi_communicator();
  std::vector<MPI_Request> requests(from.size() + to.size());
  std::size_t              r = 0;
  for (const Partner &partner : to)
    MPI_Irecv(partner.buffer.data(),
              8 * partner.buffer.size(),
              MPI_DOUBLE,
              partner.rank,
              tag_split,
              comm,
              &requests[r++]);
  for (const Partner &partner : from)
    MPI_Isend(partner.buffer.data(),
              8 * partner.buffer.size(),
              MPI_DOUBLE,
              partner.rank,
              tag_split,
              comm,
              &requests[r++]);
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}

template <int dim>
void
NodeSplit<dim>::sum_to_owners(NodeRecords &records) const
{
  for (const Partner &owner : owners)
    for (unsigned int k = 0; k < owner.records.size(); ++k)
      {
        owner.buffer[k]           = records[owner.records[k]];
        records[owner.records[k]] = NodeRecord();
      }
  swap(owners, users);
  for (const Partner &user : users)
    for (unsigned int k = 0; k < user.records.size(); ++k)
      for (unsigned int i = 0; i < 8; ++i)
        records[user.records[k]][i] += user.buffer[k][i];
}

template <int dim>
void
NodeSplit<dim>::update_ghosts(NodeRecords &records) const
{
  for (const Partner &user : users)
    for (unsigned int k = 0; k < user.records.size(); ++k)
      user.buffer[k] = records[user.records[k]];
  swap(users, owners);
  for (const Partner &owner : owners)
    for (unsigned int k = 0; k < owner.records.size(); ++k)
      records[owner.records[k]] = owner.buffer[k];
}

template <int dim>
std::size_t
NodeSplit<dim>::memory_consumption() const
{
  return extras.capacity() * sizeof(Extra) + first.capacity() * sizeof(int);
}

template class NodeSplit<2>;
template class NodeSplit<3>;
} // namespace coracle
