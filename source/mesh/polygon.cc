// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/grid/grid_tools.h>

#include <coracle/mesh/polygon.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace coracle
{
namespace
{
using Point2 = dealii::Point<2>;

/// A bilinear patch: corners in deal.II's order and elements along its two directions.
struct Patch
{
  std::array<Point2, 4>       corners;
  std::array<unsigned int, 2> n;
};

/// Twice the signed area of a triangle.
double
doubled_area(const Point2 &a, const Point2 &b, const Point2 &c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double
doubled_area(const std::vector<Point2> &corners)
{
  double result = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    result += doubled_area(corners[0], corners[i], corners[(i + 1) % corners.size()]);
  return result;
}

/// Do two edges that share no corner meet?
bool
is_crossing(const std::vector<Point2> &corners)
{
  const std::size_t m = corners.size();
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = i + 2; j < m; ++j)
      if (!(i == 0 && j == m - 1))
        {
          const Point2 &a = corners[i], &b = corners[i + 1], &c = corners[j],
                       &d = corners[(j + 1) % m];
          if (doubled_area(a, b, c) * doubled_area(a, b, d) <= 0 &&
              doubled_area(c, d, a) * doubled_area(c, d, b) <= 0)
            return true;
        }
  return false;
}

Point2
middle(const Point2 &a, const Point2 &b)
{
  return Point2((a + b) / 2.);
}

Point2
centroid(const std::vector<Point2> &corners)
{
  Point2 result;
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    {
      const Point2 &b = corners[i], &c = corners[(i + 1) % corners.size()];
      const double  part = doubled_area(corners[0], b, c);
      result += part / 3. * (corners[0] + b + c);
      area += part;
    }
  return Point2(result / area);
}

/// One patch a corner: corner, middle of the edge ahead, middle of the edge behind, centre.
std::vector<Patch>
star(const std::vector<Point2> &corners, const unsigned int n)
{
  const Point2       centre = centroid(corners);
  const std::size_t  m      = corners.size();
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < m; ++i)
    patches.push_back({{{corners[i],
                         middle(corners[i], corners[(i + 1) % m]),
                         middle(corners[i], corners[(i + m - 1) % m]),
                         centre}},
                       {{n, n}}});
  return patches;
}

/// All four corners must be convex for the bilinear map to be one to one.
bool
is_convex(const Patch &patch)
{
  const auto  &c         = patch.corners;
  const double tolerance = 1e-10 * c[0].distance_square(c[3]);
  return doubled_area(c[0], c[1], c[2]) > tolerance && doubled_area(c[1], c[3], c[0]) > tolerance &&
         doubled_area(c[3], c[2], c[1]) > tolerance && doubled_area(c[2], c[0], c[3]) > tolerance;
}

/// Ear clipping (Meisters 1975): a simple polygon always has a corner that can be cut off.
std::vector<std::array<Point2, 3>>
triangles(std::vector<Point2> corners)
{
  std::vector<std::array<Point2, 3>> result;
  while (corners.size() > 3)
    {
      const std::size_t m            = corners.size();
      std::size_t       best         = m;
      double            best_quality = 1e-12;
      for (std::size_t i = 0; i < m; ++i)
        {
          const Point2 &a = corners[(i + m - 1) % m], &b = corners[i], &c = corners[(i + 1) % m];
          const bool    blocked = std::any_of(corners.begin(), corners.end(), [&](const Point2 &p) {
            return p != a && p != b && p != c && doubled_area(a, b, p) >= 0 &&
                   doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
          });
          const double  quality =
            doubled_area(a, b, c) /
            (a.distance_square(b) + b.distance_square(c) + c.distance_square(a));
          if (!blocked && quality > best_quality)
            {
              best         = i;
              best_quality = quality;
            }
        }
      if (best == m)
        throw std::invalid_argument("the polygon crosses or touches itself");
      result.push_back({{corners[(best + m - 1) % m], corners[best], corners[(best + 1) % m]}});
      corners.erase(corners.begin() + best);
    }
  result.push_back({{corners[0], corners[1], corners[2]}});
  return result;
}

std::vector<Patch>
patches_of(const std::vector<Point2> &corners, const std::vector<unsigned int> &subdivisions)
{
  std::vector<Patch> patches = star(corners, subdivisions[0]);
  if (std::all_of(patches.begin(), patches.end(), is_convex))
    {
      if (subdivisions.size() == 3)
        {
          // A patch shares the number along a side with the patch across that side.
          const unsigned int a = subdivisions[0], b = subdivisions[1], c = subdivisions[2];
          patches[0].n = {{a, b}};
          patches[1].n = {{b, c}};
          patches[2].n = {{c, a}};
        }
      return patches;
    }
  patches.clear();
  for (const auto &triangle : triangles(corners))
    for (const Patch &patch : star({triangle.begin(), triangle.end()}, subdivisions[0]))
      patches.push_back(patch);
  return patches;
}

/// Elements of a patch with vertices of their own; equal ones are merged afterwards.
void
append(const Patch &patch, std::vector<Point2> &vertices, std::vector<dealii::CellData<2>> &cells)
{
  const unsigned int first = vertices.size(), row = patch.n[0] + 1;
  for (unsigned int j = 0; j <= patch.n[1]; ++j)
    for (unsigned int i = 0; i <= patch.n[0]; ++i)
      {
        const double x = double(i) / patch.n[0], y = double(j) / patch.n[1];
        vertices.emplace_back((1 - y) * ((1 - x) * patch.corners[0] + x * patch.corners[1]) +
                              y * ((1 - x) * patch.corners[2] + x * patch.corners[3]));
      }
  for (unsigned int j = 0; j < patch.n[1]; ++j)
    for (unsigned int i = 0; i < patch.n[0]; ++i)
      {
        dealii::CellData<2> cell;
        const unsigned int  v = first + j * row + i;
        cell.vertices         = {v, v + 1, v + row, v + row + 1};
        cells.push_back(cell);
      }
}

/// The edge that a boundary face's centre lies on.
unsigned int
nearest_edge(const std::vector<Point2> &corners, const Point2 &p)
{
  unsigned int best          = 0;
  double       best_distance = std::numeric_limits<double>::max();
  for (unsigned int i = 0; i < corners.size(); ++i)
    {
      const Point2 &a    = corners[i];
      const auto    edge = corners[(i + 1) % corners.size()] - a;
      const double  s    = std::clamp((p - a) * edge / edge.norm_square(), 0., 1.);
      const double  d    = (p - a - s * edge).norm();
      if (d < best_distance)
        {
          best          = i;
          best_distance = d;
        }
    }
  return best;
}
} // namespace

void
polygon_mesh(std::vector<Point2>              corners,
             const std::vector<unsigned int> &subdivisions,
             dealii::Triangulation<2>        &triangulation)
{
  if (corners.size() < 3)
    throw std::invalid_argument("a polygon needs three corners");
  if (subdivisions.size() != 1 && !(subdivisions.size() == 3 && corners.size() == 3))
    throw std::invalid_argument("give one number of subdivisions, or three for a triangle");
  if (is_crossing(corners) || doubled_area(corners) == 0)
    throw std::invalid_argument("the polygon crosses or touches itself, or has no area");
  // Counter-clockwise, keeping the first corner and with it the ids of most use.
  const bool clockwise = doubled_area(corners) < 0;
  const auto original  = corners;
  if (clockwise)
    std::reverse(corners.begin() + 1, corners.end());

  std::vector<Point2>              vertices;
  std::vector<dealii::CellData<2>> cells;
  for (const Patch &patch : patches_of(corners, subdivisions))
    append(patch, vertices, cells);
  double size = 0;
  for (const Point2 &corner : corners)
    size = std::max(size, corner.distance(corners[0]));
  dealii::SubCellData       no_faces;
  std::vector<unsigned int> all;
  dealii::GridTools::delete_duplicated_vertices(vertices, cells, no_faces, all, 1e-9 * size);
  triangulation.create_triangulation(vertices, cells, no_faces);

  for (const auto &face : triangulation.active_face_iterators())
    if (face->at_boundary())
      face->set_boundary_id(nearest_edge(original, face->center()));
}
} // namespace coracle
