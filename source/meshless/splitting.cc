// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/simplex.h>
#include <coracle/meshless/splitting.h>

#include <algorithm>
#include <numeric>

namespace coracle::meshless
{
namespace
{
template <int dim>
std::array<dealii::Point<dim>, dim + 1>
corners(const Cells<dim> &cells, const PointCloud<dim> &points, const unsigned int c)
{
  std::array<dealii::Point<dim>, dim + 1> result;
  for (unsigned int i = 0; i <= dim; ++i)
    result[i] = points.position[cells.node[c][i]];
  return result;
}

/// A plane through a facet of the element.
template <int dim>
struct Plane
{
  dealii::Point<dim>     point;
  dealii::Tensor<1, dim> normal;
};

/// The planes of an element's facets; cells from begin to end are its own.
template <int dim>
void
find_planes(const Cells<dim>                &cells,
            const PointCloud<dim>           &points,
            const std::vector<unsigned int> &element,
            const unsigned int              *begin,
            const unsigned int              *end,
            std::vector<Plane<dim>>         &planes)
{
  planes.clear();
  for (const unsigned int *c = begin; c != end; ++c)
    for (unsigned int i = 0; i <= dim; ++i)
      {
        const unsigned int beyond = cells.neighbor[*c][i];
        if (beyond != cells.none && element[beyond] == element[*c])
          continue;
        const auto                          facet = facet_of<dim>(cells.node[*c], i);
        std::array<dealii::Point<dim>, dim> x;
        for (unsigned int k = 0; k < dim; ++k)
          x[k] = points.position[facet[k]];
        const auto normal = normal_of(x);
        planes.push_back({x[0], normal / normal.norm()});
      }
}

/// Do the quadrature points of a cell see all planes, from no less than this share of its height?
template <int dim>
bool
sees(const std::array<dealii::Point<dim>, dim + 1> &x,
     const double                                   height,
     const std::vector<Plane<dim>>                 &planes)
{
  constexpr double share = 0.02, far = (1. - near_corner<dim>) / dim;

  dealii::Tensor<1, dim> sum;
  for (const auto &corner : x)
    sum += corner;
  for (const auto &corner : x)
    {
      const dealii::Point<dim> q(far * sum + (near_corner<dim> - far) * corner);
      for (const auto &plane : planes)
        if (!(plane.normal * (plane.point - q) > share * height))
          return false;
    }
  return true;
}
} // namespace

template <int dim>
void
split_dented(const Cells<dim>          &cells,
             const PointCloud<dim>     &points,
             const TessellationOptions &options,
             std::vector<unsigned int> &element)
{
  // Cells of elements with several, by element.
  std::vector<unsigned int> first(cells.size() + 1, 0);
  for (const unsigned int e : element)
    if (e != cells.none)
      ++first[e + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<unsigned int> next(first.begin(), first.end() - 1), member(first.back());
  for (unsigned int c = 0; c < cells.size(); ++c)
    if (element[c] != cells.none)
      member[next[element[c]]++] = c;

  std::vector<Plane<dim>>   planes;
  std::vector<unsigned int> dented;
  for (unsigned int e = 0; e < cells.size(); ++e)
    if (first[e + 1] > first[e] + 1)
      {
        const unsigned int *const begin = &member[first[e]], *const end =
                                                               begin + first[e + 1] - first[e];
        find_planes(cells, points, element, begin, end, planes);
        const bool whole = std::all_of(begin, end, [&](const unsigned int c) {
          return cells.is_sliver[c] ||
                 sees<dim>(corners(cells, points, c), cells.height[c], planes);
        });
        if (!whole)
          dented.insert(dented.end(), begin, end);
      }
  for (const unsigned int c : dented)
    element[c] = !cells.is_sliver[c] ||
                     radius_is_within(corners(cells, points, c), options.alpha * cells.spacing[c])
                   ? c
                   : cells.none;
}

template void split_dented(const Cells<2> &,
                           const PointCloud<2> &,
                           const TessellationOptions &,
                           std::vector<unsigned int> &);
template void split_dented(const Cells<3> &,
                           const PointCloud<3> &,
                           const TessellationOptions &,
                           std::vector<unsigned int> &);
} // namespace coracle::meshless
