// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mesh_file.h>
#include <coracle/particles/shape_surface.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace coracle
{
namespace
{
std::string
suffix_of(const std::string &file_name)
{
  return file_name.substr(std::min(file_name.rfind('.'), file_name.size()));
}

/// STL, binary: 80 bytes of title, number of triangles, 50 bytes each: normal, three corners, two
/// spare bytes.
FacetSoup<3>
read_binary_stl(const std::string &bytes)
{
  FacetSoup<3> facets;
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50)
    {
      float corners[9];
      std::memcpy(corners, bytes.data() + at + 12, sizeof(corners));
      facets.emplace_back();
      for (int v = 0; v < 3; ++v)
        facets.back()[v] = {corners[3 * v], corners[3 * v + 1], corners[3 * v + 2]};
    }
  return facets;
}

FacetSoup<3>
read_text_stl(const std::string &file_name)
{
  FacetSoup<3> facets;
  TextScanner  in(file_name);
  unsigned int n_vertices = 0;
  while (!in.at_end())
    if (in.word() == "vertex")
      {
        if (n_vertices % 3 == 0)
          facets.emplace_back();
        for (int d = 0; d < 3; ++d)
          facets.back()[n_vertices % 3][d] = in.real("coordinate");
        ++n_vertices;
      }
  if (n_vertices % 3 != 0)
    in.fail("the last triangle is incomplete");
  return facets;
}

FacetSoup<3>
read_stl(const std::string &file_name)
{
  const std::string bytes = read_whole_file(file_name);
  // A binary title may begin with "solid" as text files do: only the size tells them apart.
  std::uint32_t n_triangles = 0;
  if (bytes.size() >= 84)
    std::memcpy(&n_triangles, bytes.data() + 80, sizeof(n_triangles));
  const bool binary = bytes.size() >= 84 && bytes.size() == 84 + 50 * std::size_t(n_triangles);
  return binary ? read_binary_stl(bytes) : read_text_stl(file_name);
}

template <int dim>
FacetSoup<dim>
read_mesh(const std::string &file_name)
{
  const MeshFile mesh = read_mesh_file(file_name);
  FacetSoup<dim> facets;
  for (const MeshFile::Element &element : mesh.elements)
    {
      const auto point = [&](const unsigned int k) {
        dealii::Point<dim> p;
        for (int d = 0; d < dim; ++d)
          p[d] = mesh.points[element.points[k]][d];
        return p;
      };
      if (MeshFile::dimension(element.kind) >= dim)
        mesh.fail(element, dim == 2 ? "no line, but an area or a volume" : "a volume");
      if (MeshFile::dimension(element.kind) + 1 < dim)
        continue;
      if constexpr (dim == 2)
        facets.push_back({{point(0), point(1)}});
      else
        {
          facets.push_back({{point(0), point(1), point(2)}});
          if (element.kind == MeshFile::Kind::quadrilateral)
            facets.push_back({{point(0), point(2), point(3)}});
        }
    }
  return facets;
}

template <int dim>
FacetSoup<dim>
read_any(const std::string &file_name)
{
  const std::string suffix = suffix_of(file_name);
  if (suffix == ".stl" || suffix == ".STL")
    {
      if constexpr (dim == 3)
        return read_stl(file_name);
      throw FileError(file_name +
                      ": STL files hold triangles in space; a 2-D case needs a mesh of lines");
    }
  return read_mesh<dim>(file_name);
}
} // namespace

template <int dim>
FacetSoup<dim>
read_facets(const std::string &file_name)
{
  const auto facets = read_any<dim>(file_name);
  for (const auto &facet : facets)
    for (const auto &vertex : facet)
      for (int d = 0; d < dim; ++d)
        if (!std::isfinite(vertex[d]))
          throw FileError(file_name + ": a coordinate is not a finite number");
  return facets;
}
template FacetSoup<2> read_facets<2>(const std::string &);
template FacetSoup<3> read_facets<3>(const std::string &);
} // namespace coracle
