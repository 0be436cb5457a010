// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/delaunay.h>
#include <coracle/meshless/tessellation.h>

namespace coracle::meshless
{
/**
 * Delaunay cells in an order that does not depend on who triangulates them: the
 * nodes of a cell by rising id, but that the last two are exchanged where this
 * makes the cell positively oriented. Whatever is computed from a cell in this
 * order is the same to the last bit on all ranks.
 */
template <int dim>
struct Cells
{
  static constexpr unsigned int none = DelaunayCells<dim>::none;
  using Nodes                        = std::array<unsigned int, dim + 1>;

  std::vector<Nodes> node;
  /// Beyond the facet that lacks the i-th node; none outside the convex hull.
  std::vector<Nodes> neighbor;

  /// Circumcentre and radius [m]; infinite for a cell of no volume.
  std::vector<dealii::Point<dim>> center;
  std::vector<double>             radius;
  /// Mean spacing of the nodes, and the least height over a facet [m].
  std::vector<double> spacing, height;
  /// [m^dim]
  std::vector<double> volume;
  /// As flat as the tolerance of merging.
  std::vector<unsigned char> is_sliver;

  unsigned int size() const { return node.size(); }
};

template <int dim>
Cells<dim> arrange(DelaunayCells<dim>       &&cells,
                   const PointCloud<dim>     &points,
                   const TessellationOptions &options);

/// The facet of a cell that lacks its i-th node, turned counter-clockwise seen from outside.
template <int dim>
std::array<unsigned int, dim>
facet_of(const std::array<unsigned int, dim + 1> &cell, const unsigned int i)
{
  std::array<unsigned int, dim> facet;
  for (unsigned int k = 0, f = 0; k <= dim; ++k)
    if (k != i)
      facet[f++] = cell[k];
  if (i % 2 == 1)
    std::swap(facet[dim - 2], facet[dim - 1]);
  return facet;
}
} // namespace coracle::meshless
