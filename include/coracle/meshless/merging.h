// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/cells.h>
#include <coracle/meshless/tessellation.h>

namespace coracle::meshless
{
/**
 * Which Delaunay cells are one element: for each cell one cell of its element,
 * the same for all of these, or Cells::none for those with a sphere beyond
 * `largest_radius`.
 *
 * - Neighbours whose circumcentres agree within the tolerance are one.
 * - A sliver, as flat as the tolerance, lies between two elements that both have
 *   all its nodes on their spheres; its own sphere says nothing. It joins the
 *   element beyond the facet that lacks its node of lowest id, if that node is on
 *   the element's sphere. What joins depends on the sliver and the element alone,
 *   so that ranks who know these agree.
 */
template <int dim>
std::vector<unsigned int> merge_cells(const Cells<dim>          &cells,
                                      const PointCloud<dim>     &points,
                                      const TessellationOptions &options,
                                      const double               largest_radius);
} // namespace coracle::meshless
