// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/perpendicular_foot.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
/// A foot on the edge must be on it for both facets that share it, in spite of round-off.
bool
in_range(const double natural)
{
  return std::abs(natural) <= 1 + edge_tolerance;
}
} // namespace

bool
perpendicular_foot(const dealii::Point<2>                &x_p,
                   const std::array<dealii::Point<2>, 2> &vertices,
                   NearestPoint<2>                       &foot)
{
  // Newton's first step is exact.
  const auto   edge   = vertices[1] - vertices[0];
  const double length = edge.norm_square();
  if (!(length > 0) || !in_range(2 * ((x_p - vertices[0]) * edge / length) - 1))
    return false;
  foot = nearest_point(x_p, vertices);
  return true;
}

bool
perpendicular_foot(const dealii::Point<3>                &x_p,
                   const std::array<dealii::Point<3>, 4> &vertices,
                   NearestPoint<3>                       &foot)
{
  if (vertices[3] == vertices[2]) // a triangle is flat: its foot is its nearest point, or outside
    {
      foot = nearest_point_triangle(x_p, vertices);
      const auto normal =
        dealii::cross_product_3d(vertices[1] - vertices[0], vertices[2] - vertices[0]);
      const auto   offset = x_p - foot.place;
      const auto   along  = normal * (offset * normal / normal.norm_square());
      const double size   = std::max(vertices[0].distance_square(vertices[1]),
                                   vertices[0].distance_square(vertices[2]));
      return (offset - along).norm_square() <= edge_tolerance * edge_tolerance * size;
    }
  const auto found = perpendicular_foot(make_bilinear(relative_corners(x_p, vertices)));
  if (!(found.found > 0) || !in_range(found.place.xi) || !in_range(found.place.eta))
    return false;
  foot = describe(x_p, vertices, found.place.xi, found.place.eta);
  return true;
}
} // namespace coracle::contact
