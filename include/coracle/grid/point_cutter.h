// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/node_split.h>
#include <coracle/particles/material_points.h>

namespace coracle
{
/**
 * Fills MaterialPoints::cuts of one body: which records of the split nodes its
 * particles use. What lies between a particle and a node is the caller's to
 * say.
 */
template <int dim>
class PointCutter
{
public:
  using Entry = typename CutPoints<dim>::Entry;

  /// Forgets the body's cuts. The records that are asked for are made in `split`.
  PointCutter(const Octree<dim>   &octree,
              const double         margin_of_shape,
              NodeSplit<dim>      &split,
              MaterialPoints<dim> &points);

  /**
   * Rows must come in ascending order.
   * @param leaf    the leaf that the particle is in
   * @param between (node): the sheets between the particle and the node, a bit for each
   * @return is any node that the particle reaches behind a sheet, or does the particle touch a
   * surface? Else it takes the usual path.
   */
  template <typename Between>
  bool cut(const unsigned int row, const unsigned int leaf, const Between &between)
  {
    collect(row);
    const auto touch   = points.touch(row);
    auto      &entries = points.cuts.entries;
    const auto first   = points.cuts.begin.back();
    bool       any     = touch.norm() > 0;
    for (std::size_t e = first; e < entries.size(); ++e)
      if (const std::uint64_t sheets = between(entries[e].node); sheets != 0)
        {
          entries[e].node = split.record(entries[e].node, sheets);
          any             = true;
        }
    for (std::size_t e = first; e < entries.size(); ++e)
      entries[e].gradient -= touch * entries[e].gradient;
    if (!any)
      {
        entries.resize(first);
        return false;
      }
    points.cuts.add_row(row, leaf);
    View view{leaf, {}, points.cuts.size() - 1};
    for (unsigned int c = 0; c < Octree<dim>::n_corners; ++c)
      view.corners[c] = between(octree.nodes(leaf)[c]);
    views.push_back(view);
    return true;
  }

  /// After the last row.
  void finish();

private:
  /// What a particle sees of the corners of its leaf.
  struct View
  {
    unsigned int                                      leaf;
    std::array<std::uint64_t, Octree<dim>::n_corners> corners;
    unsigned int                                      place;
  };

  /// Appends the particle's weights on nodes that do not hang, an entry for each.
  void collect(const unsigned int row);
  void add(const Entry &entry);

  const Octree<dim>   &octree;
  const double         margin_of_shape;
  NodeSplit<dim>      &split;
  MaterialPoints<dim> &points;
  std::vector<View>    views;
};
} // namespace coracle
