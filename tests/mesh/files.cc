// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of a file that do not fit together are refused with their lines, instead of being given
// to deal.II, which takes it for granted that they do; faces keep their ids, however elements are
// turned.
#include <coracle/mesh/mesh_generation.h>
#include <coracle/mesh/sheet_generation.h>

#include "mesh_sections.h"

#include <cstdio>
#include <map>

using namespace coracle;

namespace
{
const std::string
  head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
  plane =
    head + "$Nodes\n7\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n7 5 5 0\n$EndNodes\n",
  // Two cubes in a row, and a third point above them.
  space = head +
          "$Nodes\n13\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n"
          "9 0 0 2\n10 1 0 2\n11 1 1 2\n12 0 1 2\n13 5 5 5\n$EndNodes\n";

std::string
section(const std::string &type, const std::string &text)
{
  std::ofstream("case.msh") << text;
  return "set Type = " + type + "\nset File = case.msh";
}

/// Area of the facets of each id.
template <int dim>
void
taken(const std::string &title, const std::string &text)
{
  const auto                           mesh = mesh_from<dim>(section("file", text));
  std::map<unsigned int, unsigned int> n_facets;
  for (const auto &facet : mesh->facets)
    ++n_facets[facet.boundary_id];
  deallog << dim << "-D, " << title << ": elements " << mesh->n_global_elements() << ", nodes "
          << mesh->n_global_nodes() << ", volume " << facet_sums(*mesh).volume << ", facets";
  for (const auto &[id, n] : n_facets)
    deallog << ' ' << id << ": " << n;
  deallog << std::endl;
}

template <int dim>
void
refused(const std::string &title, const std::string &text)
{
  try
    {
      mesh_from<dim>(section("file", text));
      deallog << dim << "-D, " << title << ": taken" << std::endl;
    }
  catch (const UserError &error)
    {
      deallog << dim << "-D, " << title << ": " << error.title << " | "
              << error.found.substr(error.found.rfind('/') + 1) << std::endl;
    }
}

std::string
elements(const std::string &lines)
{
  return "$Elements\n" + std::to_string(std::count(lines.begin(), lines.end(), '\n')) + "\n" +
         lines + "$EndElements\n";
}

void
in_the_plane()
{
  const std::string left = "1 3 0 1 2 5 4\n", right = "2 3 0 2 3 6 5\n";
  taken<2>("ids",
           plane + elements("3 1 1 7 1 2\n4 1 1 7 3 2\n5 1 1 8 4 1\n6 1 1 0 2 5\n7 1 1 8 1 4\n" +
                            left + right));
  taken<2>("one turned over", plane + elements(left + "2 3 0 2 5 6 3\n"));
  refused<2>("no elements", plane + elements("1 1 1 7 1 2\n"));
  refused<2>("a triangle", plane + elements(left + "2 2 0 2 3 6\n"));
  refused<2>("without area", plane + elements("1 3 0 1 2 3 2\n"));
  refused<2>("on one line",
             head + "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 3 0 0\n$EndNodes\n" +
               elements("1 3 0 1 2 3 4\n"));
  refused<2>("a butterfly", plane + elements("1 3 0 1 2 4 5\n"));
  refused<2>("tiny",
             head +
               "$Nodes\n4\n1 0 0 0\n2 1e-200 0 0\n3 1e-200 1e-200 0\n4 0 1e-200 0\n$EndNodes\n" +
               elements("1 3 0 1 2 3 4\n"));
  refused<2>("the same twice", plane + elements(left + "2 3 0 2 5 4 1\n"));
  refused<2>("an arrow beside a square", plane + elements(left + "2 3 0 2 5 4 7\n"));
  refused<2>("three at an edge", plane + elements(left + right + "3 3 0 2 5 7 3\n"));
  refused<2>("an id inside", plane + elements(left + right + "3 1 1 7 2 5\n"));
  refused<2>("an id beside", plane + elements(left + "3 1 1 7 6 7\n"));
  refused<2>("two ids", plane + elements(left + "3 1 1 7 1 2\n4 1 1 8 2 1\n"));
}

void
in_space()
{
  const std::string low = "1 5 0 1 2 3 4 5 6 7 8\n", high = "2 5 0 5 6 7 8 9 10 11 12\n";
  taken<3>("ids",
           space + elements(low + high +
                            "3 3 1 7 1 2 3 4\n4 3 1 8 11 10 9 12\n5 1 1 9 1 2\n6 2 1 0 1 2 3\n"));
  taken<3>("one turned over", space + elements(low + "2 5 0 9 10 11 12 5 6 7 8\n"));
  refused<3>("a tetrahedron", space + elements(low + "2 4 0 9 10 11 12\n"));
  refused<3>("the same twice", space + elements(low + "2 5 0 2 3 4 1 6 7 8 5\n"));
  refused<3>("one in the other", space + elements(low + "2 5 0 1 2 3 4 9 10 11 12\n"));
  refused<3>("twisted", space + elements(low + "2 5 0 5 7 6 8 9 10 11 12\n"));
  refused<3>("a triangle with an id", space + elements(low + "3 2 1 7 1 2 3\n"));
  refused<3>("an id inside", space + elements(low + high + "3 3 1 7 5 6 7 8\n"));
  refused<3>("an id of a diagonal face", space + elements(low + high + "3 3 1 7 1 2 7 8\n"));
}

template <int dim>
void
sheet(const std::string &title, const std::string &text)
{
  try
    {
      Declaration declaration;
      declare_mesh(declaration.section("Mesh", "a mesh"), true);
      ParameterFile file(declaration);
      file.read_text("subsection Mesh\n" + section("surface file", text) + "\nend\n");
      const auto surface = generate_sheets<dim>(file.parameters().section("Mesh"));
      deallog << dim << "-D sheet, " << title << ": points " << surface.points.size() << ", facets "
              << surface.facets.size() << std::endl;
    }
  catch (const UserError &error)
    {
      deallog << dim << "-D sheet, " << title << ": " << error.title << " | "
              << error.found.substr(error.found.rfind('/') + 1) << std::endl;
    }
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  in_the_plane();
  in_space();
  sheet<2>("lines", plane + elements("1 1 0 1 2\n2 1 0 2 3\n3 15 0 4\n"));
  sheet<2>("a square", plane + elements("1 1 0 1 2\n2 3 0 2 3 6 5\n"));
  sheet<2>("nothing", plane + elements(""));
  sheet<3>("mixed", space + elements("1 3 0 1 2 3 4\n2 2 0 5 6 7\n3 1 0 9 10\n"));
  sheet<3>("a cube", space + elements("1 5 0 1 2 3 4 5 6 7 8\n"));
  std::remove("case.msh");
}
