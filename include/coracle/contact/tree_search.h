// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/box_tree.h>
#include <coracle/contact/candidates.h>

namespace coracle::contact
{
/// Global search in a tree of the facets' boxes: groups of points are looked up in it, points only
/// among what their group found. The cost grows as points times the logarithm of facets.
class TreeSearch
{
public:
  /// The facets' boxes, and the box around them all; both stay the caller's.
  void build(const std::vector<Box> &boxes, const Box &all);

  template <int dim>
  void find(const PointSet<dim> &points, Candidates &list);

private:
  template <int dim>
  void search_group(const PointSet<dim> &points,
                    const unsigned int   begin,
                    const unsigned int   end,
                    Candidates          &list);

  const std::vector<Box>   *boxes = nullptr;
  Box                       all;
  BoxTree                   tree;
  std::vector<unsigned int> found;
};
} // namespace coracle::contact
