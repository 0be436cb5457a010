// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/cells.h>
#include <coracle/meshless/simplex.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <limits>

namespace coracle::meshless
{
namespace
{
using dealii::Point;
using dealii::Tensor;

/// Nodes by rising id, neighbours along with them, the orientation kept.
template <int dim>
void
sort_nodes(std::array<unsigned int, dim + 1> &node,
           std::array<unsigned int, dim + 1> &neighbor,
           const std::vector<std::uint64_t>  &id)
{
  const auto swap_places = [&](const unsigned int a, const unsigned int b) {
    std::swap(node[a], node[b]);
    std::swap(neighbor[a], neighbor[b]);
  };
  bool odd = false;
  for (unsigned int end = dim; end > 0; --end)
    for (unsigned int i = 0; i < end; ++i)
      if (id[node[i]] > id[node[i + 1]])
        {
          swap_places(i, i + 1);
          odd = !odd;
        }
  if (odd)
    swap_places(dim - 1, dim);
}

/// Twice the area, and the circumcentre as seen from the first node.
double
measure(const std::array<Tensor<1, 2>, 2> &edge, Tensor<1, 2> &center)
{
  const double twice = edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
  center             = (cross_product_2d(edge[1]) * edge[0].norm_square() -
            cross_product_2d(edge[0]) * edge[1].norm_square()) /
           (2. * twice);
  return twice;
}

/// Six times the volume.
double
measure(const std::array<Tensor<1, 3>, 3> &edge, Tensor<1, 3> &center)
{
  const auto   bc  = cross_product_3d(edge[1], edge[2]);
  const double six = edge[0] * bc;
  center =
    (edge[0].norm_square() * bc + edge[1].norm_square() * cross_product_3d(edge[2], edge[0]) +
     edge[2].norm_square() * cross_product_3d(edge[0], edge[1])) /
    (2. * six);
  return six;
}

template <int dim>
void
measure_cell(Cells<dim> &cells, const unsigned int c, const PointCloud<dim> &points)
{
  constexpr double factorial = dim == 2 ? 2. : 6.;

  const auto                     &node   = cells.node[c];
  const Point<dim>               &origin = points.position[node[0]];
  std::array<Tensor<1, dim>, dim> edge;
  double                          spacing = points.spacing[node[0]];
  for (unsigned int i = 0; i < dim; ++i)
    {
      edge[i] = points.position[node[i + 1]] - origin;
      spacing += points.spacing[node[i + 1]];
    }
  Tensor<1, dim> center;
  const double   size = measure(edge, center);

  cells.spacing[c] = spacing / (dim + 1);
  cells.volume[c]  = std::max(size, 0.) / factorial;
  cells.height[c]  = std::max(size, 0.) / largest_facet(edge);
  cells.center[c]  = origin + center;
  cells.radius[c]  = center.norm();
  if (!(size > 0.) || !std::isfinite(cells.radius[c]))
    cells.radius[c] = std::numeric_limits<double>::infinity();
}
} // namespace

template <int dim>
Cells<dim>
arrange(DelaunayCells<dim>       &&delaunay,
        const PointCloud<dim>     &points,
        const TessellationOptions &options)
{
  Cells<dim> cells;
  cells.node           = std::move(delaunay.node);
  cells.neighbor       = std::move(delaunay.neighbor);
  const unsigned int n = cells.size();
  cells.center.resize(n);
  for (auto *column : {&cells.radius, &cells.spacing, &cells.height, &cells.volume})
    column->resize(n);
  cells.is_sliver.resize(n);
  for (unsigned int c = 0; c < n; ++c)
    {
      sort_nodes<dim>(cells.node[c], cells.neighbor[c], points.id);
      measure_cell(cells, c, points);
      cells.is_sliver[c] = cells.height[c] <= options.merge_tolerance * cells.spacing[c];
    }
  return cells;
}

template Cells<2> arrange(DelaunayCells<2> &&, const PointCloud<2> &, const TessellationOptions &);
template Cells<3> arrange(DelaunayCells<3> &&, const PointCloud<3> &, const TessellationOptions &);
} // namespace coracle::meshless
