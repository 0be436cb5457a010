// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/laplace.h>
#include <coracle/meshless/simplex.h>

#include <algorithm>
#include <cmath>

namespace coracle::meshless
{
using dealii::Point;
using dealii::Tensor;

template <int dim>
void
LaplaceShape<dim>::reinit(const PointCloud<dim>   &points,
                          const Tessellation<dim> &tessellation,
                          const unsigned int       element)
{
  const unsigned int *const begin = &tessellation.node[tessellation.first_node[element]];
  n                               = tessellation.n_nodes(element);
  nodes.resize(n);
  for (unsigned int i = 0; i < n; ++i)
    nodes[i] = points.position[begin[i]];
  weights.clear();
  quadrature.clear();
  if (n == dim + 1)
    set_simplex(tessellation.volume[element]);
  else
    {
      set_quadrature(points, tessellation, element);
      set_facets(tessellation, element);
      values.resize(n * n_points());
      gradients.resize(n * n_points());
      for (unsigned int q = 0; q < n_points(); ++q)
        evaluate(quadrature[q], &values[q * n], &gradients[q * n]);
      make_consistent();
    }
}

template <int dim>
void
LaplaceShape<dim>::set_simplex(const double volume)
{
  std::array<Point<dim>, dim + 1> x;
  Tensor<1, dim>                  center;
  for (unsigned int i = 0; i <= dim; ++i)
    {
      x[i] = nodes[i];
      center += x[i] / (dim + 1.);
    }
  weights.assign(1, volume);
  quadrature.assign(1, Point<dim>(center));
  values.assign(dim + 1, 1. / (dim + 1));
  gradients.resize(dim + 1);
  // The facet opposite a node, over dim times the volume; the nodes may turn either way.
  const double scale = -1. / (dim * size_of(x));
  for (unsigned int i = 0; i <= dim; ++i)
    {
      std::array<Point<dim>, dim> facet;
      for (unsigned int k = 0, f = 0; k <= dim; ++k)
        if (k != i)
          facet[f++] = x[k];
      gradients[i] = (i % 2 == 0 ? scale : -scale) * normal_of(facet);
    }
}

template <int dim>
void
LaplaceShape<dim>::set_quadrature(const PointCloud<dim>   &points,
                                  const Tessellation<dim> &tessellation,
                                  const unsigned int       element)
{
  for (unsigned int s = tessellation.first_simplex[element];
       s < tessellation.first_simplex[element + 1];
       ++s)
    {
      std::array<Point<dim>, dim + 1> x;
      Tensor<1, dim>                  others;
      for (unsigned int i = 0; i <= dim; ++i)
        {
          x[i] = points.position[tessellation.simplex[s][i]];
          others += (1. - near_corner<dim>) / dim * x[i];
        }
      for (unsigned int i = 0; i <= dim; ++i)
        {
          weights.push_back(size_of(x) / (dim + 1));
          quadrature.push_back(
            Point<dim>(others + (near_corner<dim> - (1. - near_corner<dim>) / dim) * x[i]));
        }
    }
}

template <int dim>
void
LaplaceShape<dim>::set_facets(const Tessellation<dim> &tessellation, const unsigned int element)
{
  const auto begin = tessellation.node.begin() + tessellation.first_node[element];
  facets.clear();
  for (unsigned int f = tessellation.first_facet[element];
       f < tessellation.first_facet[element + 1];
       ++f)
    {
      Facet                       facet;
      std::array<Point<dim>, dim> x;
      for (unsigned int i = 0; i < dim; ++i)
        {
          facet.node[i] = std::find(begin, begin + n, tessellation.facet[f][i]) - begin;
          x[i]          = nodes[facet.node[i]];
        }
      facet.normal = normal_of(x);
      facet.normal /= facet.normal.norm();
      facet.center        = center_of(x);
      facet.radius_square = facet.center.distance_square(x[0]);
      facet.face          = tessellation.face[f];
      facets.push_back(facet);
    }
  if constexpr (dim == 3)
    pair_facets();
}

template <int dim>
void
LaplaceShape<dim>::pair_facets()
{
  pairs.clear();
  unpaired.clear();
  for (unsigned int f = 0; f < facets.size(); ++f)
    for (unsigned int i = 0; i < dim; ++i)
      {
        const std::array<unsigned int, 3> edge = {facets[f].node[i],
                                                  facets[f].node[(i + 1) % dim],
                                                  f};
        const auto partner = std::find_if(unpaired.begin(), unpaired.end(), [&](const auto &other) {
          return other[0] == edge[1] && other[1] == edge[0];
        });
        if (partner == unpaired.end())
          {
            unpaired.push_back(edge);
            continue;
          }
        pairs.push_back({edge[0], edge[1], f, (*partner)[2]});
        pairs.push_back({edge[1], edge[0], (*partner)[2], f});
        *partner = unpaired.back();
        unpaired.pop_back();
      }
  Assert(unpaired.empty(), dealii::ExcMessage("The surface of an element is not closed"));
}

template <int dim>
void
LaplaceShape<dim>::evaluate(const Point<dim> &x, double *value, Tensor<1, dim> *gradient) const
{
  // Corners of the Voronoi cell of x, one for each facet: equally far from x and the facet's nodes.
  // As x moves, a corner slides along the facet's axis.
  corners.resize(facets.size());
  slides.resize(facets.size());
  for (unsigned int f = 0; f < facets.size(); ++f)
    {
      const Tensor<1, dim> from   = x - facets[f].center;
      const double         height = facets[f].normal * from;
      const double         slide  = (from.norm_square() - facets[f].radius_square) / (2. * height);
      corners[f]                  = facets[f].center + slide * facets[f].normal;
      slides[f]                   = (from - slide * facets[f].normal) / height;
    }

  // Faces of that cell, as vectors along their normals, and the gradients of their products with
  // the way to the node.
  faces.assign(n, Tensor<1, dim>());
  std::fill(gradient, gradient + n, Tensor<1, dim>());
  if constexpr (dim == 2)
    for (unsigned int f = 0; f < facets.size(); ++f)
      for (unsigned int k = 0; k < 2; ++k)
        {
          const unsigned int i    = facets[f].node[k];
          const double       sign = k == 0 ? 1. : -1.;
          faces[i] += sign * turned_right(corners[f] - nodes[i]);
          gradient[i] += sign * (turned_right(facets[f].normal) * (nodes[i] - x)) * slides[f];
        }
  else
    for (const auto &[other, i, f, g] : pairs)
      {
        const Tensor<1, dim> to_node = (nodes[i] - x) / 2., a = corners[f] - nodes[i],
                             b = corners[g] - nodes[i];
        faces[i] += cross_product_3d(a, b) / 2.;
        gradient[i] += to_node * cross_product_3d(facets[f].normal, b) * slides[f] +
                       to_node * cross_product_3d(a, facets[g].normal) * slides[g];
      }

  // Area over distance, and the share in their sum.
  double         sum = 0.;
  Tensor<1, dim> sum_gradient;
  for (unsigned int i = 0; i < n; ++i)
    {
      const Tensor<1, dim> to_node = nodes[i] - x;
      const double         inverse = 1. / to_node.norm_square();
      value[i]                     = faces[i] * to_node * inverse;
      gradient[i]                  = (gradient[i] - faces[i] + 2. * value[i] * to_node) * inverse;
      sum += value[i];
      sum_gradient += gradient[i];
    }
  for (unsigned int i = 0; i < n; ++i)
    {
      value[i] /= sum;
      gradient[i] = (gradient[i] - value[i] * sum_gradient) / sum;
    }
}

template class LaplaceShape<2>;
template class LaplaceShape<3>;
} // namespace coracle::meshless
