// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_file_builder.h"

#include <algorithm>

namespace coracle
{
unsigned int
MeshFile::n_points(const Kind kind)
{
  switch (kind)
    {
      case Kind::line:
        return 2;
      case Kind::triangle:
        return 3;
      case Kind::quadrilateral:
      case Kind::tetrahedron:
        return 4;
      case Kind::hexahedron:
        return 8;
      default:
        return 0;
    }
}

unsigned int
MeshFile::dimension(const Kind kind)
{
  switch (kind)
    {
      case Kind::line:
        return 1;
      case Kind::triangle:
      case Kind::quadrilateral:
        return 2;
      default:
        return 3;
    }
}

void
MeshFile::fail(const Element &element, const std::string &reason) const
{
  throw FileError(name + ", line " + std::to_string(element.line) + ": " + reason);
}

namespace internal
{
void
MeshFileBuilder::add_point(const std::int64_t number, const dealii::Point<3> &place)
{
  if (!index_of_number.emplace(number, mesh.points.size()).second)
    in.fail("there is another point with the number " + std::to_string(number));
  mesh.points.push_back(place);
}

dealii::Point<3>
MeshFileBuilder::read_place()
{
  dealii::Point<3> place;
  for (int d = 0; d < 3; ++d)
    place[d] = in.real("coordinate");
  return place;
}

unsigned int
MeshFileBuilder::index(const std::int64_t number) const
{
  const auto found = index_of_number.find(number);
  if (found == index_of_number.end())
    in.fail("there is no point with the number " + std::to_string(number));
  return found->second;
}

void
MeshFileBuilder::read_element(const MeshFile::Kind kind, const unsigned int id)
{
  MeshFile::Element element{kind, {}, id, in.line()};
  for (unsigned int i = 0; i < MeshFile::n_points(kind); ++i)
    element.points[i] = index(in.integer("number of a point"));
  mesh.elements.push_back(element);
}
} // namespace internal

MeshFile
read_mesh_file(const std::string &file_name)
{
  const std::string ending = file_name.substr(std::min(file_name.rfind('.'), file_name.size()));
  TextScanner       in(file_name);
  MeshFile          mesh;
  mesh.name = file_name;
  if (ending == ".msh")
    internal::read_gmsh(in, mesh);
  else if (ending == ".vtk")
    internal::read_vtk(in, mesh);
  else if (ending == ".ucd" || (ending == ".inp" && !in.begins_with('*')))
    internal::read_ucd(in, mesh);
  else if (ending == ".inp")
    internal::read_abaqus(in, mesh);
  else
    throw FileError(file_name + ": the end of its name is none of .msh, .vtk, .inp, .ucd");

  for (const MeshFile::Element &element : mesh.elements)
    for (unsigned int p = 0; p < MeshFile::n_points(element.kind); ++p)
      for (unsigned int q = 0; q < p; ++q)
        if (element.points[p] == element.points[q])
          mesh.fail(element, "an element has a point twice");
  return mesh;
}
} // namespace coracle
