// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/laplace.h>
#include <coracle/meshless/simplex.h>

#include <numeric>

namespace coracle::meshless
{
using dealii::Point;
using dealii::Tensor;

template <int dim>
void
LaplaceShape<dim>::make_consistent(const double volume)
{
  integrate_surface();
  const double   total = std::accumulate(weights.begin(), weights.end(), 0.);
  Tensor<1, dim> center, sum;
  Tensor<2, dim> moment, spread;
  for (const auto &x : nodes)
    center += x / n;
  for (unsigned int i = 0; i < n; ++i)
    {
      Tensor<1, dim> &shift = surface[i];
      shift /= volume;
      for (unsigned int q = 0; q < n_points(); ++q)
        shift -= weights[q] / total * gradients[q * n + i];
      sum += shift;
    }
  // Faces that are plane only within a tolerance leave shifts that would spoil linear functions by
  // as much.
  for (unsigned int i = 0; i < n; ++i)
    {
      surface[i] -= sum / n;
      moment += outer_product(surface[i], nodes[i] - center);
      spread += outer_product(nodes[i] - center, nodes[i] - center);
    }
  const Tensor<2, dim> rest = moment * invert(spread);
  for (unsigned int i = 0; i < n; ++i)
    {
      surface[i] -= rest * (nodes[i] - center);
      for (unsigned int q = 0; q < n_points(); ++q)
        gradients[q * n + i] += surface[i];
    }
}

template <>
void
LaplaceShape<2>::integrate_surface()
{
  surface.assign(n, Tensor<1, 2>());
  for (const auto &facet : facets)
    for (const unsigned int i : facet.node)
      surface[i] +=
        normal_of(std::array<Point<2>, 2>{nodes[facet.node[0]], nodes[facet.node[1]]}) / 2.;
}

template <>
void
LaplaceShape<2>::integrate_planar_face(const std::vector<unsigned int> &, const unsigned int)
{}

/// On a plane face with its nodes on a circle the functions are those of the polygon.
template <>
void
LaplaceShape<3>::integrate_planar_face(const std::vector<unsigned int> &of_face,
                                       const unsigned int               face)
{
  const Tensor<1, 3>  normal = facets[face].normal;
  std::vector<double> value(n);
  for (unsigned int f = 0; f < facets.size(); ++f)
    if (of_face[f] == face)
      for (unsigned int k = 0; k < 3; ++k)
        {
          const auto             &node = facets[f].node;
          std::array<Point<3>, 3> x    = {nodes[node[k]],
                                          nodes[node[(k + 1) % 3]],
                                          nodes[node[(k + 2) % 3]]};
          const Tensor<1, 3>      at =
            near_corner<2> * x[0] + (1. - near_corner<2>) / 2. * (Tensor<1, 3>(x[1]) + x[2]);
          std::fill(value.begin(), value.end(), 0.);
          for (const auto &[a, b, here, beyond] : pairs)
            if (of_face[here] == face && of_face[beyond] != face)
              {
                // Corner of the polygon's Voronoi cell that belongs to the edge from a to b.
                const Point<3> middle = nodes[a] + (nodes[b] - nodes[a]) / 2.;
                Tensor<1, 3>   away   = cross_product_3d(nodes[b] - nodes[a], normal);
                away /= away.norm();
                const Tensor<1, 3> from = at - middle;
                const double       slide =
                  (from.norm_square() - nodes[a].distance_square(nodes[b]) / 4.) /
                  (2. * (away * from));
                const Point<3> corner = middle + slide * away;
                value[a] += cross_product_3d(corner - nodes[a], normal) * (nodes[a] - at);
                value[b] -= cross_product_3d(corner - nodes[b], normal) * (nodes[b] - at);
              }
          double sum = 0.;
          for (unsigned int i = 0; i < n; ++i)
            if (value[i] != 0.)
              sum += value[i] /= (nodes[i] - at).norm_square();
          for (unsigned int i = 0; i < n; ++i)
            surface[i] += value[i] / (3. * sum) * normal_of(x);
        }
}

template <>
void
LaplaceShape<3>::integrate_surface()
{
  std::vector<unsigned int> face(facets.size()), n_triangles(facets.size(), 0);
  for (unsigned int f = 0; f < facets.size(); ++f)
    ++n_triangles[face[f] = facets[f].face];

  surface.assign(n, Tensor<1, 3>());
  for (unsigned int f = 0; f < facets.size(); ++f)
    if (n_triangles[f] == 1)
      {
        const auto &node = facets[f].node;
        for (const unsigned int i : node)
          surface[i] +=
            normal_of(std::array<Point<3>, 3>{nodes[node[0]], nodes[node[1]], nodes[node[2]]}) / 3.;
      }
    else if (n_triangles[f] > 1)
      integrate_planar_face(face, f);
}

template class LaplaceShape<2>;
template class LaplaceShape<3>;
} // namespace coracle::meshless
