// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets: lines that meet are joined into sheets with two faces and one orientation, whatever the
// order they are given in; their share of nodes and facets gives the same sums on any number of
// ranks, also where a rank has nothing; a Moebius strip is refused.
#include <coracle/mesh/mesh_generation.h>
#include <coracle/mesh/sheet_mesh.h>

#include <fstream>

#include "tests.h"

using namespace coracle;
namespace Mpi = dealii::Utilities::MPI;

template <int dim>
std::unique_ptr<SheetMesh<dim>>
sheet(const std::string &lines)
{
  Declaration declaration;
  declare_mesh(declaration.section("Mesh", "a mesh"), true);
  ParameterFile file(declaration);
  file.read_text("subsection Mesh\n" + lines + "\nend\n");
  return std::make_unique<SheetMesh<dim>>(file.parameters().section("Mesh"), MPI_COMM_WORLD);
}

/// Area vector of a flat facet.
template <int dim>
dealii::Tensor<1, dim>
area(const SheetMesh<dim> &mesh, const BoundaryFacet<dim> &facet)
{
  const auto x = [&](const int k) { return mesh.nodes[facet.nodes[k]]; };
  if constexpr (dim == 2)
    return dealii::Tensor<1, 2>({x(1)[1] - x(0)[1], x(0)[0] - x(1)[0]});
  else
    return 0.5 * dealii::cross_product_3d(x(2) - x(0), x(3) - x(1));
}

template <int dim>
void
report(const std::string &title, const std::string &lines)
{
  const auto mesh = sheet<dim>(lines);
  // Facets at each node, summed over ranks; its number, from its owner.
  Columns columns(2);
  columns.resize(mesh->n_nodes());
  std::vector<dealii::Tensor<1, dim>> of_sheet(mesh->n_sheets());
  double                              size = 0;
  std::uint64_t                       keys = 0;
  for (const auto &facet : mesh->facets)
    {
      for (const unsigned int n : facet.nodes)
        ++columns[0][n];
      of_sheet[facet.sheet] += area(*mesh, facet);
      size += area(*mesh, facet).norm();
      keys += facet.key;
    }
  mesh->exchange.sum_to_owners(columns, 0, 1);
  double weighted = 0;
  for (unsigned int n = 0; n < mesh->n_owned_nodes(); ++n)
    {
      weighted += columns[0][n] * mesh->nodes[n].norm_square();
      columns[1][n] = mesh->key(n);
    }
  mesh->exchange.update_ghosts(columns, 1, 1);
  bool right = mesh->n_cells() == mesh->facets.size();
  for (unsigned int n = 0; n < mesh->n_nodes(); ++n)
    right =
      right && columns[1][n] == double(mesh->key(n)) &&
      (mesh->owner(n) == int(Mpi::this_mpi_process(MPI_COMM_WORLD))) == (n < mesh->n_owned_nodes());
  deallog << title << ": nodes " << mesh->n_global_nodes() << ", facets "
          << mesh->n_global_elements() << " " << Mpi::sum(mesh->facets.size(), MPI_COMM_WORLD)
          << ", keys " << Mpi::sum(keys, MPI_COMM_WORLD) << ", weighted "
          << Mpi::sum(weighted, MPI_COMM_WORLD) << ", size " << Mpi::sum(size, MPI_COMM_WORLD)
          << ", ghosts right " << (Mpi::min(int(right), MPI_COMM_WORLD) == 1) << ", areas";
  for (const auto &sum : of_sheet)
    deallog << " (" << Mpi::sum(sum, MPI_COMM_WORLD) << ")";
  deallog << std::endl;
}

std::string
further(const std::string &points)
{
  return "subsection Further lines\n subsection more\n set Points = " + points + "\n end\nend\n";
}

const std::string polyline = "set Type = polyline\n set Points = ";

/// Half a turn over n pairs of triangles.
void
moebius_strip(const std::string &name, const unsigned int n)
{
  std::ofstream file(name);
  file << "# vtk DataFile Version 3.0\nstrip\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << 2 * n
       << " double\n";
  for (unsigned int i = 0; i < n; ++i)
    for (const double half : {-0.2, 0.2})
      {
        const double a = 2 * dealii::numbers::PI * i / n, r = 1 + half * std::cos(a / 2);
        file << r * std::cos(a) << ' ' << r * std::sin(a) << ' ' << half * std::sin(a / 2) << '\n';
      }
  file << "CELLS " << 2 * n << ' ' << 8 * n << '\n';
  for (unsigned int i = 0; i < n; ++i)
    {
      // The last one closes with its sides exchanged.
      const unsigned int a = 2 * i, b = 2 * ((i + 1) % n), swap = (i + 1 == n ? 1 : 0);
      const unsigned int next = b + swap, opposite = b + 1 - swap;
      file << "3 " << a << ' ' << next << ' ' << opposite << '\n'
           << "3 " << a << ' ' << opposite << ' ' << a + 1 << '\n';
    }
  file << "CELL_TYPES " << 2 * n << '\n';
  for (unsigned int i = 0; i < 2 * n; ++i)
    file << "5\n";
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  report<2>("line", polyline + "0, 0, 2, 0\n set Subdivisions = 5");
  report<2>("one facet", polyline + "0, 0, 2, 0\n set Rotation angle = 90 deg");
  // Drawn towards each other: one sheet.
  report<2>("two lines", polyline + "0, 0, 1, 0\n" + further("3, 0, 1, 0"));
  // Area vectors of a flange along x and a web along y; of two lines that cross.
  report<2>("T", polyline + "0, 0, 1, 0, 3, 0\n" + further("1, -2, 1, 0"));
  report<2>("T, web first", polyline + "1, -2, 1, 0, 3, 0\n" + further("0, 0, 1, 0"));
  // A web that ends in the middle of a facet divides it.
  report<2>("T, divided", polyline + "0, 0, 3, 0\n" + further("1, -2, 1, 0"));
  report<2>("cross", polyline + "0, 0, 1, 0, 1, 1\n" + further("2, 0, 1, 0, 1, -1"));
  report<2>("square", polyline + "0, 0, 1, 0, 1, 1, 0, 1, 0, 0\n set Subdivisions = 1, 2, 1, 2");
  deallog.pop();
  deallog.push("3d");
  report<3>("T",
            polyline + "0, 0, 1, 0, 3, 0\n set Subdivisions along z = 3\n set Length = 0.5\n" +
              further("1, -2, 1, 0"));
  if (Mpi::this_mpi_process(MPI_COMM_WORLD) == 0)
    moebius_strip("strip.vtk", 12);
  MPI_Barrier(MPI_COMM_WORLD);
  try
    {
      sheet<3>("set Type = surface file\n set File = strip.vtk");
    }
  catch (const UserError &error)
    {
      deallog << error.title << ": " << error.found.substr(0, error.found.find(';')) << std::endl;
    }
  deallog.pop();
}
