// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files of all formats give the same points, elements and ids; what is cut off, damaged or
// made to ask for all memory is refused in no time, with its line.
#include <coracle/base/mesh_file.h>

#include <cstdio>
#include <fstream>

#include "tests.h"

using namespace coracle;

namespace
{
std::string
write(const std::string &ending, const std::string &text)
{
  const std::string name = "mesh" + ending;
  std::ofstream(name, std::ios::binary) << text;
  return name;
}

/// Two squares and their lower boundary: sums that depend on each number.
void
report(const std::string &title, const std::string &ending, const std::string &text)
{
  const MeshFile mesh = read_mesh_file(write(ending, text));
  double         sum  = 0;
  unsigned int   ids  = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    {
      const auto &element = mesh.elements[e];
      ids += (MeshFile::dimension(element.kind) == 1 ? element.id : 0);
      for (unsigned int p = 0; p < MeshFile::n_points(element.kind); ++p)
        sum += (MeshFile::dimension(element.kind) + p) *
               (mesh.points[element.points[p]][0] + 10 * mesh.points[element.points[p]][1]);
    }
  deallog << title << ": points " << mesh.points.size() << ", elements " << mesh.elements.size()
          << ", sum " << sum << ", ids " << ids << std::endl;
}

void
refused(const std::string &title, const std::string &ending, const std::string &text)
{
  try
    {
      read_mesh_file(write(ending, text));
      deallog << title << ": taken" << std::endl;
    }
  catch (const FileError &error)
    {
      deallog << title << ": " << error.what() << std::endl;
    }
}

const std::string points = "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n",
                  msh2   = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
                  nodes2 = msh2 + "$Nodes\n6\n" + points + "$EndNodes\n",
                  msh4   = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
                  vtk    = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n",
                  places = "POINTS 6 double\n0 0 0 1 0 0 2 0 0\n0 1 0 1 1 0 2 1 0\n",
                  inp    = "*NODE\n1, 0, 0\n2, 1, 0\n3, 2, 0\n4, 0, 1\n5, 1, 1\n6, 2, 1\n";

void
right_ones()
{
  report("gmsh 1",
         ".msh",
         "$NOD\n6\n" + points +
           "$ENDNOD\n$ELM\n3\n1 1 7 0 2 1 2\n2 3 0 0 4 1 2 5 4\n"
           "3 3 0 0 4 2 3 6 5\n$ENDELM\n");
  report("gmsh 2",
         ".msh",
         nodes2 + "$Elements\n4\n9 15 1 0 1\n1 1 2 7 0 1 2\n2 3 0 1 2 5 4\n"
                  "3 3 1 0 2 3 6 5\n$EndElements\n$Periodic\n0\n$EndPeriodic\n");
  report("gmsh 4.0",
         ".msh",
         "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Entities\n0 1 0 0\n4 0 0 0 0 0 0 1 7 0\n"
         "$EndEntities\n$Nodes\n1 6\n1 2 0 6\n" +
           points +
           "$EndNodes\n$Elements\n2 3\n4 1 1 1\n1 1 2\n1 2 3 2\n2 1 2 5 4\n3 2 3 6 5\n"
           "$EndElements\n");
  report("gmsh 4.1",
         ".msh",
         msh4 + "$Entities\n0 1 0 0\n4 0 0 0 0 0 0 1 -7 0\n$EndEntities\n"
                "$Nodes\n2 6 1 6\n2 1 0 3\n1 2 3\n0 0 0\n1 0 0\n2 0 0\n2 2 1 3\n4 5 6\n"
                "0 1 0 .1 .2\n1 1 0 .1 .2\n2 1 0 .1 .2\n"
                "$EndNodes\n$Elements\n2 3 1 3\n1 4 1 1\n1 1 2\n2 1 3 2\n2 1 2 5 4\n3 2 3 6 5\n"
                "$EndElements\n");
  report(
    "VTK",
    ".vtk",
    vtk + places +
      "METADATA\nINFORMATION 0\n\nCELLS 3 13\n2 0 1\n4 0 1 4 3\n4 1 2 5 4\nCELL_TYPES 3\n3 9 9\n"
      "POINT_DATA 6\nSCALARS MaterialID int\nLOOKUP_TABLE default\n9 9 9 9 9 9\n"
      "CELL_DATA 3\nSCALARS MaterialID int 1\nLOOKUP_TABLE default\n7 0 0\n");
  report(
    "Abaqus",
    ".inp",
    "** of two parts\n" + inp +
      "*Element, type=CPS4, elset=A\n** between\n11, 1, 2,\n5, 4\n12, 2, 3, 6, 5\n"
      "*Elset, elset=first, generate\n11, 11, 1\n*Surface, type=ELEMENT, name=Side-7\nfirst, S1\n");
  report("UCD",
         ".inp",
         "# comment\n6 3 0 0 0\n" + points + "1 7 line 1 2\n2 1 quad 1 2 5 4\n3 1 quad 2 3 6 5\n");
  report("Windows", ".inp", "*NODE\r\n1, 0, 0\r\n2, 1, 0\r\n*ELEMENT, TYPE=T2D2\r\n1, 1, 2\r\n");
}

void
damaged_gmsh()
{
  refused("empty", ".msh", "");
  refused("no format", ".msh", "$Nodes\n");
  refused("binary", ".msh", "$MeshFormat\n2.2 1 8\n");
  refused("version", ".msh", "$MeshFormat\n3 0 8\n");
  refused("huge version", ".msh", "$MeshFormat\n4294967296 0 8\n");
  refused("names without end", ".msh", msh2 + "$PhysicalNames\n1\n");
  refused("no section", ".msh", msh2 + "6\n");
  refused("cut off", ".msh", msh2 + "$Nodes\n6\n1 0 0 0\n2 1");
  refused("too many points", ".msh", msh2 + "$Nodes\n4000000000\n1 0 0 0\n");
  refused("negative number", ".msh", msh2 + "$Nodes\n-1\n");
  refused("no number", ".msh", msh2 + "$Nodes\n1\n1 0 0 x\n");
  refused("infinite", ".msh", msh2 + "$Nodes\n1\n1 0 0 inf\n");
  refused("not a number", ".msh", msh2 + "$Nodes\n1\n1 0 nan 0\n");
  refused("too large", ".msh", msh2 + "$Nodes\n1\n1 0 1e101 0\n");
  refused("twice", ".msh", msh2 + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n");
  refused("no such point", ".msh", nodes2 + "$Elements\n1\n1 3 0 1 2 5 7\n");
  refused("point twice", ".msh", nodes2 + "$Elements\n1\n1 3 0 1 2 5 1\n$EndElements\n");
  refused("second order", ".msh", nodes2 + "$Elements\n1\n1 10 0 1 2 5 4\n");
  refused("too many tags", ".msh", nodes2 + "$Elements\n1\n1 3 4000000000 1 2 5 4\n");
  refused("too large a group", ".msh", nodes2 + "$Elements\n1\n1 3 1 4294967295 1 2 5 4\n");
  refused("dimension", ".msh", msh4 + "$Nodes\n0 0 0 0\n$EndNodes\n$Elements\n1 1 1 1\n-7 1 3 1\n");
  refused("blocks", ".msh", msh4 + "$Nodes\n99999 0 0 0\n");
  refused("two groups", ".msh", msh4 + "$Entities\n1 0 0 0\n1 0 0 0 2 1 2\n");
  refused("wrong end", ".msh", msh2 + "$Nodes\n0\n$EndElements\n");
}

void
damaged_vtk()
{
  refused("empty", ".vtk", "");
  refused("version 5", ".vtk", "# vtk DataFile Version 5.1\n");
  refused("binary", ".vtk", "# vtk DataFile Version 3.0\nt\nBINARY\n");
  refused("another data set", ".vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n");
  refused("too many points", ".vtk", vtk + "POINTS 4000000000 double\n");
  refused("cut off", ".vtk", vtk + places + "CELLS 1 5\n4 0 1");
  refused("no such point", ".vtk", vtk + places + "CELLS 1 5\n4 0 1 4 6\nCELL_TYPES 1\n9\n");
  refused("negative point", ".vtk", vtk + places + "CELLS 1 5\n4 0 1 4 -1\n");
  refused("too many corners", ".vtk", vtk + places + "CELLS 1 5\n400000 0 1 4 3\n");
  refused("wrong corners", ".vtk", vtk + places + "CELLS 1 4\n3 0 1 4\nCELL_TYPES 1\n9\n");
  refused("no types", ".vtk", vtk + places + "CELLS 1 5\n4 0 1 4 3\n");
  refused("fewer types",
          ".vtk",
          vtk + places + "CELLS 2 10\n4 0 1 4 3 4 1 2 5 4\nCELL_TYPES 1\n9\n");
  refused("ids cut off",
          ".vtk",
          vtk + places +
            "CELLS 1 5\n4 0 1 4 3\nCELL_TYPES 1\n9\n"
            "CELL_DATA 1\nSCALARS MaterialID int\nLOOKUP_TABLE default\n");
}

void
damaged_inp()
{
  const std::string one = inp + "*ELEMENT, TYPE=CPS4\n1, 1, 2, 5, 4\n";
  refused("two columns", ".inp", "*NODE\n1, 0\n");
  refused("no number", ".inp", "*NODE\nx, 0, 0\n");
  refused("infinite", ".inp", "*NODE\n1, 0, inf\n");
  refused("no such point", ".inp", inp + "*ELEMENT, TYPE=CPS4\n1, 1, 2, 5, 7\n");
  refused("second order", ".inp", inp + "*ELEMENT, TYPE=CPS8\n1, 1, 2, 5, 4, 3, 6, 1, 2\n");
  refused("element twice", ".inp", one + "1, 2, 3, 6, 5\n");
  refused("list without end", ".inp", inp + "*ELEMENT, TYPE=CPS4\n1, 1, 2, 5,\n");
  refused("no such element", ".inp", one + "*SURFACE, NAME=S1\n2, S1\n");
  refused("no such face", ".inp", one + "*SURFACE, NAME=S1\n1, S5\n");
  refused("no face", ".inp", one + "*SURFACE, NAME=S1\n1\n");
  refused("no increment", ".inp", one + "*ELSET, ELSET=A, GENERATE\n1, 2, 0\n");
  refused("negative elements",
          ".inp",
          one + "*ELSET, ELSET=A, GENERATE\n-9223372036854775808, 1, 1\n");
  refused("endless surface",
          ".inp",
          one + "*ELSET, ELSET=A, GENERATE\n1, 2000000000, 1\n*SURFACE, NAME=S1\n"
                "A, S1\nA, S1\nA, S1\nA, S1\nA, S1\nA, S1\nA, S1\n");
  refused("another file", ".inp", "*INCLUDE, INPUT=other.inp\n");
  refused("UCD cut off", ".inp", "6 1 0 0 0\n" + points);
  refused("UCD of too many", ".inp", "6 100000 0 0 0\n" + points);
  refused("UCD of another kind", ".inp", "6 1 0 0 0\n" + points + "1 1 prism 1 2 3 4 5 6\n");
}
} // namespace

int
main()
{
  initlog();
  right_ones();
  damaged_gmsh();
  damaged_vtk();
  damaged_inp();
  refused("another ending", ".stp", "");
  for (const char *const name : {"no_such_file.msh", "/dev/zero", "."})
    try
      {
        read_mesh_file(name);
      }
    catch (const FileError &error)
      {
        deallog << error.what() << std::endl;
      }
  for (const char *const ending : {".msh", ".vtk", ".inp", ".stp"})
    std::remove((std::string("mesh") + ending).c_str());
}
