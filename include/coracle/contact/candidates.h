// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/box.h>
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
  /// All facets listed since the last call belong to this point, which is beyond all before it.
  void close(const unsigned int point);
};

/// Axis-aligned box of a facet's nodes; the third direction is 0 in 2-D.
template <int dim>
Box facet_box(const Surface<dim> &surface, const Facet<dim> &facet, const double margin);

/// Axis-aligned box of a point of a set with its radius.
template <int dim>
inline Box
point_box(const PointSet<dim> &points, const unsigned int i)
{
  Box          box;
  const double r = points.radius(i);
  for (int d = 0; d < dim; ++d)
    {
      box.lower[d] = points.position[d][i] - r;
      box.upper[d] = points.position[d][i] + r;
    }
  return box;
}
} // namespace coracle::contact
