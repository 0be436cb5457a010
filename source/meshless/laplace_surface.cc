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
LaplaceShape<dim>::make_consistent()
{
  integrate_surface();
  // What the surface encloses: the volume of the simplices, but for what lies between a bent face
  // and its triangles, which the neighbour has less or more.
  double         volume = 0.;
  Tensor<1, dim> center, sum;
  Tensor<2, dim> moment, spread;
  for (const auto &x : nodes)
    center += x / n;
  for (unsigned int i = 0; i < n; ++i)
    volume += surface[i] * (nodes[i] - center) / dim;
  const double total = std::accumulate(weights.begin(), weights.end(), 0.);
  for (double &weight : weights)
    weight *= volume / total;
  for (unsigned int i = 0; i < n; ++i)
    {
      Tensor<1, dim> &shift = surface[i];
      for (unsigned int q = 0; q < n_points(); ++q)
        shift -= weights[q] * gradients[q * n + i];
      shift /= volume;
      sum += shift;
    }
  // The rules on bent faces are not exact; the rest would spoil linear functions.
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
LaplaceShape<2>::integrate_polygon(const unsigned int)
{}

/// Functions of the polygon in its plane and their gradients at a point of it.
template <>
void
LaplaceShape<3>::evaluate_polygon(const Point<3> &x, const Tensor<1, 3> &normal)
{
  face_value.assign(n, 0.);
  face_gradient.assign(n, Tensor<1, 3>());
  for (const auto &[a, b] : rim)
    {
      // Corner of the polygon's Voronoi cell that belongs to the edge from a to b.
      const Point<3> &pa = in_plane[a], &pb = in_plane[b], middle = pa + (pb - pa) / 2.;
      Tensor<1, 3>    away = cross_product_3d(pb - pa, normal);
      away /= away.norm();
      const Tensor<1, 3> from = x - middle, along = cross_product_3d(away, normal);
      const double       height = away * from;
      const double       slide = (from.norm_square() - pa.distance_square(pb) / 4.) / (2. * height);
      const Tensor<1, 3> slides = (from - slide * away) / height;
      const Point<3>     corner = middle + slide * away;
      for (const auto &[i, sign] : {std::pair{a, 1.}, {b, -1.}})
        {
          const Tensor<1, 3> to_node = in_plane[i] - x;
          const Tensor<1, 3> edge    = sign * cross_product_3d(corner - in_plane[i], normal);
          face_value[i] += edge * to_node;
          face_gradient[i] += sign * (along * to_node) * slides - edge;
        }
    }
  double       sum = 0.;
  Tensor<1, 3> sum_gradient;
  for (unsigned int i = 0; i < n; ++i)
    if (face_value[i] != 0.)
      {
        const Tensor<1, 3> to_node = in_plane[i] - x;
        const double       inverse = 1. / to_node.norm_square();
        face_value[i] *= inverse;
        face_gradient[i] = (face_gradient[i] + 2. * face_value[i] * to_node) * inverse;
        sum += face_value[i];
        sum_gradient += face_gradient[i];
      }
  for (unsigned int i = 0; i < n; ++i)
    {
      face_value[i] /= sum;
      face_gradient[i] = (face_gradient[i] - face_value[i] * sum_gradient) / sum;
    }
}

/// On a plane face with its nodes on a circle the functions are those of the polygon. A face that
/// is bent within the tolerance is the surface sum_i N_i(x) n_i over its mean plane.
template <>
void
LaplaceShape<3>::integrate_polygon(const unsigned int face)
{
  Tensor<1, 3> normal;
  for (const auto &f : facets)
    if (f.face == face)
      normal +=
        normal_of(std::array<Point<3>, 3>{nodes[f.node[0]], nodes[f.node[1]], nodes[f.node[2]]});
  normal /= normal.norm();
  const Point<3> base = nodes[facets[face].node[0]];
  in_plane            = nodes;
  for (auto &x : in_plane)
    x -= ((x - base) * normal) * normal;

  // Height over the plane is linear along the rim, so that its mean gradient is known.
  Tensor<1, 3> rest;
  double       area = 0.;
  rim.clear();
  for (const auto &[a, b, here, beyond] : pairs)
    if (facets[here].face == face && facets[beyond].face != face)
      {
        rim.emplace_back(a, b);
        const double height = ((nodes[a] - base) * normal + (nodes[b] - base) * normal) / 2.;
        rest += height * cross_product_3d(in_plane[b] - in_plane[a], normal);
      }

  face_integral.assign(n, 0.);
  for (const auto &f : facets)
    if (f.face == face)
      for (unsigned int k = 0; k < 3; ++k)
        {
          const std::array<Point<3>, 3> x      = {in_plane[f.node[k]],
                                                  in_plane[f.node[(k + 1) % 3]],
                                                  in_plane[f.node[(k + 2) % 3]]};
          const double                  weight = normal_of(x) * normal / 3.;
          evaluate_polygon(Point<3>(near_corner<2> * x[0] +
                                    (1. - near_corner<2>) / 2. * (Tensor<1, 3>(x[1]) + x[2])),
                           normal);
          Tensor<1, 3> slope;
          for (unsigned int i = 0; i < n; ++i)
            slope += ((nodes[i] - base) * normal) * face_gradient[i];
          for (unsigned int i = 0; i < n; ++i)
            {
              surface[i] += weight * face_value[i] * (normal - slope);
              face_integral[i] += weight * face_value[i];
            }
          rest -= weight * slope;
          area += weight;
        }
  for (unsigned int i = 0; i < n; ++i)
    surface[i] -= face_integral[i] / area * rest;
}

template <>
void
LaplaceShape<3>::integrate_surface()
{
  std::vector<unsigned int> n_triangles(facets.size(), 0);
  for (const auto &facet : facets)
    ++n_triangles[facet.face];

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
      integrate_polygon(f);
}

template class LaplaceShape<2>;
template class LaplaceShape<3>;
} // namespace coracle::meshless
