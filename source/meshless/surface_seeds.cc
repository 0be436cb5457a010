// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/surface_seeds.h>

#include <algorithm>
#include <cmath>

namespace coracle::meshless
{
namespace
{
/// Least distance between two, over the spacing: no pair is taken for crowded; and that of those at
/// the waterline from nodes: where water reaches over an edge by less, it is as if it did not.
constexpr double least_distance = 0.6, least_wet = 0.3;

template <int dim>
class Seeder
{
public:
  Seeder(const StructureSurface<dim>                         &surface,
         const double                                         spacing,
         const std::function<bool(const SurfaceSeed<dim> &)> &is_wet)
    : surface(surface), spacing(spacing), is_wet(is_wet)
  {}

  std::vector<SurfaceSeed<dim>> seeds()
  {
    for (unsigned int f = 0; f < surface.facets.size(); ++f)
      look_at(f);
    std::vector<dealii::Point<dim>> nodes, taken;
    for (const auto &node : surface.nodes)
      if (node.is_sharp)
        nodes.push_back(node.position);
    std::vector<SurfaceSeed<dim>> result;
    for (const auto *list : {&at_waterline, &in_facets})
      for (const auto &seed : *list)
        if (!is_near(taken, seed, least_distance) &&
            !is_near(nodes, seed, list == &at_waterline ? least_wet : least_distance))
          {
            taken.push_back(seed.position);
            result.push_back(seed);
          }
    return result;
  }

private:
  bool is_near(const std::vector<dealii::Point<dim>> &points,
               const SurfaceSeed<dim>                &seed,
               const double                           share) const
  {
    return std::any_of(points.begin(), points.end(), [&](const auto &x) {
      return x.distance_square(seed.position) < std::pow(share * spacing, 2);
    });
  }

  using Weights = std::array<double, dim>;

  SurfaceSeed<dim> place(const unsigned int f, const Weights &weights) const
  {
    SurfaceSeed<dim> result;
    for (unsigned int v = 0; v < dim; ++v)
      result.position += weights[v] * surface.nodes[surface.facets[f][v]].position;
    result.normal = surface.normals[f];
    return result;
  }

  /// On an edge between nodes that are points?
  bool is_on_edge(const unsigned int f, const Weights &weights) const
  {
    bool on_edge = dim == 3, lacks = false;
    for (unsigned int v = 0; v < dim; ++v)
      if (weights[v] < 1e-9)
        lacks = true;
      else
        on_edge = on_edge && surface.nodes[surface.facets[f][v]].is_sharp;
    return on_edge && lacks;
  }

  /// Into so many parts its edges are cut, by the second longest.
  unsigned int parts(const unsigned int f) const
  {
    const auto              x = surface.vertices(surface.facets[f]);
    std::array<double, dim> length;
    for (unsigned int v = 0; v < dim; ++v)
      length[v] = x[v].distance(x[(v + 1) % dim]);
    std::sort(length.begin(), length.end());
    return std::max(1l, std::lround(length[dim - 2] / spacing));
  }

  void look_at(const unsigned int f)
  {
    const int n = parts(f);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= (dim == 2 ? 0 : n - i); ++j)
        {
          const Weights here = weights(i, j, n);
          const auto    seed = place(f, here);
          const bool    wet  = is_wet(seed);
          if (wet && !is_on_edge(f, here))
            in_facets.push_back(seed);
          // Towards those not looked at yet.
          if (i < n && i + 1 + j <= n)
            find_waterline(f, here, wet, weights(i + 1, j, n));
          if (dim == 3 && i + j + 1 <= n)
            {
              find_waterline(f, here, wet, weights(i, j + 1, n));
              if (j > 0)
                find_waterline(f, here, wet, weights(i + 1, j - 1, n));
            }
        }
  }

  static Weights weights(const int i, const int j, const int n)
  {
    Weights result{};
    result[0] = double(n - i - j) / n;
    result[1] = double(i) / n;
    if (dim == 3)
      result[dim - 1] = double(j) / n;
    return result;
  }

  void find_waterline(const unsigned int f, const Weights &a, const bool wet, const Weights &b)
  {
    if (is_wet(place(f, b)) == wet)
      return;
    Weights       in = wet ? a : b, out = wet ? b : a;
    const Weights start = in;
    for (unsigned int i = 0; i < 40; ++i)
      {
        Weights middle;
        for (unsigned int v = 0; v < dim; ++v)
          middle[v] = 0.5 * (in[v] + out[v]);
        (is_wet(place(f, middle)) ? in : out) = middle;
      }
    const auto seed = place(f, in), first = place(f, start);
    if (!is_on_edge(f, in))
      at_waterline.push_back(seed.position.distance(first.position) < 1e-6 * spacing ? first
                                                                                     : seed);
  }

  const StructureSurface<dim>                         &surface;
  const double                                         spacing;
  const std::function<bool(const SurfaceSeed<dim> &)> &is_wet;
  std::vector<SurfaceSeed<dim>>                        at_waterline, in_facets;
};
} // namespace

template <int dim>
std::vector<SurfaceSeed<dim>>
seed(const StructureSurface<dim>                         &surface,
     const double                                         spacing,
     const std::function<bool(const SurfaceSeed<dim> &)> &is_wet)
{
  return Seeder<dim>(surface, spacing, is_wet).seeds();
}

template std::vector<SurfaceSeed<2>> seed(const StructureSurface<2> &,
                                          const double,
                                          const std::function<bool(const SurfaceSeed<2> &)> &);
template std::vector<SurfaceSeed<3>> seed(const StructureSurface<3> &,
                                          const double,
                                          const std::function<bool(const SurfaceSeed<3> &)> &);
} // namespace coracle::meshless
