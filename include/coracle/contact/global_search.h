// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/box_tree.h>
#include <coracle/contact/point_set.h>
#include <coracle/contact/surface.h>

namespace coracle::contact
{
/// Which facets a point may touch before the next rebuild; points that have none are left out.
struct Candidates
{
  /// Points with candidates, ascending.
  std::vector<unsigned int> point;
  /// Facets of point[i]: facet[begin[i]] up to facet[begin[i+1]], ascending.
  std::vector<std::size_t>  begin = {0};
  std::vector<unsigned int> facet;

  void clear();
};

/// Axis-aligned box of a facet's nodes; the third direction is 0 in 2-D.
template <int dim>
Box facet_box(const Surface<dim> &surface, const Facet<dim> &facet, const double margin);

/**
 * Candidates of all points of the sets: facets whose box, enlarged by half the
 * thickness, the point's radius and `reach` [m], holds the point. Groups of
 * points are looked up in the box tree, points only among what their group found.
 */
template <int dim>
class GlobalSearch
{
public:
  void rebuild(const Surface<dim>               &surface,
               const std::vector<PointSet<dim>> &points,
               const double                      reach);

  const Candidates &candidates(const unsigned int set) const { return lists[set]; }

private:
  void search_group(const PointSet<dim> &points,
                    const unsigned int   begin,
                    const unsigned int   end,
                    Candidates          &list);

  BoxTree                   tree;
  Box                       all;
  std::vector<Box>          boxes;
  std::vector<Candidates>   lists;
  std::vector<unsigned int> found;
};
} // namespace coracle::contact
