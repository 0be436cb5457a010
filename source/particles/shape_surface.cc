// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/text_scanner.h>
#include <coracle/particles/shape_crossing.h>
#include <coracle/particles/shape_surface.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace coracle
{
namespace
{
template <int dim>
using Key = std::array<double, dim>;

template <int dim>
Key<dim>
key(const dealii::Point<dim> &p)
{
  Key<dim> k;
  for (int d = 0; d < dim; ++d)
    k[d] = p[d];
  return k;
}

/// How often an edge (2-D: a vertex) is used, and how often more in one direction than in the
/// other.
struct EdgeUse
{
  int count = 0, direction = 0;
};

/// Edges by the coordinates of their ends, smaller end first: files may repeat a vertex in each
/// facet.
template <int dim>
std::map<std::array<Key<dim>, dim - 1>, EdgeUse>
edge_uses(const FacetSoup<dim> &facets)
{
  std::map<std::array<Key<dim>, dim - 1>, EdgeUse> uses;
  for (const auto &facet : facets)
    for (int v = 0; v < dim; ++v)
      {
        std::array<Key<dim>, dim - 1> edge;
        edge[0]       = key<dim>(facet[v]);
        edge[dim - 2] = key<dim>(facet[dim == 2 ? v : (v + 1) % dim]);
        int direction = (dim == 2 && v == 0) ? -1 : 1;
        if (edge[dim - 2] < edge[0])
          {
            std::swap(edge[0], edge[dim - 2]);
            direction = -1;
          }
        EdgeUse &use = uses[edge];
        ++use.count;
        use.direction += direction;
      }
  return uses;
}

template <int dim>
dealii::BoundingBox<dim>
box_of(const FacetSoup<dim> &facets)
{
  std::vector<dealii::Point<dim>> points;
  points.reserve(dim * facets.size());
  for (const auto &facet : facets)
    points.insert(points.end(), facet.begin(), facet.end());
  return dealii::BoundingBox<dim>(points);
}

/// Is the facet crossed by the half line from the point towards larger y?
bool
is_above(const std::array<dealii::Point<2>, 2> &facet, const dealii::Point<2> &p)
{
  const auto swapped = [](const dealii::Point<2> &q) { return dealii::Point<2>(q[1], q[0]); };
  return crosses_half_line(swapped(facet[0]), swapped(facet[1]), swapped(p));
}

/// The same towards larger z.
bool
is_above(const std::array<dealii::Point<3>, 3> &facet, const dealii::Point<3> &p)
{
  const auto &[a, b, c] = facet;
  if (!(crosses_half_line(a, b, p) ^ crosses_half_line(b, c, p) ^ crosses_half_line(c, a, p)))
    return false;
  const auto normal = dealii::cross_product_3d(b - a, c - a);
  // Seen edge on, to round-off: any height of the facet is as right as another.
  if (normal[2] == 0.)
    return a[2] > p[2];
  return a[2] - (normal[0] * (p[0] - a[0]) + normal[1] * (p[1] - a[1])) / normal[2] > p[2];
}
} // namespace

template <int dim>
std::vector<dealii::Point<dim>>
SurfaceShape<dim>::open_edges(const FacetSoup<dim> &facets)
{
  std::vector<dealii::Point<dim>> result;
  for (const auto &[edge, use] : edge_uses<dim>(facets))
    if (use.count % 2 == 1)
      {
        dealii::Point<dim> middle;
        for (int d = 0; d < dim; ++d)
          middle[d] = 0.5 * (edge[0][d] + edge[dim - 2][d]);
        result.push_back(middle);
      }
  return result;
}

namespace
{
template <int dim>
FacetSoup<dim>
read_closed_surface(const Parameters &body)
{
  const std::string entry = "Surface file", file_name = body.file(entry);
  FacetSoup<dim>    facets;
  std::string       problem;
  try
    {
      facets = read_facets<dim>(file_name);
    }
  catch (const FileError &error)
    {
      problem = error.what();
    }
  if (facets.empty())
    throw body.error(
      entry,
      "surface cannot be read",
      problem.empty() ? file_name + ": no facets" : problem,
      dim == 2 ? "give a mesh of lines (.msh, .vtk, .inp, .ucd)"
               : "give a mesh of triangles or quadrilaterals (.stl, .msh, .vtk, .inp, .ucd)");

  const double scale = body.quantity("Surface scale");
  for (auto &facet : facets)
    for (auto &vertex : facet)
      vertex *= scale;
  if (const auto open = SurfaceShape<dim>::open_edges(facets); !open.empty())
    {
      std::ostringstream found;
      found << open.size() << (dim == 2 ? " loose ends" : " edges with an odd number of facets")
            << ", the first at (" << open[0] << ") m";
      throw body.error(
        entry,
        "surface is not closed",
        found.str(),
        "close the surface, so that facets that meet share their vertices to the last digit");
    }
  return facets;
}
} // namespace

template <int dim>
void
SurfaceShape<dim>::declare(Declaration &entries)
{
  entries.file(
    "Surface file",
    "Closed surface: 2-D a mesh of lines, 3-D of triangles or quadrilaterals (.stl, .msh, "
    ".vtk, .inp, .ucd)");
  entries.quantity("Surface scale", "1", "1", "", "Metres per unit of length of the file", 1e-300);
}

template <int dim>
SurfaceShape<dim>::SurfaceShape(const Parameters &body)
  : SurfaceShape(read_closed_surface<dim>(body))
{}

template <int dim>
SurfaceShape<dim>::SurfaceShape(const FacetSoup<dim> &facets)
  : facets(facets), box(box_of<dim>(facets))
{
  Assert(open_edges(facets).empty(), dealii::ExcMessage("The surface is not closed."));
  fill_raster();
}

template <int dim>
void
SurfaceShape<dim>::fill_raster()
{
  const double per_direction = std::pow(facets.size(), 1. / (dim - 1));
  n_columns.fill(std::clamp(static_cast<int>(per_direction), 1, dim == 2 ? 100000 : 1000));
  raster.resize(dim == 2 ? n_columns[0] : n_columns[0] * n_columns[dim - 2]);

  // A margin, so that a point that round-off puts into a facet from outside still meets it.
  const double margin = 1e-9 * std::pow(box.volume(), 1. / dim);
  for (unsigned int f = 0; f < facets.size(); ++f)
    {
      const dealii::BoundingBox<dim> around(facets[f]);
      auto [lower, upper] = around.get_boundary_points();
      for (int d = 0; d < dim; ++d)
        {
          lower[d] -= margin;
          upper[d] += margin;
        }
      const unsigned int first = raster_column(lower), last = raster_column(upper);
      for (unsigned int j = first / n_columns[0]; j <= last / n_columns[0]; ++j)
        for (unsigned int i = first % n_columns[0]; i <= last % n_columns[0]; ++i)
          raster[j * n_columns[0] + i].push_back(f);
    }
}

template <int dim>
unsigned int
SurfaceShape<dim>::raster_column(const dealii::Point<dim> &point) const
{
  unsigned int column = 0;
  for (int d = dim - 2; d >= 0; --d)
    {
      const double place = (point[d] - box.lower_bound(d)) / box.side_length(d) * n_columns[d];
      column =
        column * n_columns[d] + static_cast<unsigned int>(std::clamp(place, 0., n_columns[d] - 1.));
    }
  return column;
}

template <int dim>
bool
SurfaceShape<dim>::contains(const dealii::Point<dim> &point) const
{
  if (!box.point_inside(point, 0.))
    return false;
  bool inside = false;
  for (const unsigned int f : raster[raster_column(point)])
    inside ^= is_above(facets[f], point);
  return inside;
}

template <int dim>
dealii::BoundingBox<dim>
SurfaceShape<dim>::bounding_box() const
{
  return box;
}

template <int dim>
std::optional<double>
SurfaceShape<dim>::volume() const
{
  for (const auto &[edge, use] : edge_uses<dim>(facets))
    if (use.direction != 0)
      return {};

  const dealii::Point<dim> origin = box.center();
  double                   sum    = 0;
  for (const auto &facet : facets)
    {
      dealii::Tensor<2, dim> corners;
      for (int v = 0; v < dim; ++v)
        corners[v] = facet[v] - origin;
      sum += determinant(corners);
    }
  return std::abs(sum) / (dim == 2 ? 2. : 6.);
}

template class SurfaceShape<2>;
template class SurfaceShape<3>;
} // namespace coracle
