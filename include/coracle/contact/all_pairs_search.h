// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/candidates.h>

namespace coracle::contact
{
/// Global search that tests every point with every facet: the oracle for the others, and their
/// equal where facets are few.
class AllPairsSearch
{
public:
  /// The facets' boxes, and the box around them all; both stay the caller's.
  void build(const std::vector<Box> &boxes, const Box &all);

  template <int dim>
  void find(const PointSet<dim> &points, Candidates &list) const;

private:
  const std::vector<Box> *boxes = nullptr;
};
} // namespace coracle::contact
