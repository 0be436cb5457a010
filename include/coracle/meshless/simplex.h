// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>

/// Measures of simplices and their facets, in the plane and in space.
namespace coracle::meshless
{
/// A rule of degree two on a simplex has one point near each corner; its share of that corner.
template <int dim>
inline constexpr double near_corner = dim == 2 ? 2. / 3. : 0.58541019662496845446;

inline dealii::Tensor<1, 2>
turned_right(const dealii::Tensor<1, 2> &a)
{
  return cross_product_2d(a);
}

inline double
size_of(const std::array<dealii::Point<2>, 3> &x)
{
  return turned_right(x[1] - x[0]) * (x[0] - x[2]) / 2.;
}

inline double
size_of(const std::array<dealii::Point<3>, 4> &x)
{
  return cross_product_3d(x[1] - x[0], x[2] - x[0]) * (x[3] - x[0]) / 6.;
}

/// (dim - 1)! times the measure of the largest facet, from the edges at one corner.
inline double
largest_facet(const std::array<dealii::Tensor<1, 2>, 2> &edge)
{
  return std::sqrt(
    std::max({edge[0].norm_square(), edge[1].norm_square(), (edge[1] - edge[0]).norm_square()}));
}

inline double
largest_facet(const std::array<dealii::Tensor<1, 3>, 3> &edge)
{
  return std::sqrt(
    std::max({cross_product_3d(edge[0], edge[1]).norm_square(),
              cross_product_3d(edge[1], edge[2]).norm_square(),
              cross_product_3d(edge[2], edge[0]).norm_square(),
              cross_product_3d(edge[1] - edge[0], edge[2] - edge[0]).norm_square()}));
}

/// Height over the largest facet, which is the least.
template <int dim>
double
least_height(const std::array<dealii::Point<dim>, dim + 1> &x)
{
  std::array<dealii::Tensor<1, dim>, dim> edge;
  for (unsigned int i = 0; i < dim; ++i)
    edge[i] = x[i + 1] - x[0];
  return (dim == 2 ? 2. : 6.) * std::abs(size_of(x)) / largest_facet(edge);
}

/// Outward normal of a facet, its length the facet's measure.
inline dealii::Tensor<1, 2>
normal_of(const std::array<dealii::Point<2>, 2> &x)
{
  return turned_right(x[1] - x[0]);
}

inline dealii::Tensor<1, 3>
normal_of(const std::array<dealii::Point<3>, 3> &x)
{
  return cross_product_3d(x[1] - x[0], x[2] - x[0]) / 2.;
}

/// The centre of the circle or sphere through the corners.
template <int dim>
dealii::Point<dim>
sphere_center(const std::array<dealii::Point<dim>, dim + 1> &x)
{
  dealii::Tensor<2, dim> edges;
  dealii::Tensor<1, dim> half_squares;
  for (unsigned int i = 0; i < dim; ++i)
    {
      edges[i]        = x[i + 1] - x[0];
      half_squares[i] = edges[i].norm_square() / 2.;
    }
  return x[0] + invert(edges) * half_squares;
}

/// The point of the facet's plane that is equally far from its nodes.
inline dealii::Point<2>
center_of(const std::array<dealii::Point<2>, 2> &x)
{
  return x[0] + (x[1] - x[0]) / 2.;
}

inline dealii::Point<3>
center_of(const std::array<dealii::Point<3>, 3> &x)
{
  const auto a = x[1] - x[0], b = x[2] - x[0], c = cross_product_3d(a, b);
  return x[0] +
         (a.norm_square() * cross_product_3d(b, c) + b.norm_square() * cross_product_3d(c, a)) /
           (2. * c.norm_square());
}
} // namespace coracle::meshless
