// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/global_search.h>

namespace coracle::contact
{
template <int dim>
GlobalSearch<dim>::GlobalSearch(const Search chosen)
{
  if (chosen == Search::bucket)
    method.template emplace<BucketSearch>();
  else if (chosen == Search::all_pairs)
    method.template emplace<AllPairsSearch>();
}

namespace
{
/// Leaves out what surface nodes may not touch, see PointSet::may_touch.
template <int dim>
void
keep_touchable(const Surface<dim> &surface, const PointSet<dim> &points, Candidates &list)
{
  Candidates all;
  std::swap(all, list);
  for (std::size_t i = 0; i < all.point.size(); ++i)
    {
      for (std::size_t k = all.begin[i]; k < all.begin[i + 1]; ++k)
        if (points.may_touch(all.point[i], surface, surface.facets[all.facet[k]]))
          list.facet.push_back(all.facet[k]);
      if (list.facet.size() > list.begin.back())
        {
          list.point.push_back(all.point[i]);
          list.begin.push_back(list.facet.size());
        }
    }
}
} // namespace

template <int dim>
void
GlobalSearch<dim>::rebuild(const Surface<dim>               &surface,
                           const std::vector<PointSet<dim>> &points,
                           const double                      reach)
{
  boxes.clear();
  Box all = empty_box(dim);
  for (const auto &facet : surface.facets)
    {
      boxes.push_back(
        facet_box(surface, facet, 0.5 * surface.bodies[facet.body].thickness + reach));
      include(all, boxes.back());
    }
  lists.resize(points.size());
  std::visit(
    [&](auto &search) {
      search.build(boxes, all);
      for (unsigned int s = 0; s < points.size(); ++s)
        {
          lists[s].clear();
          if (!boxes.empty())
            search.find(points[s], lists[s]);
          if (points[s].body >= 0)
            keep_touchable(surface, points[s], lists[s]);
        }
    },
    method);
}

template class GlobalSearch<2>;
template class GlobalSearch<3>;
} // namespace coracle::contact
