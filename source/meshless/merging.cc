// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/merging.h>

#include <algorithm>
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

/// Finds the cells with a sphere that slivers join.
template <int dim>
class Slivers
{
public:
  Slivers(const Cells<dim>          &cells,
          const PointCloud<dim>     &points,
          const TessellationOptions &options,
          const double               largest_radius)
    : cells(cells), points(points), options(options), limit(largest_radius)
  {}

  bool has_sphere(const unsigned int c) const
  {
    return cells.radius[c] <= limit && !cells.is_sliver[c];
  }

  /// Have two cells one sphere?
  bool are_one(const unsigned int a, const unsigned int b) const
  {
    return cells.center[a].distance(cells.center[b]) <=
           options.merge_tolerance * std::min(cells.spacing[a], cells.spacing[b]);
  }

  /// Cells of one sphere that only slivers are between: the two prisms of a cube, say, and a flat
  /// cell in the plane where they meet.
  void unite_across(Sets &sets) const
  {
    std::vector<bool>         seen(cells.size(), false);
    std::vector<unsigned int> open, beside;
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        if (seen[c] || !is_between(c))
          continue;
        beside.clear();
        open.assign(1, c);
        seen[c] = true;
        while (!open.empty())
          {
            const unsigned int sliver = open.back();
            open.pop_back();
            for (const unsigned int other : cells.neighbor[sliver])
              if (other != cells.none && has_sphere(other))
                beside.push_back(other);
              else if (other != cells.none && !seen[other] && is_between(other))
                {
                  seen[other] = true;
                  open.push_back(other);
                }
          }
        for (std::size_t i = 0; i < beside.size(); ++i)
          for (std::size_t k = 0; k < i; ++k)
            if (are_one(beside[i], beside[k]))
              sets.unite(beside[i], beside[k]);
      }
  }

  /// Given the elements of cells with a sphere, those of slivers.
  void join(std::vector<unsigned int> &element) const
  {
    // Of slivers, the cell whose sphere they are on.
    std::vector<unsigned int> found(cells.size(), cells.none), open;
    for (unsigned int c = 0; c < cells.size(); ++c)
      if (is_between(c))
        open.push_back(c);
    // Slivers lie upon each other where more than four points are on a circle. In each round look
    // at what earlier rounds have found, so that the order of cells does not matter.
    for (bool changed = true; changed;)
      {
        std::vector<std::pair<unsigned int, unsigned int>> round;
        for (const unsigned int c : open)
          {
            const unsigned int sphere = beside(c, found, element);
            if (sphere != cells.none)
              round.emplace_back(c, sphere);
          }
        changed = !round.empty();
        for (const auto &[sliver, sphere] : round)
          {
            found[sliver]   = sphere;
            element[sliver] = element[sphere];
          }
        open.erase(std::remove_if(open.begin(),
                                  open.end(),
                                  [&](const auto c) { return found[c] != cells.none; }),
                   open.end());
      }
    for (const unsigned int c : open)
      if (radius_is_within(corners(c), options.alpha * cells.spacing[c]))
        element[c] = c;
  }

private:
  /// A sliver that may be part of an element.
  bool is_between(const unsigned int c) const
  {
    return cells.is_sliver[c] && radius_is_within(corners(c), limit);
  }

  std::array<dealii::Point<dim>, dim + 1> corners(const unsigned int c) const
  {
    std::array<dealii::Point<dim>, dim + 1> result;
    for (unsigned int i = 0; i <= dim; ++i)
      result[i] = points.position[cells.node[c][i]];
    return result;
  }

  /// A cell with a sphere that a sliver fits, next to it or to slivers already found. In space its
  /// element must have two facets of the sliver, as it has if it is all that lies on one side;
  /// otherwise the sliver would stick out of it.
  unsigned int beside(const unsigned int               sliver,
                      const std::vector<unsigned int> &found,
                      const std::vector<unsigned int> &element) const
  {
    const auto &neighbors = cells.neighbor[sliver];
    for (const unsigned int beyond : neighbors)
      {
        if (beyond == cells.none || element[beyond] == cells.none)
          continue;
        const unsigned int sphere = has_sphere(beyond) ? beyond : found[beyond];
        const auto         shared =
          std::count_if(neighbors.begin(), neighbors.end(), [&](const unsigned int other) {
            return other != cells.none && element[other] == element[beyond];
          });
        if (shared >= dim - 1 && on_sphere(sliver, sphere))
          return sphere;
      }
    return cells.none;
  }

  /// Are the nodes of a sliver on the sphere of a cell, with some allowance for its slope?
  bool on_sphere(const unsigned int sliver, const unsigned int c) const
  {
    for (const unsigned int node : cells.node[sliver])
      if (std::abs(points.position[node].distance(cells.center[c]) - cells.radius[c]) >
          4. * options.merge_tolerance * cells.spacing[c])
        return false;
    return true;
  }

  const Cells<dim>          &cells;
  const PointCloud<dim>     &points;
  const TessellationOptions &options;
  const double               limit;
};
} // namespace

template <int dim>
std::vector<unsigned int>
merge_cells(const Cells<dim>          &cells,
            const PointCloud<dim>     &points,
            const TessellationOptions &options,
            const double               largest_radius)
{
  const Slivers<dim>        slivers(cells, points, options, largest_radius);
  Sets                      sets(cells.size());
  std::vector<unsigned int> element(cells.size(), cells.none);
  for (unsigned int c = 0; c < cells.size(); ++c)
    if (slivers.has_sphere(c))
      for (const unsigned int beyond : cells.neighbor[c])
        if (beyond != cells.none && beyond < c && slivers.has_sphere(beyond) &&
            slivers.are_one(c, beyond))
          sets.unite(c, beyond);
  slivers.unite_across(sets);
  for (unsigned int c = 0; c < cells.size(); ++c)
    if (slivers.has_sphere(c))
      element[c] = sets.find(c);
  slivers.join(element);
  return element;
}

template std::vector<unsigned int>
merge_cells(const Cells<2> &, const PointCloud<2> &, const TessellationOptions &, const double);
template std::vector<unsigned int>
merge_cells(const Cells<3> &, const PointCloud<3> &, const TessellationOptions &, const double);
} // namespace coracle::meshless
