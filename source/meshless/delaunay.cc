// SPDX-License-Identifier: GPL-3.0-or-later
// The only file of the room that includes CGAL.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <coracle/meshless/delaunay.h>

#include <algorithm>
#include <numeric>

namespace coracle::meshless
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// CGAL's names for the same things in the plane and in space.
template <int dim>
struct Library;

template <>
struct Library<2>
{
  using Vertex        = CGAL::Triangulation_vertex_base_with_info_2<unsigned int, Kernel>;
  using Face          = CGAL::Triangulation_face_base_with_info_2<unsigned int, Kernel>;
  using Data          = CGAL::Triangulation_data_structure_2<Vertex, Face>;
  using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, Data>;
  using Point         = Kernel::Point_2;

  static Point point(const dealii::Point<2> &p) { return {p[0], p[1]}; }
  static auto  cells(const Triangulation &t) { return t.finite_face_handles(); }
  static auto  nearest(const Triangulation &t, const Point &p) { return t.nearest_vertex(p); }
};

template <>
struct Library<3>
{
  using Vertex        = CGAL::Triangulation_vertex_base_with_info_3<unsigned int, Kernel>;
  using Base          = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Cell          = CGAL::Triangulation_cell_base_with_info_3<unsigned int, Kernel, Base>;
  using Data          = CGAL::Triangulation_data_structure_3<Vertex, Cell>;
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Data>;
  using Point         = Kernel::Point_3;

  static Point point(const dealii::Point<3> &p) { return {p[0], p[1], p[2]}; }
  static auto  cells(const Triangulation &t) { return t.finite_cell_handles(); }
  static auto  nearest(const Triangulation &t, const Point &p) { return t.nearest_vertex(p); }
};

/// Which points have no vertex of their own?
template <int dim>
void
find_coincident(const std::vector<dealii::Point<dim>>      &points,
                const typename Library<dim>::Triangulation &triangulation,
                DelaunayCells<dim>                         &result)
{
  result.n_coincident = points.size() - triangulation.number_of_vertices();
  if (result.n_coincident == 0)
    return;
  std::vector<bool> has_vertex(points.size(), false);
  for (const auto &vertex : triangulation.finite_vertex_handles())
    has_vertex[vertex->info()] = true;
  const unsigned int left_out =
    std::find(has_vertex.begin(), has_vertex.end(), false) - has_vertex.begin();
  const auto vertex = Library<dim>::nearest(triangulation, Library<dim>::point(points[left_out]));
  result.coincident = {vertex->info(), left_out};
}
/// Number the cells by their lowest point, so that what is near in the cloud is near in memory
/// (CGAL's own order is not). Returns how many there are.
template <int dim>
unsigned int
number_cells(typename Library<dim>::Triangulation &triangulation, const std::size_t n_points)
{
  const auto lowest = [](const auto &cell) {
    unsigned int result = cell->vertex(0)->info();
    for (int i = 1; i <= dim; ++i)
      result = std::min(result, cell->vertex(i)->info());
    return result;
  };
  std::vector<unsigned int> next(n_points + 1, 0);
  for (const auto &cell : Library<dim>::cells(triangulation))
    ++next[lowest(cell) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  const unsigned int n_cells = next.back();
  for (const auto &cell : Library<dim>::cells(triangulation))
    cell->info() = next[lowest(cell)]++;
  return n_cells;
}
} // namespace

template <int dim>
DelaunayCells<dim>
delaunay(const std::vector<dealii::Point<dim>> &points)
{
  using Point = typename Library<dim>::Point;
  std::vector<std::pair<Point, unsigned int>> numbered;
  numbered.reserve(points.size());
  for (unsigned int i = 0; i < points.size(); ++i)
    numbered.emplace_back(Library<dim>::point(points[i]), i);

  DelaunayCells<dim> result;
  // Inserts along a space-filling curve, so that each point is located from its neighbour.
  typename Library<dim>::Triangulation triangulation(numbered.begin(), numbered.end());
  find_coincident(points, triangulation, result);
  if (triangulation.dimension() < dim)
    return result;

  const unsigned int n_cells = number_cells<dim>(triangulation, points.size());
  result.node.resize(n_cells);
  result.neighbor.resize(n_cells);
  for (const auto &cell : Library<dim>::cells(triangulation))
    for (int i = 0; i <= dim; ++i)
      {
        const auto beyond            = cell->neighbor(i);
        result.node[cell->info()][i] = cell->vertex(i)->info();
        result.neighbor[cell->info()][i] =
          triangulation.is_infinite(beyond) ? DelaunayCells<dim>::none : beyond->info();
      }
  return result;
}

bool
radius_is_within(const std::array<dealii::Point<2>, 3> &x, const double radius)
{
  // In the plane flat triangles with a small circle have a short side, and no centre that slips.
  const auto   a = x[1] - x[0], b = x[2] - x[0];
  const double twice = a[0] * b[1] - a[1] * b[0];
  return a.norm() * b.norm() * (b - a).norm() <= 2. * std::abs(twice) * radius;
}

bool
radius_is_within(const std::array<dealii::Point<3>, 4> &x, const double radius)
{
  using L = Library<3>;
  return CGAL::compare_squared_radius(L::point(x[0]),
                                      L::point(x[1]),
                                      L::point(x[2]),
                                      L::point(x[3]),
                                      radius * radius) != CGAL::LARGER;
}

template DelaunayCells<2> delaunay(const std::vector<dealii::Point<2>> &);
template DelaunayCells<3> delaunay(const std::vector<dealii::Point<3>> &);
} // namespace coracle::meshless
