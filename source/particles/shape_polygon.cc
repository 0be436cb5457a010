// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape_crossing.h>
#include <coracle/particles/shape_polygon.h>

#include <cmath>
#include <sstream>

namespace coracle
{
namespace
{
using Vertices = std::vector<dealii::Point<2>>;

double
signed_area(const Vertices &v)
{
  double twice = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    {
      // Relative to the first vertex, so that a polygon far from the origin loses no digits.
      const auto a = v[i] - v[0], b = v[(i + 1) % v.size()] - v[0];
      twice += a[0] * b[1] - a[1] * b[0];
    }
  return 0.5 * twice;
}

/// Positive if c lies to the left of the line from a to b.
double
side(const dealii::Point<2> &a, const dealii::Point<2> &b, const dealii::Point<2> &c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The first pair of edges, not neighbours, that cross properly; {0, 0} if there is none.
std::pair<std::size_t, std::size_t>
crossing_edges(const Vertices &v)
{
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      {
        const auto &a = v[i], &b = v[i + 1], &c = v[j], &d = v[(j + 1) % n];
        if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0)
          return {i, j};
      }
  return {0, 0};
}

Vertices
read_vertices(const Parameters &body)
{
  const std::vector<double> numbers = body.list("Vertices");
  const std::string cure = "give x, y of at least three corners, one after the other around it";
  if (numbers.size() < 6 || numbers.size() % 2 != 0)
    throw body.error("Vertices",
                     "incomplete polygon",
                     std::to_string(numbers.size()) + " numbers",
                     cure);
  Vertices vertices;
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    vertices.emplace_back(numbers[i], numbers[i + 1]);

  if (const auto edges = crossing_edges(vertices); edges.second > 0)
    {
      std::ostringstream found;
      found << "the edge from (" << vertices[edges.first] << ") m crosses the one from ("
            << vertices[edges.second] << ") m";
      throw body.error("Vertices", "polygon crosses itself", found.str(), cure);
    }
  if (signed_area(vertices) == 0.)
    throw body.error("Vertices", "polygon without area", "all corners on one line", cure);
  return vertices;
}

template <int dim>
std::pair<double, double>
read_heights(const Parameters &body)
{
  const std::vector<double> heights = body.list("Height range");
  if (dim == 2 && !heights.empty())
    throw body.error("Height range",
                     "extrusion in two dimensions",
                     "a range of heights",
                     "remove it, or set Dimension = 3");
  if (dim == 2)
    return {0., 1.};
  if (heights.size() != 2 || !(heights[0] < heights[1]))
    throw body.error("Height range",
                     "polygon without height",
                     std::to_string(heights.size()) + " numbers, or an empty range",
                     "give the lowest and the highest z of the extruded polygon");
  return {heights[0], heights[1]};
}
} // namespace

template <int dim>
void
PolygonShape<dim>::declare(Declaration &entries)
{
  entries.list(
    "Vertices", "", "m", "", "x, y of each corner, one after the other around the polygon");
  entries.list("Height range", "", "m", "", "3-D: lowest and highest z of the extruded polygon");
}

template <int dim>
PolygonShape<dim>::PolygonShape(const Parameters &body)
  : PolygonShape(read_vertices(body), read_heights<dim>(body))
{}

template <int dim>
PolygonShape<dim>::PolygonShape(const Vertices &vertices, const std::pair<double, double> &heights)
  : vertices(vertices), heights(heights)
{}

template <int dim>
bool
PolygonShape<dim>::contains(const dealii::Point<dim> &point) const
{
  if (dim == 3 && (point[dim - 1] < heights.first || point[dim - 1] > heights.second))
    return false;
  bool inside = false;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    inside ^= crosses_half_line(vertices[i], vertices[(i + 1) % vertices.size()], point);
  return inside;
}

template <int dim>
dealii::BoundingBox<dim>
PolygonShape<dim>::bounding_box() const
{
  const dealii::BoundingBox<2> flat(vertices);
  dealii::Point<dim>           lower, upper;
  for (int d = 0; d < dim; ++d)
    {
      lower[d] = d < 2 ? flat.lower_bound(d) : heights.first;
      upper[d] = d < 2 ? flat.upper_bound(d) : heights.second;
    }
  return {{lower, upper}};
}

template <int dim>
std::optional<double>
PolygonShape<dim>::volume() const
{
  return std::abs(signed_area(vertices)) * (dim == 2 ? 1. : heights.second - heights.first);
}

template class PolygonShape<2>;
template class PolygonShape<3>;
} // namespace coracle
