// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/facet_exchange.h>
#include <coracle/contact/global_search.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <unordered_map>

namespace coracle::contact
{
namespace
{
constexpr int tag_update = 4721, tag_return = 4722;

/// Boxes of all ranks, by rank.
std::vector<std::vector<Box>>
gather(const std::vector<Box> &mine, MPI_Comm communicator)
{
  return all_to_all(std::vector<std::vector<Box>>(n_ranks(communicator), mine), communicator);
}

bool
meets_any(const std::vector<Box> &boxes, const Box &box)
{
  return std::any_of(boxes.begin(), boxes.end(), [&box](const Box &b) { return overlap(b, box); });
}
} // namespace

template <int dim>
FacetExchange<dim>::FacetExchange(MPI_Comm communicator) : communicator(communicator)
{}

template <int dim>
void
FacetExchange<dim>::rebuild(const Surface<dim>               &owned,
                            const std::vector<Box>           &reach,
                            const std::vector<PointSet<dim>> &points)
{
  const auto boxes = gather(reach, communicator);
  const int  n = n_ranks(communicator), me = my_rank(communicator);
  sent.clear();
  std::vector<std::vector<SurfaceNode<dim>>> nodes(n);
  std::vector<std::vector<FacetMessage>>     facets(n);
  std::vector<unsigned int>                  place(owned.nodes.size());
  constexpr unsigned int                     none = -1;
  for (int r = 0; r < n; ++r)
    {
      Partner partner{r, {}, {}, {}};
      std::fill(place.begin(), place.end(), none);
      const auto send_one = [&](const unsigned int node) {
        if (place[node] == none)
          {
            place[node] = partner.index.size();
            partner.index.push_back(node);
            nodes[r].push_back(owned.nodes[node]);
          }
      };
      // What a hanging node hangs on goes before it, so that it can be named by its place.
      const auto send_node = [&](const unsigned int node) {
        const auto &parents = owned.nodes[node].parents;
        if (place[node] != none || !owned.nodes[node].hangs())
          return send_one(node);
        for (const int parent : parents)
          send_one(parent);
        send_one(node);
        for (unsigned int i = 0; i < parents.size(); ++i)
          nodes[r].back().parents[i] = place[parents[i]];
      };
      for (const auto &facet : owned.facets)
        {
          if (!meets_any(boxes[r],
                         facet_box(owned, facet, 0.5 * owned.bodies[facet.body].thickness)))
            continue;
          FacetMessage message{{}, facet.body, facet.key};
          for (unsigned int k = 0; k < facet.nodes.size(); ++k)
            {
              send_node(facet.nodes[k]);
              message.nodes[k] = place[facet.nodes[k]];
            }
          facets[r].push_back(message);
        }
      if (r == me)
        {
          for (const auto &set : points)
            if (set.body >= 0)
              std::for_each(set.surface_node, set.surface_node + set.n_points, send_node);
          local_nodes = place;
        }
      if (!partner.index.empty())
        sent.push_back(std::move(partner));
    }
  local.bodies = owned.bodies;
  merge(all_to_all(nodes, communicator), all_to_all(facets, communicator));
  // From places in the message to oneself.
  for (const auto &partner : received)
    if (partner.rank == me)
      for (unsigned int &node : local_nodes)
        node = (node == none ? none : partner.index[node]);
}

template <int dim>
void
FacetExchange<dim>::merge(const std::vector<std::vector<SurfaceNode<dim>>> &nodes,
                          const std::vector<std::vector<FacetMessage>>     &facets)
{
  local.nodes.clear();
  local.facets.clear();
  received.clear();
  std::unordered_map<std::uint64_t, unsigned int> known;
  // Rank that each node's impulses return to.
  std::vector<int> home;
  for (unsigned int r = 0; r < nodes.size(); ++r)
    if (!nodes[r].empty())
      {
        Partner partner{static_cast<int>(r), {}, {}, {}};
        for (const auto &node : nodes[r])
          {
            const auto entry = known.emplace(node.key, local.nodes.size());
            if (entry.second)
              {
                local.nodes.push_back(node);
                for (int &parent : local.nodes.back().parents)
                  parent = (parent < 0 ? -1 : static_cast<int>(partner.index[parent]));
                home.push_back(r);
              }
            else if (node.owner == static_cast<int>(r))
              home[entry.first->second] = r;
            partner.index.push_back(entry.first->second);
          }
        for (const auto &message : facets[r])
          {
            Facet<dim> facet;
            for (unsigned int k = 0; k < facet.nodes.size(); ++k)
              facet.nodes[k] = partner.index[message.nodes[k]];
            facet.body = message.body;
            facet.key  = message.key;
            local.facets.push_back(facet);
          }
        received.push_back(std::move(partner));
      }
  // What is found must not depend on how facets come together.
  std::sort(local.facets.begin(), local.facets.end(), [](const Facet<dim> &a, const Facet<dim> &b) {
    return a.key < b.key;
  });
  for (auto &partner : received)
    for (const unsigned int i : partner.index)
      partner.returns.push_back(home[i] == partner.rank);
}

template <int dim>
void
FacetExchange<dim>::exchange(std::vector<Partner> &from,
                             std::vector<Partner> &to,
                             const int             tag) const
{
  std::vector<MPI_Request> requests;
  const int                me = my_rank(communicator);
  for (auto &in : to)
    if (in.rank != me)
      {
        requests.emplace_back();
        MPI_Irecv(in.buffer.data(),
                  in.buffer.size(),
                  MPI_DOUBLE,
                  in.rank,
                  tag,
                  communicator,
                  &requests.back());
      }
  for (auto &out : from)
    if (out.rank != me)
      {
        requests.emplace_back();
        MPI_Isend(out.buffer.data(),
                  out.buffer.size(),
                  MPI_DOUBLE,
                  out.rank,
                  tag,
                  communicator,
                  &requests.back());
      }
    else
      for (auto &in : to)
        if (in.rank == me)
          in.buffer = out.buffer;
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}

template <int dim>
void
FacetExchange<dim>::update(const Surface<dim> &owned)
{
  constexpr unsigned int n_values = 3 * dim;
  local.bodies                    = owned.bodies;
  for (auto &out : sent)
    {
      out.buffer.resize(n_values * out.index.size());
      double *value = out.buffer.data();
      for (const unsigned int i : out.index)
        for (int d = 0; d < dim; ++d)
          {
            *value++ = owned.nodes[i].position[d];
            *value++ = owned.nodes[i].velocity[d];
            *value++ = owned.nodes[i].inverse_mass[d];
          }
    }
  for (auto &in : received)
    in.buffer.resize(n_values * in.index.size());
  exchange(sent, received, tag_update);
  for (const auto &in : received)
    {
      const double *value = in.buffer.data();
      for (const unsigned int i : in.index)
        for (int d = 0; d < dim; ++d)
          {
            local.nodes[i].position[d]     = *value++;
            local.nodes[i].velocity[d]     = *value++;
            local.nodes[i].inverse_mass[d] = *value++;
          }
    }
}

template <int dim>
void
FacetExchange<dim>::add_to_owners(const std::vector<dealii::Tensor<1, dim>> &values,
                                  std::vector<dealii::Tensor<1, dim>>       &owned) const
{
  for (auto &out : received)
    {
      out.buffer.resize(dim * out.index.size());
      for (unsigned int i = 0; i < out.index.size(); ++i)
        for (int d = 0; d < dim; ++d)
          out.buffer[dim * i + d] = (out.returns[i] ? values[out.index[i]][d] : 0.);
    }
  for (auto &in : sent)
    in.buffer.resize(dim * in.index.size());
  exchange(received, sent, tag_return);
  for (const auto &in : sent)
    for (unsigned int i = 0; i < in.index.size(); ++i)
      for (int d = 0; d < dim; ++d)
        owned[in.index[i]][d] += in.buffer[dim * i + d];
}

template <int dim>
void
FacetExchange<dim>::serialize(Archive &archive, std::vector<Partner> &partners)
{
  std::vector<int>                       ranks;
  std::vector<std::vector<unsigned int>> index;
  std::vector<std::vector<char>>         returns;
  for (const auto &partner : partners)
    {
      ranks.push_back(partner.rank);
      index.push_back(partner.index);
      returns.push_back(partner.returns);
    }
  archive.own("rank", ranks);
  archive.own("index", index);
  archive.own("returns", returns);
  partners.clear();
  for (unsigned int i = 0; i < ranks.size(); ++i)
    partners.push_back({ranks[i], index[i], {}, returns[i]});
}

template <int dim>
void
FacetExchange<dim>::serialize(Archive &archive)
{
  // Bodies, and where nodes are, come with the next update().
  std::vector<std::uint64_t> keys, facets;
  std::vector<int>           owners, parents;
  for (const auto &node : local.nodes)
    {
      keys.push_back(node.key);
      owners.push_back(node.owner);
      parents.insert(parents.end(), node.parents.begin(), node.parents.end());
    }
  for (const auto &facet : local.facets)
    {
      facets.insert(facets.end(), facet.nodes.begin(), facet.nodes.end());
      facets.push_back(facet.body);
      facets.push_back(facet.key);
    }
  archive.own("node_keys", keys);
  archive.own("node_owners", owners);
  archive.own("node_parents", parents);
  archive.own("facets", facets);
  archive.own("local_nodes", local_nodes);
  local.nodes.resize(keys.size());
  for (unsigned int i = 0; i < keys.size(); ++i)
    {
      local.nodes[i].key   = keys[i];
      local.nodes[i].owner = owners[i];
      std::copy_n(&parents[2 * i], 2, local.nodes[i].parents.begin());
    }
  constexpr unsigned int n_vertices = vertices_per_facet<dim>;
  local.facets.resize(facets.size() / (n_vertices + 2));
  auto value = facets.begin();
  for (auto &facet : local.facets)
    {
      std::copy_n(value, n_vertices, facet.nodes.begin());
      facet.body = value[n_vertices];
      facet.key  = value[n_vertices + 1];
      value += n_vertices + 2;
    }
  {
    const Archive::Section section(archive, "sent");
    serialize(archive, sent);
  }
  const Archive::Section section(archive, "received");
  serialize(archive, received);
}

template class FacetExchange<2>;
template class FacetExchange<3>;
} // namespace coracle::contact
