// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/global_search.h>

#include <algorithm>
#include <limits>

namespace coracle::contact
{
namespace
{
/// Points outside the caller's groups are taken this many at a time.
constexpr unsigned int chunk = 16;

Box
empty_box(const int dim)
{
  Box box;
  for (int d = 0; d < dim; ++d)
    {
      box.lower[d] = std::numeric_limits<double>::max();
      box.upper[d] = std::numeric_limits<double>::lowest();
    }
  return box;
}

template <int dim>
void
extend(Box &box, const PointSet<dim> &points, const unsigned int i)
{
  const double r = points.radius(i);
  for (int d = 0; d < dim; ++d)
    {
      const double x = points.position[d][i];
      box.lower[d]   = std::min(box.lower[d], x - r);
      box.upper[d]   = std::max(box.upper[d], x + r);
    }
}
} // namespace

void
Candidates::clear()
{
  point.clear();
  begin.assign(1, 0);
  facet.clear();
}

template <int dim>
Box
facet_box(const Surface<dim> &surface, const Facet<dim> &facet, const double margin)
{
  Box box = empty_box(dim);
  for (const unsigned int node : facet.nodes)
    for (int d = 0; d < dim; ++d)
      {
        const double x = surface.nodes[node].position[d];
        box.lower[d]   = std::min(box.lower[d], x - margin);
        box.upper[d]   = std::max(box.upper[d], x + margin);
      }
  return box;
}

template <int dim>
void
GlobalSearch<dim>::rebuild(const Surface<dim>               &surface,
                           const std::vector<PointSet<dim>> &points,
                           const double                      reach)
{
  boxes.clear();
  all = empty_box(dim);
  for (const auto &facet : surface.facets)
    {
      boxes.push_back(
        facet_box(surface, facet, 0.5 * surface.bodies[facet.body].thickness + reach));
      for (int d = 0; d < dim; ++d)
        {
          all.lower[d] = std::min(all.lower[d], boxes.back().lower[d]);
          all.upper[d] = std::max(all.upper[d], boxes.back().upper[d]);
        }
    }
  tree.build(boxes);

  lists.resize(points.size());
  for (unsigned int s = 0; s < points.size(); ++s)
    {
      lists[s].clear();
      if (boxes.empty())
        continue;
      const auto  &groups = points[s].group_begin;
      unsigned int next   = 0;
      const auto   loose  = [&](const unsigned int end) {
        for (; next < end; next = std::min(next + chunk, end))
          search_group(points[s], next, std::min(next + chunk, end), lists[s]);
      };
      if (!groups.empty())
        {
          loose(groups.front());
          for (unsigned int g = 0; g + 1 < groups.size(); ++g)
            if (groups[g] < groups[g + 1])
              search_group(points[s], groups[g], groups[g + 1], lists[s]);
          next = groups.back();
        }
      loose(points[s].n_points);
    }
}

template <int dim>
void
GlobalSearch<dim>::search_group(const PointSet<dim> &points,
                                const unsigned int   begin,
                                const unsigned int   end,
                                Candidates          &list)
{
  Box group = empty_box(dim);
  for (unsigned int i = begin; i < end; ++i)
    if (!points.is_hole(i))
      extend(group, points, i);
  if (!overlap(group, all))
    return;
  tree.find(group, found);
  if (found.empty())
    return;
  std::sort(found.begin(), found.end());
  for (unsigned int i = begin; i < end; ++i)
    {
      if (points.is_hole(i))
        continue;
      Box point = empty_box(dim);
      extend(point, points, i);
      for (const unsigned int f : found)
        if (overlap(point, boxes[f]))
          list.facet.push_back(f);
      if (list.facet.size() > list.begin.back())
        {
          list.point.push_back(i);
          list.begin.push_back(list.facet.size());
        }
    }
}

template Box facet_box(const Surface<2> &, const Facet<2> &, const double);
template Box facet_box(const Surface<3> &, const Facet<3> &, const double);
template class GlobalSearch<2>;
template class GlobalSearch<3>;
} // namespace coracle::contact
