// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/tree_search.h>

#include <algorithm>

namespace coracle::contact
{
namespace
{
/// Points outside the caller's groups are taken this many at a time.
constexpr unsigned int chunk = 16;
} // namespace

void
TreeSearch::build(const std::vector<Box> &facet_boxes, const Box &around)
{
  boxes = &facet_boxes;
  all   = around;
  tree.build(facet_boxes);
}

template <int dim>
void
TreeSearch::find(const PointSet<dim> &points, Candidates &list)
{
  const auto  &groups = points.group_begin;
  unsigned int next   = 0;
  const auto   loose  = [&](const unsigned int end) {
    for (; next < end; next = std::min(next + chunk, end))
      search_group(points, next, std::min(next + chunk, end), list);
  };
  if (!groups.empty())
    {
      loose(groups.front());
      for (unsigned int g = 0; g + 1 < groups.size(); ++g)
        if (groups[g] < groups[g + 1])
          search_group(points, groups[g], groups[g + 1], list);
      next = groups.back();
    }
  loose(points.n_points);
}

template <int dim>
void
TreeSearch::search_group(const PointSet<dim> &points,
                         const unsigned int   begin,
                         const unsigned int   end,
                         Candidates          &list)
{
  Box group = empty_box(dim);
  for (unsigned int i = begin; i < end; ++i)
    if (!points.is_hole(i))
      include(group, point_box(points, i));
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
      const Box point = point_box(points, i);
      for (const unsigned int f : found)
        if (overlap(point, (*boxes)[f]))
          list.facet.push_back(f);
      list.close(i);
    }
}

template void TreeSearch::find(const PointSet<2> &, Candidates &);
template void TreeSearch::find(const PointSet<3> &, Candidates &);
} // namespace coracle::contact
