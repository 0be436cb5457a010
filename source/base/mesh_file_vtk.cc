// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_file_builder.h"

#include <limits>

namespace coracle::internal
{
namespace
{
/// An element before its type is known: its points begin here in the list of all.
struct Connection
{
  std::size_t begin, n_points, line;
};

struct Cells
{
  std::vector<unsigned int> points;
  std::vector<Connection>   connections;
  std::vector<std::int64_t> types;
  std::vector<unsigned int> ids;
};

void
read_header(TextScanner &in)
{
  const std::string_view magic = "# vtk DataFile Version ", first = in.rest_of_line();
  if (first.substr(0, magic.size()) != magic)
    in.fail("the first line is not '" + std::string(magic) + "...'");
  if (first.substr(magic.size(), 1) >= "5")
    in.fail("versions of VTK's format from 5 are not read: write version 4.2 or older");
  in.rest_of_line();
  if (in.word() != "ASCII")
    in.fail("a file that is not ASCII");
  in.expect("DATASET");
  in.expect("UNSTRUCTURED_GRID");
}

void
read_cells(TextScanner &in, Cells &cells)
{
  const std::size_t n = in.count("cells");
  in.integer("number of integers");
  for (std::size_t i = 0; i < n; ++i)
    {
      const std::size_t n_points = in.count("points");
      cells.connections.push_back({cells.points.size(), n_points, in.line()});
      for (std::size_t p = 0; p < n_points; ++p)
        cells.points.push_back(in.natural("number of a point"));
    }
}

/// The kind of data that means ids; others are left out.
void
read_scalars(TextScanner &in, Cells &cells)
{
  if (in.word() != "MaterialID" || !cells.ids.empty())
    return;
  in.rest_of_line();
  in.expect("LOOKUP_TABLE");
  in.word();
  for (std::size_t i = 0; i < cells.connections.size(); ++i)
    {
      // deal.II writes -1 for edges and faces without an id.
      const std::int64_t id = in.integer("MaterialID");
      if (id < -1 || id >= std::numeric_limits<unsigned int>::max())
        in.fail(std::to_string(id) + " is no MaterialID");
      cells.ids.push_back(id == -1 ? 0 : id);
    }
}

MeshFile::Kind
kind_of(const std::int64_t type)
{
  using Kind = MeshFile::Kind;
  switch (type)
    {
      case 3:
        return Kind::line;
      case 5:
        return Kind::triangle;
      case 9:
        return Kind::quadrilateral;
      case 10:
        return Kind::tetrahedron;
      case 12:
        return Kind::hexahedron;
      default:
        return Kind::other;
    }
}

void
put_together(TextScanner &in, const Cells &cells, MeshFile &mesh)
{
  if (cells.types.size() != cells.connections.size() ||
      (!cells.ids.empty() && cells.ids.size() != cells.connections.size()))
    in.fail("CELLS, CELL_TYPES and MaterialID are not of as many elements");
  constexpr std::int64_t vertex = 1;
  for (std::size_t i = 0; i < cells.connections.size(); ++i)
    {
      if (cells.types[i] == vertex)
        continue;
      const Connection  &connection = cells.connections[i];
      MeshFile::Element  element{kind_of(cells.types[i]),
                                {},
                                cells.ids.empty() ? 0 : cells.ids[i],
                                connection.line};
      const unsigned int n = MeshFile::n_points(element.kind);
      if (n > 0 && connection.n_points != n)
        mesh.fail(element,
                  std::to_string(connection.n_points) + " points of an element of type " +
                    std::to_string(cells.types[i]));
      for (unsigned int p = 0; p < n; ++p)
        {
          element.points[p] = cells.points[connection.begin + p];
          if (element.points[p] >= mesh.points.size())
            mesh.fail(element, "there is no point " + std::to_string(element.points[p]));
        }
      mesh.elements.push_back(element);
    }
}
} // namespace

void
read_vtk(TextScanner &in, MeshFile &mesh)
{
  read_header(in);
  MeshFileBuilder builder{in, mesh};
  Cells           cells;
  bool            of_cells = false;
  while (!in.at_end())
    {
      const auto word = in.word();
      if (word == "POINTS" && mesh.points.empty())
        {
          const std::size_t n = in.count("points");
          in.word();
          for (std::size_t i = 0; i < n; ++i)
            mesh.points.push_back(builder.read_place());
        }
      else if (word == "CELLS" && cells.connections.empty())
        read_cells(in, cells);
      else if (word == "CELL_TYPES" && cells.types.empty())
        {
          const std::size_t n = in.count("types");
          for (std::size_t i = 0; i < n; ++i)
            cells.types.push_back(in.integer("type of an element"));
        }
      else if (word == "CELL_DATA" || word == "POINT_DATA")
        of_cells = (word == "CELL_DATA");
      else if (word == "SCALARS" && of_cells)
        read_scalars(in, cells);
    }
  put_together(in, cells, mesh);
}
} // namespace coracle::internal
