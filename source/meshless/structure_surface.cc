// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/contact/nearest_point.h>
#include <coracle/meshless/structure_surface.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace coracle::meshless
{
namespace
{
/// Facets whose normals differ by more than 30 degrees meet in an edge.
constexpr double least_cosine = 0.866;
/// Sine of the angle by which they may lean towards each other in a ridge.
constexpr double hollow = 0.05;

/// Unit normal, outward.
dealii::Tensor<1, 2>
normal_of(const std::array<dealii::Point<2>, 2> &x)
{
  const auto normal = dealii::cross_product_2d(x[1] - x[0]);
  return normal / std::max(normal.norm(), 1e-300);
}

dealii::Tensor<1, 3>
normal_of(const std::array<dealii::Point<3>, 3> &x)
{
  const auto normal = dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
  return normal / std::max(normal.norm(), 1e-300);
}

contact::NearestPoint<2>
nearest_of(const dealii::Point<2> &x, const std::array<dealii::Point<2>, 2> &facet)
{
  return contact::nearest_point(x, facet);
}

contact::NearestPoint<3>
nearest_of(const dealii::Point<3> &x, const std::array<dealii::Point<3>, 3> &facet)
{
  return contact::nearest_point_triangle(x, {facet[0], facet[1], facet[2], facet[2]});
}
} // namespace

template <int dim>
void
StructureSurface<dim>::update(const contact::Surface<dim> &surface,
                              const std::vector<int>      &rigid_of_node,
                              const double                 farthest,
                              const MPI_Comm               comm)
{
  reach = farthest;
  gather_nodes(surface, rigid_of_node, comm);
  gather_facets(surface, comm);
  normals.resize(facets.size());
  for (unsigned int f = 0; f < facets.size(); ++f)
    normals[f] = normal_of(vertices(facets[f]));
  find_sharp_nodes();
  sort_into_cells();
}

template <int dim>
void
StructureSurface<dim>::gather_nodes(const contact::Surface<dim> &surface,
                                    const std::vector<int>      &rigid_of_node,
                                    const MPI_Comm               comm)
{
  // Of each node place, velocity and inverse mass, and then key and rigid body.
  std::vector<std::array<double, 3 * dim>>  mine;
  std::vector<std::array<std::uint64_t, 2>> names;
  std::vector<unsigned int>                 place;
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    if (const auto &node = surface.nodes[i]; node.owner == static_cast<int>(mpi::rank(comm)))
      {
        mine.emplace_back();
        for (unsigned int d = 0; d < dim; ++d)
          {
            mine.back()[d]           = node.position[d];
            mine.back()[dim + d]     = node.velocity[d];
            mine.back()[2 * dim + d] = node.inverse_mass[d];
          }
        names.push_back({node.key, static_cast<std::uint64_t>(rigid_of_node[i] + 1)});
        place.push_back(i);
      }
  nodes.clear();
  number.assign(surface.nodes.size(), -1);
  const auto all       = dealii::Utilities::MPI::all_gather(comm, mine);
  const auto all_names = dealii::Utilities::MPI::all_gather(comm, names);
  for (unsigned int rank = 0; rank < all.size(); ++rank)
    {
      if (rank == mpi::rank(comm))
        for (unsigned int i = 0; i < place.size(); ++i)
          number[place[i]] = nodes.size() + i;
      for (unsigned int i = 0; i < all[rank].size(); ++i)
        {
          Node node{{}, {}, {}, all_names[rank][i][0], int(all_names[rank][i][1]) - 1, true};
          for (unsigned int d = 0; d < dim; ++d)
            {
              node.position[d]     = all[rank][i][d];
              node.velocity[d]     = all[rank][i][dim + d];
              node.inverse_mass[d] = all[rank][i][2 * dim + d];
            }
          nodes.push_back(node);
        }
    }
}

// Ranks may know the same facets: each counts once.
template <int dim>
void
StructureSurface<dim>::gather_facets(const contact::Surface<dim> &surface, const MPI_Comm comm)
{
  constexpr unsigned int                           n = contact::vertices_per_facet<dim>;
  std::vector<std::array<std::uint64_t, 1 + n>>    mine;
  std::map<std::uint64_t, unsigned int>            number_of_key;
  std::map<std::uint64_t, std::array<unsigned, n>> by_key;
  for (const auto &facet : surface.facets)
    if (surface.bodies[facet.body].kind == contact::SurfaceKind::closed)
      {
        std::array<std::uint64_t, 1 + n> record{facet.key};
        for (unsigned int v = 0; v < n; ++v)
          record[1 + v] = surface.nodes[facet.nodes[v]].key;
        mine.push_back(record);
      }
  for (unsigned int i = 0; i < nodes.size(); ++i)
    number_of_key[nodes[i].key] = i;
  for (const auto &some : dealii::Utilities::MPI::all_gather(comm, mine))
    for (const auto &record : some)
      for (unsigned int v = 0; v < n; ++v)
        by_key[record[0]][v] = number_of_key.at(record[1 + v]);
  facets.clear();
  for (const auto &[key, v] : by_key)
    if constexpr (dim == 2)
      facets.push_back(v);
    else
      {
        facets.push_back({v[0], v[1], v[2]});
        if (v[3] != v[2])
          facets.push_back({v[0], v[2], v[3]});
      }
}

template <int dim>
void
StructureSurface<dim>::find_sharp_nodes()
{
  std::vector<std::vector<unsigned int>> around(nodes.size());
  for (unsigned int f = 0; f < facets.size(); ++f)
    for (const unsigned int node : facets[f])
      around[node].push_back(f);
  ridges.clear();
  for (unsigned int i = 0; i < nodes.size(); ++i)
    {
      nodes[i].is_sharp = around[i].empty();
      for (const unsigned int f : around[i])
        for (const unsigned int g : around[i])
          nodes[i].is_sharp |= normals[f] * normals[g] < least_cosine;
      if (nodes[i].is_sharp)
        find_ridges(i, around[i]);
    }
}

template <int dim>
void
StructureSurface<dim>::find_ridges(const unsigned int node, const std::vector<unsigned int> &around)
{
  for (const unsigned int f : around)
    for (const unsigned int g : around)
      if (is_hollow(node, f, g))
        return;
  for (const unsigned int f : around)
    for (const unsigned int g : around)
      {
        if (f >= g || normals[f] * normals[g] >= least_cosine)
          continue;
        if constexpr (dim == 2)
          ridges.push_back({node, Vector(), {f, g}});
        else
          for (const unsigned int end : facets[f])
            if (end != node && std::count(facets[g].begin(), facets[g].end(), end) > 0)
              {
                const Vector way = nodes[end].position - nodes[node].position;
                ridges.push_back({node, way / way.norm(), {f, g}});
              }
      }
}

/// Does facet g, seen from their common node, rise above facet f?
template <int dim>
bool
StructureSurface<dim>::is_hollow(const unsigned int node,
                                 const unsigned int f,
                                 const unsigned int g) const
{
  Vector way;
  for (const auto &x : vertices(facets[g]))
    way += x - nodes[node].position;
  return normals[f] * way > hollow * way.norm();
}

template <int dim>
typename StructureSurface<dim>::Cell
StructureSurface<dim>::cell_of(const dealii::Point<dim> &x) const
{
  Cell cell;
  for (unsigned int d = 0; d < dim; ++d)
    cell[d] = static_cast<int>(std::floor(x[d] / (2 * reach)));
  return cell;
}

template <int dim>
void
StructureSurface<dim>::sort_into_cells()
{
  in_cell.clear();
  for (unsigned int f = 0; f < facets.size(); ++f)
    {
      const auto         x   = vertices(facets[f]);
      dealii::Point<dim> low = x[0], high = x[0];
      for (unsigned int d = 0; d < dim; ++d)
        {
          for (const auto &vertex : x)
            {
              low[d]  = std::min(low[d], vertex[d]);
              high[d] = std::max(high[d], vertex[d]);
            }
          low[d] -= reach;
          high[d] += reach;
        }
      const Cell first = cell_of(low), last = cell_of(high);
      for (Cell cell = first; cell[dim - 1] <= last[dim - 1];)
        {
          in_cell.emplace_back(cell, f);
          unsigned int d = 0;
          for (++cell[0]; d + 1 < dim && cell[d] > last[d]; ++cell[d])
            {
              cell[d] = first[d];
              ++d;
            }
        }
    }
  std::sort(in_cell.begin(), in_cell.end());
}

template <int dim>
bool
StructureSurface<dim>::find_nearest(const dealii::Point<dim> &x, Place &place) const
{
  const Cell cell = cell_of(x);
  const auto begin =
    std::lower_bound(in_cell.begin(), in_cell.end(), std::pair<Cell, unsigned int>(cell, 0));
  double best = reach * reach;
  for (auto candidate = begin; candidate != in_cell.end() && candidate->first == cell; ++candidate)
    {
      const unsigned int f       = candidate->second;
      const auto         nearest = nearest_of(x, vertices(facets[f]));
      if (nearest.distance_square >= best)
        continue;
      best           = nearest.distance_square;
      place.nodes    = facets[f];
      place.position = nearest.place;
      std::copy_n(nearest.weights.begin(), dim, place.weights.begin());
    }
  if (best == reach * reach)
    return false;
  // Where facets meet, the side is that of all of them; the one most across the way tells it best.
  const double tolerance = 1e-6 * reach;
  place.normal           = Vector();
  place.height           = 0;
  for (auto candidate = begin; candidate != in_cell.end() && candidate->first == cell; ++candidate)
    {
      const unsigned int f       = candidate->second;
      const auto         nearest = nearest_of(x, vertices(facets[f]));
      if (nearest.place.distance(place.position) > tolerance)
        continue;
      place.normal += normals[f];
      const double height = normals[f] * (x - nearest.place);
      if (std::fabs(height) > std::fabs(place.height))
        place.height = height;
    }
  place.normal /= std::max(place.normal.norm(), 1e-300);
  place.height = std::copysign(std::sqrt(best), place.height);
  return true;
}

template <int dim>
typename StructureSurface<dim>::Vector
StructureSurface<dim>::velocity(const Place &place) const
{
  Vector result;
  for (unsigned int v = 0; v < dim; ++v)
    result += place.weights[v] * nodes[place.nodes[v]].velocity;
  return result;
}

template <int dim>
std::array<dealii::Point<dim>, dim>
StructureSurface<dim>::vertices(const Simplex &simplex) const
{
  std::array<dealii::Point<dim>, dim> x;
  for (unsigned int v = 0; v < dim; ++v)
    x[v] = nodes[simplex[v]].position;
  return x;
}

template class StructureSurface<2>;
template class StructureSurface<3>;
} // namespace coracle::meshless
