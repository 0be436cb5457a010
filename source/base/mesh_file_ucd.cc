// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_file_builder.h"

namespace coracle::internal
{
namespace
{
MeshFile::Kind
kind_of(TextScanner &in)
{
  using Kind      = MeshFile::Kind;
  const auto word = in.word();
  if (word == "line")
    return Kind::line;
  if (word == "tri")
    return Kind::triangle;
  if (word == "quad")
    return Kind::quadrilateral;
  if (word == "tet")
    return Kind::tetrahedron;
  if (word == "hex")
    return Kind::hexahedron;
  in.fail("an element that is none of line, tri, quad, tet, hex");
}
} // namespace

// Comments; numbers of points and elements, and of three kinds of data, which are left out;
// number x y z; number material kind points...
void
read_ucd(TextScanner &in, MeshFile &mesh)
{
  while (in.begins_with('#'))
    in.rest_of_line();
  MeshFileBuilder   builder{in, mesh};
  const std::size_t n_points = in.count("points"), n_elements = in.count("elements");
  for (int i = 0; i < 3; ++i)
    in.integer("number of data");
  for (std::size_t i = 0; i < n_points; ++i)
    {
      const auto number = in.integer("number of a point");
      builder.add_point(number, builder.read_place());
    }
  for (std::size_t i = 0; i < n_elements; ++i)
    {
      in.integer("number of an element");
      const unsigned int id = in.natural("material");
      builder.read_element(kind_of(in), id);
    }
}
} // namespace coracle::internal
