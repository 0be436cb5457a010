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
        }
    },
    method);
}

template class GlobalSearch<2>;
template class GlobalSearch<3>;
} // namespace coracle::contact
