// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/nearest_point.h>

namespace coracle::contact
{
namespace
{
/// Position along a segment in [0, 1], exactly 0 or 1 near its ends.
template <int dim>
double
along_segment(const dealii::Point<dim> &x_p,
              const dealii::Point<dim> &a,
              const dealii::Point<dim> &b)
{
  const auto   edge   = b - a;
  const double length = edge.norm_square();
  const double s      = (length > 0 ? (x_p - a) * edge / length : 0.);
  return s < 0.5 * edge_tolerance ? 0. : (s > 1 - 0.5 * edge_tolerance ? 1. : s);
}

/// -1 and 1 for what is nearly so.
double
snap(const double natural)
{
  return natural < edge_tolerance - 1 ? -1. : (natural > 1 - edge_tolerance ? 1. : natural);
}
} // namespace

NearestPoint<2>
nearest_point(const dealii::Point<2> &x_p, const std::array<dealii::Point<2>, 2> &vertices)
{
  const double    s = along_segment(x_p, vertices[0], vertices[1]);
  NearestPoint<2> result;
  result.weights         = {{1 - s, s}};
  result.place           = vertices[0] + s * (vertices[1] - vertices[0]);
  result.distance_square = x_p.distance_square(result.place);
  result.region          = (s == 0 || s == 1 ? Region::vertex : Region::interior);
  result.feature         = (s == 1 ? 1 : 0);
  return result;
}

NearestPoint<3>
nearest_point_triangle(const dealii::Point<3> &x_p, const std::array<dealii::Point<3>, 4> &vertices)
{
  NearestPoint<3> result;
  const auto e1 = vertices[1] - vertices[0], e2 = vertices[2] - vertices[0], e = x_p - vertices[0];
  const auto normal   = dealii::cross_product_3d(e1, e2);
  const double square = normal.norm_square();
  if (square > 0)
    {
      const double w1 = dealii::cross_product_3d(e, e2) * normal / square,
                   w2 = dealii::cross_product_3d(e1, e) * normal / square, w0 = 1 - w1 - w2;
      if (std::min({w0, w1, w2}) > 0.5 * edge_tolerance)
        {
          result.weights         = {{w0, w1, w2, 0.}};
          result.place           = vertices[0] + w1 * e1 + w2 * e2;
          result.distance_square = x_p.distance_square(result.place);
          result.region          = Region::interior;
          result.feature         = 0;
          return result;
        }
    }
  result.distance_square = std::numeric_limits<double>::max();
  for (unsigned int k = 0; k < 3; ++k)
    {
      const unsigned int next   = (k + 1) % 3;
      const double       s      = along_segment(x_p, vertices[k], vertices[next]);
      const auto         place  = vertices[k] + s * (vertices[next] - vertices[k]);
      const double       square = x_p.distance_square(place);
      if (square < result.distance_square)
        {
          result.weights         = {{0., 0., 0., 0.}};
          result.weights[k]      = 1 - s;
          result.weights[next]   = s;
          result.place           = place;
          result.distance_square = square;
          result.region          = (s == 0 || s == 1 ? Region::vertex : Region::edge);
          result.feature         = (s == 1 ? next : k);
        }
    }
  return result;
}

NearestPoint<3>
describe(const dealii::Point<3>                &x_p,
         const std::array<dealii::Point<3>, 4> &vertices,
         const double                           natural_xi,
         const double                           natural_eta)
{
  const double    xi = snap(natural_xi), eta = snap(natural_eta);
  NearestPoint<3> result;
  result.weights = {{0.25 * (1 - xi) * (1 - eta),
                     0.25 * (1 + xi) * (1 - eta),
                     0.25 * (1 + xi) * (1 + eta),
                     0.25 * (1 - xi) * (1 + eta)}};
  result.place   = dealii::Point<3>();
  for (unsigned int k = 0; k < 4; ++k)
    result.place += result.weights[k] * vertices[k];
  result.distance_square = x_p.distance_square(result.place);
  const bool xi_end = (xi == -1 || xi == 1), eta_end = (eta == -1 || eta == 1);
  result.region =
    (xi_end && eta_end ? Region::vertex : (xi_end || eta_end ? Region::edge : Region::interior));
  result.feature = 0;
  if (result.region == Region::vertex)
    result.feature = (eta < 0 ? (xi < 0 ? 0 : 1) : (xi > 0 ? 2 : 3));
  else if (result.region == Region::edge)
    result.feature = (eta == -1 ? 0 : (xi == 1 ? 1 : (eta == 1 ? 2 : 3)));
  return result;
}

NearestPoint<3>
nearest_point(const dealii::Point<3> &x_p, const std::array<dealii::Point<3>, 4> &vertices)
{
  const auto found = nearest_natural_point(relative_corners(x_p, vertices));
  return describe(x_p, vertices, found.xi, found.eta);
}
} // namespace coracle::contact
