// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/geometry_info.h>

#include <deal.II/grid/grid_tools.h>

#include <coracle/mesh/mesh_from_file.h>

#include <algorithm>
#include <cmath>

namespace coracle
{
namespace
{
using Element = MeshFile::Element;
using Kind    = MeshFile::Kind;

template <int dim>
constexpr Kind kind_of_cells = (dim == 2 ? Kind::quadrilateral : Kind::hexahedron);
template <int dim>
constexpr Kind kind_of_faces = (dim == 2 ? Kind::line : Kind::quadrilateral);

/// Points of a cell's faces, around them as seen from outside.
template <int dim>
using FacesOfCell = std::array<std::array<unsigned int, (dim == 2 ? 2 : 4)>, 2 * dim>;
template <int dim>
constexpr FacesOfCell<dim> faces_of_cell = {};
template <>
constexpr FacesOfCell<2> faces_of_cell<2> = {{{{0, 1}}, {{1, 2}}, {{2, 3}}, {{3, 0}}}};
template <>
constexpr FacesOfCell<3> faces_of_cell<3> = {
  {{{0, 3, 2, 1}}, {{4, 5, 6, 7}}, {{0, 1, 5, 4}}, {{1, 2, 6, 5}}, {{2, 3, 7, 6}}, {{3, 0, 4, 7}}}};

/// A face of an element, or one by itself: its points around it, of a quadrilateral the smallest
/// first.
template <int dim>
struct Face
{
  static constexpr unsigned int      n_points = (dim == 2 ? 2 : 4);
  std::array<unsigned int, n_points> around = {}, sorted = {};
  const Element                     *element = nullptr;

  Face() = default;
  Face(const std::array<unsigned int, n_points> &points, const Element &element)
    : around(points), sorted(points), element(&element)
  {
    std::sort(sorted.begin(), sorted.end());
    if (dim == 3)
      std::rotate(around.begin(), std::min_element(around.begin(), around.end()), around.end());
  }
  bool operator<(const Face &other) const { return sorted < other.sorted; }

  /// The same face seen from the other side.
  bool is_back_of(const Face &other) const
  {
    auto turned = other.around;
    std::reverse(turned.begin() + (dim == 2 ? 0 : 1), turned.end());
    return around == turned;
  }
};

template <int dim>
dealii::Point<dim>
in_space(const dealii::Point<3> &p)
{
  dealii::Point<dim> result;
  for (int d = 0; d < dim; ++d)
    result[d] = p[d];
  return result;
}

constexpr unsigned int unused = -1;

/// New numbers for the points that have one already, whatever it is.
template <int dim>
std::vector<dealii::Point<dim>>
number_points(const MeshFile &file, std::vector<unsigned int> &number)
{
  std::vector<dealii::Point<dim>> points;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] != unused)
      {
        number[p] = points.size();
        points.push_back(in_space<dim>(file.points[p]));
      }
  return points;
}

/// Elements that are cells, and their points; those of others are left out.
template <int dim>
struct Cells
{
  std::vector<Element>            elements;
  std::vector<dealii::Point<dim>> points;
  std::vector<unsigned int>       number_of_point;
};

template <int dim>
Cells<dim>
find_cells(const MeshFile &file)
{
  Cells<dim> cells;
  for (const Element &element : file.elements)
    if (element.kind == kind_of_cells<dim>)
      cells.elements.push_back(element);
    else if (MeshFile::dimension(element.kind) >= dim)
      file.fail(element,
                dim == 2 ? "no quadrilateral, but a triangle or a volume"
                         : "no hexahedron, but a tetrahedron, wedge or pyramid");
  if (cells.elements.empty())
    throw FileError(file.name + (dim == 2 ? ": no quadrilaterals" : ": no hexahedra"));

  cells.number_of_point.assign(file.points.size(), unused);
  for (const Element &cell : cells.elements)
    for (unsigned int p = 0; p < MeshFile::n_points(cell.kind); ++p)
      cells.number_of_point[cell.points[p]] = 0;
  cells.points = number_points<dim>(file, cells.number_of_point);
  for (Element &cell : cells.elements)
    for (unsigned int p = 0; p < MeshFile::n_points(cell.kind); ++p)
      cell.points[p] = cells.number_of_point[cell.points[p]];
  return cells;
}

template <int dim>
std::vector<unsigned int>
vertices_of(const Element &cell)
{
  using Info = dealii::GeometryInfo<dim>;
  std::vector<unsigned int> vertices(Info::vertices_per_cell);
  for (unsigned int p = 0; p < Info::vertices_per_cell; ++p)
    vertices[Info::ucd_to_deal[p]] = cell.points[p];
  return vertices;
}

/// All volumes are positive then.
template <int dim>
void
turn_cell(const MeshFile &file, const std::vector<dealii::Point<dim>> &points, Element &cell)
{
  for (int attempt = 0; attempt < 2; ++attempt)
    {
      const double volume = dealii::GridTools::cell_measure<dim>(points, vertices_of<dim>(cell));
      if (volume > 0 && std::isfinite(volume))
        return;
      if (dim == 2)
        std::swap(cell.points[1], cell.points[3]);
      else
        std::swap_ranges(cell.points.begin(), cell.points.begin() + 4, cell.points.begin() + 4);
    }
  file.fail(cell, "an element without volume");
}

/// Faces of one element only; those of two must be the two sides.
template <int dim>
std::pair<std::vector<Face<dim>>, std::vector<Face<dim>>>
find_faces(const MeshFile &file, const std::vector<Element> &cells)
{
  std::vector<Face<dim>> all, outer, inner;
  for (const Element &cell : cells)
    for (const auto &corners : faces_of_cell<dim>)
      {
        auto points = corners;
        for (unsigned int &p : points)
          p = cell.points[p];
        all.emplace_back(points, cell);
      }
  std::stable_sort(all.begin(), all.end());
  for (auto face = all.begin(); face != all.end();)
    {
      const auto end = std::upper_bound(face, all.end(), *face);
      if (end - face > 2)
        file.fail(*face[2].element, "a face of this element belongs to two others already");
      if (end - face == 2 && !face[0].is_back_of(face[1]))
        file.fail(*face[1].element,
                  "this element and that of line " + std::to_string(face[0].element->line) +
                    " are on the same side of a face of both");
      (end - face == 2 ? inner : outer).push_back(*face);
      face = end;
    }
  return {outer, inner};
}

/// No two of the same points.
void
check_cells(const MeshFile &file, const std::vector<Element> &cells)
{
  std::vector<std::pair<std::array<unsigned int, 8>, const Element *>> sorted;
  for (const Element &cell : cells)
    {
      sorted.emplace_back(cell.points, &cell);
      auto &points = sorted.back().first;
      std::sort(points.begin(), points.end());
    }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto &a, const auto &b) {
    return a.first < b.first;
  });
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first)
      file.fail(*sorted[i].second, "an element that is there already");
}

void
add(const Face<2> &face, dealii::SubCellData &data)
{
  data.boundary_lines.emplace_back();
  std::copy(face.around.begin(), face.around.end(), data.boundary_lines.back().vertices.begin());
  data.boundary_lines.back().boundary_id = face.element->id;
}

void
add(const Face<3> &face, dealii::SubCellData &data)
{
  data.boundary_quads.emplace_back();
  data.boundary_quads.back().vertices    = {face.around[0],
                                            face.around[1],
                                            face.around[3],
                                            face.around[2]};
  data.boundary_quads.back().boundary_id = face.element->id;
}

/// The faces that are in the file by themselves and have an id. Those without may be anywhere: gmsh
/// writes them between parts of a geometry.
template <int dim>
std::vector<Face<dim>>
find_faces_in_file(const MeshFile &file, const std::vector<unsigned int> &number_of_point)
{
  std::vector<Face<dim>> faces;
  for (const Element &element : file.elements)
    {
      if (MeshFile::dimension(element.kind) + 1 != dim || element.id == 0)
        continue;
      if (element.kind != kind_of_faces<dim>)
        file.fail(element, "a triangle with an id, which is no face of a hexahedron");
      std::array<unsigned int, Face<dim>::n_points> points;
      for (unsigned int p = 0; p < points.size(); ++p)
        points[p] = number_of_point[element.points[p]];
      faces.emplace_back(points, element);
    }
  std::stable_sort(faces.begin(), faces.end());
  return faces;
}

template <int dim>
dealii::SubCellData
find_ids(const MeshFile                                                  &file,
         const std::vector<Face<dim>>                                    &faces_in_file,
         const std::pair<std::vector<Face<dim>>, std::vector<Face<dim>>> &faces)
{
  dealii::SubCellData data;
  const Face<dim>    *last = nullptr;
  for (const Face<dim> &face : faces_in_file)
    {
      if (std::binary_search(faces.second.begin(), faces.second.end(), face))
        file.fail(*face.element, "a face with an id between two elements");
      if (!std::binary_search(faces.first.begin(), faces.first.end(), face))
        file.fail(*face.element, "a face with an id that no element has");
      const bool again = last != nullptr && !(*last < face);
      if (again && last->element->id != face.element->id)
        file.fail(*face.element,
                  "this face has the id " + std::to_string(face.element->id) + ", and in line " +
                    std::to_string(last->element->line) + " the id " +
                    std::to_string(last->element->id));
      if (!again)
        add(face, data);
      last = &face;
    }
  return data;
}
} // namespace

template <int dim>
void
make_triangulation(const MeshFile &file, dealii::Triangulation<dim> &triangulation)
{
  Cells<dim> cells = find_cells<dim>(file);
  for (Element &cell : cells.elements)
    turn_cell<dim>(file, cells.points, cell);
  check_cells(file, cells.elements);
  const auto data = find_ids(file,
                             find_faces_in_file<dim>(file, cells.number_of_point),
                             find_faces<dim>(file, cells.elements));

  std::vector<dealii::CellData<dim>> cell_data(cells.elements.size());
  for (std::size_t i = 0; i < cell_data.size(); ++i)
    cell_data[i].vertices = vertices_of<dim>(cells.elements[i]);
  dealii::GridTools::consistently_order_cells(cell_data);
  triangulation.create_triangulation(cells.points, cell_data, data);
}

template <int dim>
FacetList<dim>
make_facets(const MeshFile &file)
{
  FacetList<dim>            surface;
  std::vector<unsigned int> number(file.points.size(), unused);
  for (const Element &element : file.elements)
    {
      if (MeshFile::dimension(element.kind) >= dim)
        file.fail(element, dim == 2 ? "no line, but an area or a volume" : "a volume");
      if (MeshFile::dimension(element.kind) + 1 < dim)
        continue;
      typename FacetList<dim>::Corners corners;
      // A triangle repeats its last corner.
      const unsigned int n = MeshFile::n_points(element.kind);
      for (unsigned int k = 0; k < corners.size(); ++k)
        corners[k] = element.points[std::min(k, n - 1)];
      for (const unsigned int corner : corners)
        number[corner] = 0;
      surface.facets.push_back(corners);
    }
  if (surface.facets.empty())
    throw FileError(file.name + (dim == 2 ? ": no lines" : ": no quadrilaterals and no triangles"));
  surface.points = number_points<dim>(file, number);
  for (auto &corners : surface.facets)
    for (unsigned int &corner : corners)
      corner = number[corner];
  return surface;
}

template void         make_triangulation(const MeshFile &, dealii::Triangulation<2> &);
template void         make_triangulation(const MeshFile &, dealii::Triangulation<3> &);
template FacetList<2> make_facets(const MeshFile &);
template FacetList<3> make_facets(const MeshFile &);
} // namespace coracle
