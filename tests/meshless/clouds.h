// SPDX-License-Identifier: GPL-3.0-or-later
// Point clouds for the tests of the meshless room.
#pragma once

#include <coracle/base/mpi.h>
#include <coracle/meshless/tessellation.h>

#include "../tests.h"
#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace clouds
{
using namespace coracle::meshless;

template <int dim>
void
add(PointCloud<dim>          &cloud,
    const dealii::Point<dim> &position,
    const double              spacing,
    const PointKind           kind = PointKind::fluid)
{
  cloud.id.push_back(cloud.size());
  cloud.position.push_back(position);
  cloud.spacing.push_back(spacing);
  cloud.kind.push_back(kind);
  ++cloud.n_own;
}

/// n^dim points in rows with distance `spacing`.
template <int dim>
PointCloud<dim>
grid(const unsigned int n, const double spacing)
{
  PointCloud<dim>    cloud;
  const unsigned int n_points = dim == 2 ? n * n : n * n * n;
  for (unsigned int i = 0; i < n_points; ++i)
    {
      dealii::Point<dim> p;
      for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
        p[d] = rest % n * spacing;
      add(cloud, p, spacing);
    }
  return cloud;
}

/// The corners of the unit cube and n random points inside.
template <int dim>
PointCloud<dim>
random(const unsigned int n, const unsigned int seed)
{
  PointCloud<dim> cloud = grid<dim>(2, 1.);
  std::mt19937_64 engine(seed);
  for (unsigned int i = 0; i < n; ++i)
    {
      dealii::Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = std::uniform_real_distribution<>(0., 1.)(engine);
      add(cloud, p, 1.);
    }
  std::fill(cloud.spacing.begin(), cloud.spacing.end(), std::pow(n, -1. / dim));
  return cloud;
}

template <int dim>
void
perturb(PointCloud<dim> &cloud, const double by, const unsigned int seed)
{
  std::mt19937_64 engine(seed);
  for (auto &p : cloud.position)
    for (unsigned int d = 0; d < dim; ++d)
      p[d] += std::uniform_real_distribution<>(-by, by)(engine);
}

/// Points in another order, with the ids they had.
template <int dim>
PointCloud<dim>
shuffled(const PointCloud<dim> &cloud, const unsigned int seed)
{
  std::vector<unsigned int> order(cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(seed));
  PointCloud<dim> result;
  for (const unsigned int i : order)
    {
      add(result, cloud.position[i], cloud.spacing[i], cloud.kind[i]);
      result.id.back() = cloud.id[i];
    }
  return result;
}

/// An element by the ids of its nodes, and what else it must have whoever computes it.
struct Element
{
  std::vector<std::uint64_t> nodes, simplices, facets;
  double                     volume;

  bool operator<(const Element &other) const { return nodes < other.nodes; }
  bool operator==(const Element &other) const
  {
    return nodes == other.nodes && simplices == other.simplices && facets == other.facets &&
           volume == other.volume;
  }
};

template <int dim>
std::vector<Element>
elements(const PointCloud<dim> &cloud, const Tessellation<dim> &t)
{
  std::vector<Element> result(t.n_elements());
  for (unsigned int e = 0; e < t.n_elements(); ++e)
    {
      for (unsigned int k = t.first_node[e]; k < t.first_node[e + 1]; ++k)
        result[e].nodes.push_back(cloud.id[t.node[k]]);
      for (unsigned int k = t.first_simplex[e]; k < t.first_simplex[e + 1]; ++k)
        for (const unsigned int node : t.simplex[k])
          result[e].simplices.push_back(cloud.id[node]);
      for (unsigned int k = t.first_facet[e]; k < t.first_facet[e + 1]; ++k)
        for (const unsigned int node : t.facet[k])
          result[e].facets.push_back(cloud.id[node]);
      result[e].volume = t.volume[e];
    }
  return result;
}

/// Volume inside oriented facets, by the divergence theorem.
inline double
enclosed(const PointCloud<2> &cloud, const std::vector<std::array<unsigned int, 2>> &facets)
{
  double twice = 0.;
  for (const auto &f : facets)
    {
      const auto &a = cloud.position[f[0]], &b = cloud.position[f[1]];
      twice += a[0] * b[1] - a[1] * b[0];
    }
  return twice / 2.;
}

inline double
enclosed(const PointCloud<3> &cloud, const std::vector<std::array<unsigned int, 3>> &facets)
{
  double six = 0.;
  for (const auto &f : facets)
    {
      const dealii::Tensor<1, 3> a = cloud.position[f[0]], b = cloud.position[f[1]],
                                 c = cloud.position[f[2]];
      six += a * dealii::cross_product_3d(b, c);
    }
  return six / 6.;
}
} // namespace clouds
