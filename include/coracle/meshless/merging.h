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
 *   all its nodes on their spheres; its own centre says nothing. It joins the first
 *   of these, in the order of the facets that lack its nodes of lowest id, that has
 *   all of one of its sides. A sliver without such an element is one by itself if its
 *   sphere is at most alpha h large.
 *
 * What a cell joins depends on cells that share a facet with it, or with slivers
 * upon it, whose nodes are on the same circle.
 */
template <int dim>
std::vector<unsigned int> merge_cells(const Cells<dim>          &cells,
                                      const PointCloud<dim>     &points,
                                      const TessellationOptions &options,
                                      const double               largest_radius);
} // namespace coracle::meshless
