// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/coupling/refinement_measures.h>

namespace coracle
{
namespace
{
/// Mean pressure [Pa] of the particles in each leaf, ghosts included, and whether there are any.
struct LeafPressure
{
  std::vector<double> mean, occupied;
};

template <int dim>
double
pressure(const MaterialPoints<dim> &points, const std::size_t row)
{
  const int first = ParticleLayout<dim>::stress;
  if (points.layout().n_stress == 1)
    return points.column(first)[row];
  return -(points.column(first)[row] + points.column(first + 1)[row] +
           points.column(first + 2)[row]) /
         3.;
}

template <int dim>
LeafPressure
find_pressure(const MaterialPointSystem<dim> &points)
{
  using Layout               = ParticleLayout<dim>;
  const auto         &octree = points.octree;
  LeafPressure        result{std::vector<double>(octree.n_leaves()),
                      std::vector<double>(octree.n_leaves())};
  std::vector<double> volume(octree.n_leaves());
  for (const auto &body : points.bodies)
    {
      const auto &p = body.points;
      for (const unsigned int leaf : p.occupied_cells())
        for (unsigned int row = p.cell_begin()[leaf]; row < p.cell_begin()[leaf + 1]; ++row)
          if (!p.is_hole(row))
            {
              const double v = p.column(Layout::mass)[row] / p.column(Layout::density)[row];
              volume[leaf] += v;
              result.mean[leaf] += v * pressure(p, row);
              result.occupied[leaf] = 1;
            }
    }
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    if (volume[leaf] > 0)
      result.mean[leaf] /= volume[leaf];
  octree.update_ghost_leaves(result.mean);
  octree.update_ghost_leaves(result.occupied);
  return result;
}
} // namespace

template <int dim>
dealii::Point<dim>
parent_centre(const Octree<dim> &octree, const unsigned int leaf)
{
  const double       size = octree.size(leaf);
  dealii::Point<dim> result;
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double lower = octree.box().lower_bound(d);
      const auto   place = std::lround((octree.lower(leaf)[d] - lower) / size);
      result[d]          = lower + size * (place % 2 == 0 ? place + 1 : place);
    }
  return result;
}

template <int dim>
std::vector<double>
layers_from_free_surface(const MaterialPointSystem<dim> &points, const unsigned int n_layers)
{
  const auto               &octree   = points.octree;
  const std::vector<double> occupied = find_pressure(points).occupied;
  std::vector<double>       layers(octree.n_leaves(), n_layers + 1.);
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    if (occupied[leaf] > 0)
      for_each_face_neighbour(octree, leaf, [&](const unsigned int other) {
        if (occupied[other] == 0)
          layers[leaf] = 0;
      });
  for (unsigned int layer = 1; layer <= n_layers; ++layer)
    {
      octree.update_ghost_leaves(layers);
      for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
        if (layers[leaf] > layer)
          for_each_face_neighbour(octree, leaf, [&](const unsigned int other) {
            if (layers[other] == layer - 1)
              layers[leaf] = layer;
          });
    }
  layers.resize(octree.n_owned_leaves());
  return layers;
}

template <int dim>
std::vector<double>
velocity_jump(const MaterialPointSystem<dim> &points)
{
  using Motion                   = typename NodalField<dim>::Motion;
  const auto             &octree = points.octree;
  std::vector<double>     result(octree.n_owned_leaves());
  std::array<double, dim> middle;
  middle.fill(0.5);
  const CornerShape<dim> shape(middle);
  for (const auto &field : points.fields)
    for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
      {
        dealii::Tensor<2, dim> gradient;
        bool                   full = true;
        for (unsigned int c = 0; c < octree.n_corners; ++c)
          {
            const NodeRecord &node = field.motion()[octree.nodes(leaf)[c]];
            full                   = full && node[Motion::mass] > 0;
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int e = 0; e < dim; ++e)
                gradient[d][e] += node[Motion::velocity + d] * shape.gradient[e][c];
          }
        if (full)
          result[leaf] = std::max(result[leaf], gradient.norm());
      }
  return result;
}

template <int dim>
std::vector<double>
pressure_jump(const MaterialPointSystem<dim> &points)
{
  const auto         &octree = points.octree;
  const LeafPressure  p      = find_pressure(points);
  std::vector<double> result(octree.n_owned_leaves());
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    if (p.occupied[leaf] > 0)
      for_each_face_neighbour(octree, leaf, [&](const unsigned int other) {
        if (p.occupied[other] > 0)
          result[leaf] = std::max(result[leaf], std::abs(p.mean[leaf] - p.mean[other]));
      });
  return result;
}

#define INSTANTIATE(dim)                                                                  \
  template dealii::Point<dim>  parent_centre(const Octree<dim> &, const unsigned int);    \
  template std::vector<double> layers_from_free_surface(const MaterialPointSystem<dim> &, \
                                                        const unsigned int);              \
  template std::vector<double> velocity_jump(const MaterialPointSystem<dim> &);           \
  template std::vector<double> pressure_jump(const MaterialPointSystem<dim> &);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
