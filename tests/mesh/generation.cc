// SPDX-License-Identifier: GPL-3.0-or-later
// Every generated or read mesh has the wanted number of elements, the exact or convergent volume,
// and a closed surface whose facets all point outwards, wherever it is moved.
#include "mesh_sections.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_out.h>

#include <cstdio>
#include <set>

using namespace coracle;

template <int dim>
void
report(const std::string &title, const std::string &lines, const double exact_volume)
{
  const auto              mesh = mesh_from<dim>(lines);
  const FacetSums<dim>    sums = facet_sums(*mesh);
  std::set<unsigned int>  ids;
  std::set<std::uint64_t> keys;
  for (const auto &facet : mesh->facets)
    {
      ids.insert(facet.boundary_id);
      keys.insert(facet.key);
    }
  deallog << dim << "-D " << title << ": elements " << mesh->n_global_elements() << ", nodes "
          << mesh->n_global_nodes() << ", facets " << mesh->facets.size() << ", unique keys "
          << (keys.size() == mesh->facets.size()) << ", ids";
  for (const unsigned int id : ids)
    deallog << ' ' << id;
  deallog << ", closed " << (sums.area.norm() < 1e-12) << ", volume error % "
          << std::round(1e4 * (sums.volume / exact_volume - 1)) / 1e2 + 0. << std::endl;
}

template <int dim>
void
refused(const std::string &lines)
{
  try
    {
      mesh_from<dim>(lines);
      deallog << "accepted" << std::endl;
    }
  catch (const UserError &e)
    {
      deallog << "refused: " << e.title << " | " << e.found.substr(e.found.rfind('/') + 1)
              << std::endl;
    }
}

/// Write a distorted square or cube of 2^dim elements in a format and read it again.
template <int dim>
void
read_back(const std::string &ending)
{
  dealii::Triangulation<dim> triangulation;
  dealii::GridGenerator::subdivided_hyper_cube(triangulation, 2);
  const std::string name = "square." + ending;
  {
    std::ofstream   file(name);
    dealii::GridOut out;
    if (ending == "msh")
      {
        out.set_flags(dealii::GridOutFlags::Msh(true));
        out.write_msh(triangulation, file);
      }
    else if (ending == "vtk")
      out.write_vtk(triangulation, file);
    else
      {
        file << "*HEADING\n*NODE\n";
        for (unsigned int v = 0; v < triangulation.n_vertices(); ++v)
          {
            file << v + 1;
            for (int d = 0; d < 3; ++d)
              file << ", " << (d < dim ? triangulation.get_vertices()[v][d] : 0.);
            file << '\n';
          }
        file << (dim == 2 ? "*ELEMENT, TYPE=S4R, ELSET=EB1\n"
                          : "*ELEMENT, TYPE=C3D8R, ELSET=EB1\n");
        for (const auto &cell : triangulation.active_cell_iterators())
          {
            file << cell->index() + 1;
            for (const unsigned int v : cell->vertex_indices())
              file << ", " << cell->vertex_index(dealii::GeometryInfo<dim>::ucd_to_deal[v]) + 1;
            file << '\n';
          }
      }
  }
  report<dim>(ending,
              "set Type = file\nset File = " + name + "\nset Scale = 2",
              dim == 2 ? 4. : 8.);
  std::remove(name.c_str());
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  const std::string placed =
    "\nset Rotation angle = 30 deg\nset Rotation axis = 1, 2, 3\nset Position = 1, -2";
  const double pi = dealii::numbers::PI;

  report<2>("box", "set Subdivisions = 3, 5" + placed, 1.);
  report<3>("box", "set Subdivisions = 2, 3, 4" + placed + ", 3", 1.);
  for (const char *n : {"5, 9, 9", "4", "1"})
    report<2>(std::string("wedge ") + n,
              std::string("set Type = wedge\nset Subdivisions = ") + n + placed,
              0.25 * 0.25 * std::tan(pi / 6));
  report<3>("wedge",
            "set Type = wedge\nset Subdivisions = 2\nset Length = 2\nset Subdivisions along z = 3",
            2 * 0.25 * 0.25 * std::tan(pi / 6));
  report<2>("clockwise polygon", "set Type = polygon\nset Corners = 0,0, 0,1, 2,1, 2,0", 2.);
  report<2>("L, not convex",
            "set Type = polygon\nset Corners = 0,0, 2,0, 2,1, 1,1, 1,2, 0,2\nset Subdivisions = 2",
            3.);
  report<3>(
    "L, not convex",
    "set Type = polygon\nset Corners = 0,0, 2,0, 2,1, 1,1, 1,2, 0,2\nset Subdivisions along z = 2",
    3.);
  for (const char *n : {"1", "2", "3"})
    {
      report<2>("ball", std::string("set Type = ball\nset Refinements = ") + n + placed, pi);
      report<3>("ball", std::string("set Type = ball\nset Refinements = ") + n, 4. / 3. * pi);
    }
  report<3>("cylinder",
            "set Type = cylinder\nset Refinements = 2\nset Subdivisions along axis = 2",
            pi);
  report<2>("plate", "set Type = plate with hole\nset Refinements = 2", 4 - pi / 16);
  report<3>("plate", "set Type = plate with hole\nset Refinements = 2", 0.1 * (4 - pi / 16));
  report<2>("box, locally refined",
            "set Subdivisions = 4\nset Refined region = 0, 0, 0.5, 0.5",
            1.);
  for (const char *ending : {"msh", "vtk", "inp"})
    {
      read_back<2>(ending);
      read_back<3>(ending);
    }

  refused<2>("set Type = cylinder");
  refused<2>("set Type = polygon\nset Corners = 0,0, 1,1, 1,0, 0,1");
  refused<2>("set Type = polygon\nset Corners = 0,0, 1,1");
  refused<2>("set Subdivisions = 1.5");
  refused<3>("set Upper corner = 1, 1");
  {
    std::ofstream file("triangle.vtk");
    file
      << "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n0 0 0\n"
         "1 0 0\n0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
  }
  refused<2>("set Type = file\nset File = triangle.vtk");
  std::remove("triangle.vtk");
}
