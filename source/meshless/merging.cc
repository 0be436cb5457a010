// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/merging.h>

#include <cmath>

namespace coracle::meshless
{
namespace
{
/// Sets of cells; each set is named after one of its cells.
class Sets
{
public:
  explicit Sets(const unsigned int n) : parent(n)
  {
    for (unsigned int i = 0; i < n; ++i)
      parent[i] = i;
  }

  unsigned int find(unsigned int i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  }

  void unite(const unsigned int a, const unsigned int b) { parent[find(a)] = find(b); }

private:
  std::vector<unsigned int> parent;
};

template <int dim>
class Slivers
{
public:
  Slivers(const Cells<dim>          &cells,
          const PointCloud<dim>     &points,
          const TessellationOptions &options,
          const double               largest_radius)
    : cells(cells), points(points), tolerance(options.merge_tolerance), limit(largest_radius)
  {}

  bool is_sliver(const unsigned int c) const
  {
    return cells.height[c] <= tolerance * cells.spacing[c];
  }

  /// The cell whose element a sliver joins, or none if it is an element of its own.
  unsigned int joined(const unsigned int sliver) const
  {
    // Slivers lie upon each other where more than four points are on one circle.
    constexpr unsigned int         most = 32;
    std::array<unsigned int, most> passed;
    unsigned int                   c = sliver, n = 0;
    while (c != cells.none && is_sliver(c))
      {
        if (n == most)
          return cells.none;
        passed[n++] = c;
        c           = next(c);
      }
    if (c == cells.none || !(cells.radius[c] <= limit))
      return cells.none;
    for (unsigned int i = 0; i < n; ++i)
      if (!on_sphere(passed[i], c))
        return cells.none;
    return c;
  }

private:
  /// Beyond the facet that lacks the node of lowest id; of two that would choose each other, the
  /// first goes elsewhere.
  unsigned int next(const unsigned int c) const
  {
    const unsigned int beyond = cells.neighbor[c][0];
    const bool mutual = beyond != cells.none && is_sliver(beyond) && cells.neighbor[beyond][0] == c;
    if (mutual && points.id[cells.node[c][0]] < points.id[cells.node[beyond][0]])
      return cells.neighbor[c][1];
    return beyond;
  }

  /// Are the nodes of a sliver on the sphere of a cell, with some allowance for its slope?
  bool on_sphere(const unsigned int sliver, const unsigned int c) const
  {
    for (const unsigned int node : cells.node[sliver])
      if (std::abs(points.position[node].distance(cells.center[c]) - cells.radius[c]) >
          10. * tolerance * cells.spacing[c])
        return false;
    return true;
  }

  const Cells<dim>      &cells;
  const PointCloud<dim> &points;
  const double           tolerance, limit;
};
} // namespace

template <int dim>
std::vector<unsigned int>
merge_cells(const Cells<dim>          &cells,
            const PointCloud<dim>     &points,
            const TessellationOptions &options,
            const double               largest_radius)
{
  const Slivers<dim> slivers(cells, points, options, largest_radius);
  Sets               sets(cells.size());
  const auto         has_sphere = [&](const unsigned int c) {
    return cells.radius[c] <= largest_radius && !slivers.is_sliver(c);
  };
  for (unsigned int c = 0; c < cells.size(); ++c)
    if (has_sphere(c))
      {
        for (const unsigned int beyond : cells.neighbor[c])
          if (beyond != cells.none && beyond < c && has_sphere(beyond) &&
              cells.center[c].distance(cells.center[beyond]) <=
                options.merge_tolerance * std::min(cells.spacing[c], cells.spacing[beyond]))
            sets.unite(c, beyond);
      }
    else if (slivers.is_sliver(c))
      {
        const unsigned int other = slivers.joined(c);
        if (other != cells.none)
          sets.unite(c, other);
      }

  std::vector<unsigned int> element(cells.size(), cells.none);
  for (unsigned int c = 0; c < cells.size(); ++c)
    {
      const unsigned int set = sets.find(c);
      // Slivers never give a set its name; one that joined nothing is judged by its own sphere.
      if (set != c || cells.radius[c] <= largest_radius)
        element[c] = set;
    }
  return element;
}

template std::vector<unsigned int>
merge_cells(const Cells<2> &, const PointCloud<2> &, const TessellationOptions &, const double);
template std::vector<unsigned int>
merge_cells(const Cells<3> &, const PointCloud<3> &, const TessellationOptions &, const double);
} // namespace coracle::meshless
