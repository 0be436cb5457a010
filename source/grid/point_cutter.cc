// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/corner_shape.h>
#include <coracle/grid/pieces.h>
#include <coracle/grid/point_cutter.h>

#include <tuple>

namespace coracle
{
template <int dim>
PointCutter<dim>::PointCutter(const Octree<dim>   &octree,
                              const double         margin_of_shape,
                              NodeSplit<dim>      &split,
                              MaterialPoints<dim> &points)
  : octree(octree), margin_of_shape(margin_of_shape), split(split), points(points)
{
  points.cuts.reinit(points.n_rows());
}

template <int dim>
void
PointCutter<dim>::collect(const unsigned int row)
{
  const auto   centre = points.position(row);
  const double half   = margin_of_shape * points.column(ParticleLayout<dim>::size)[row];
  for_each_piece(octree,
                 centre,
                 half,
                 [&](const int leaf, const dealii::Point<dim> &piece, const double fraction) {
                   const CornerShape<dim> shape(unit_coordinates(octree, leaf, piece));
                   for (unsigned int c = 0; c < Octree<dim>::n_corners; ++c)
                     {
                       Entry entry;
                       entry.node  = octree.nodes(leaf)[c];
                       entry.value = fraction * shape.value[c];
                       for (int d = 0; d < dim; ++d)
                         entry.gradient[d] = fraction * shape.gradient[d][c] / octree.size(leaf);
                       entry.moment = entry.value * (octree.position(entry.node) - centre);
                       add(entry);
                     }
                 });
}

template <int dim>
void
PointCutter<dim>::add(const Entry &entry)
{
  const auto give = [&](const unsigned int node, const double share) {
    auto       &entries = points.cuts.entries;
    std::size_t e       = points.cuts.begin.back();
    while (e < entries.size() && entries[e].node != node)
      ++e;
    if (e == entries.size())
      entries.push_back({node, 0., {}, {}});
    entries[e].value += share * entry.value;
    entries[e].gradient += share * entry.gradient;
    entries[e].moment += share * entry.moment;
  };
  const int hanging = octree.hanging_index(entry.node);
  if (hanging < 0)
    give(entry.node, 1.);
  else
    for (const auto &[parent, share] : octree.hanging_nodes()[hanging].parents)
      give(parent, share);
}

template <int dim>
void
PointCutter<dim>::finish()
{
  const auto scene = [](const View &view) { return std::tie(view.leaf, view.corners); };
  std::sort(views.begin(), views.end(), [&](const View &a, const View &b) {
    return scene(a) < scene(b);
  });
  unsigned int &n = points.cuts.n_means;
  for (std::size_t i = 0; i < views.size(); ++i)
    {
      const View &view = views[i];
      // Those that see all corners of their leaf share its mean with the particles that are not
      // cut.
      if (std::all_of(view.corners.begin(), view.corners.end(), [](const std::uint64_t sheets) {
            return sheets == 0;
          }))
        continue;
      if (i == 0 || scene(views[i - 1]) != scene(view))
        ++n;
      points.cuts.mean[view.place] = octree.n_leaves() + n - 1;
    }
}

template class PointCutter<2>;
template class PointCutter<3>;
} // namespace coracle
