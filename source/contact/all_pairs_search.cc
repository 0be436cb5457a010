// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/all_pairs_search.h>

namespace coracle::contact
{
void
AllPairsSearch::build(const std::vector<Box> &facet_boxes, const Box &)
{
  boxes = &facet_boxes;
}

template <int dim>
void
AllPairsSearch::find(const PointSet<dim> &points, Candidates &list) const
{
  for (unsigned int i = 0; i < points.n_points; ++i)
    if (!points.is_hole(i))
      {
        const Box point = point_box(points, i);
        for (unsigned int f = 0; f < boxes->size(); ++f)
          if (overlap(point, (*boxes)[f]))
            list.facet.push_back(f);
        list.close(i);
      }
}

template void AllPairsSearch::find(const PointSet<2> &, Candidates &) const;
template void AllPairsSearch::find(const PointSet<3> &, Candidates &) const;
} // namespace coracle::contact
