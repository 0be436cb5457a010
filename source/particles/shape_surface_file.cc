// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape_surface.h>

#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

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
read_text_stl(const std::string &bytes)
{
  FacetSoup<3>       facets;
  std::istringstream in(bytes);
  std::string        word;
  unsigned int       n_vertices = 0;
  while (in >> word)
    if (word == "vertex")
      {
        double x, y, z;
        if (!(in >> x >> y >> z))
          throw std::runtime_error("a number is missing after vertex " +
                                   std::to_string(n_vertices));
        if (n_vertices % 3 == 0)
          facets.emplace_back();
        facets.back()[n_vertices % 3] = {x, y, z};
        ++n_vertices;
      }
  if (n_vertices % 3 != 0)
    throw std::runtime_error("the last triangle is incomplete");
  return facets;
}

FacetSoup<3>
read_stl(const std::string &file_name)
{
  std::ifstream     file(file_name, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  // A binary title may begin with "solid" as text files do: only the size tells them apart.
  std::uint32_t n_triangles = 0;
  if (bytes.size() >= 84)
    std::memcpy(&n_triangles, bytes.data() + 80, sizeof(n_triangles));
  const bool binary = bytes.size() >= 84 && bytes.size() == 84 + 50 * std::size_t(n_triangles);
  return binary ? read_binary_stl(bytes) : read_text_stl(bytes);
}

template <int dim>
FacetSoup<dim>
read_mesh(const std::string &file_name)
{
  dealii::Triangulation<dim - 1, dim> mesh;
  dealii::GridIn<dim - 1, dim>        reader(mesh);
  // Abaqus and UCD share a suffix; only Abaqus files begin with a keyword.
  std::ifstream file(file_name);
  if (dim == 3 && suffix_of(file_name) == ".inp" && (file >> std::ws).peek() == '*')
    reader.read_abaqus(file);
  else
    reader.read(file_name);

  FacetSoup<dim> facets;
  for (const auto &cell : mesh.active_cell_iterators())
    if constexpr (dim == 2)
      facets.push_back({{cell->vertex(0), cell->vertex(1)}});
    else
      {
        // Around a quadrilateral deal.II's corners are 0, 1, 3, 2.
        facets.push_back(
          {{cell->vertex(0), cell->vertex(1), cell->vertex(cell->n_vertices() == 4 ? 3 : 2)}});
        if (cell->n_vertices() == 4)
          facets.push_back({{cell->vertex(0), cell->vertex(3), cell->vertex(2)}});
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
      throw std::runtime_error(
        "STL files hold triangles in space; a 2-D case needs a mesh of lines");
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
          throw std::runtime_error("a coordinate is not a finite number");
  return facets;
}
template FacetSoup<2> read_facets<2>(const std::string &);
template FacetSoup<3> read_facets<3>(const std::string &);
} // namespace coracle
