// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever a mesh file (of the ending FORMAT) holds, a structure, a sheet and a filled surface are
// made from it or refused with an error that names the file, in two and three dimensions.

#include <coracle/base/text_scanner.h>
#include <coracle/mesh/mesh_generation.h>
#include <coracle/mesh/sheet_mesh.h>
#include <coracle/mesh/structure_mesh.h>
#include <coracle/particles/shape_surface.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "target.h"

namespace
{
using namespace coracle;

const std::string file_name = fuzz::place() + "/mesh." FORMAT;

/// The section of a body that is read from the file.
class Case
{
public:
  Case(const std::string &type)
  {
    declare_mesh(declaration.section("Mesh", "a mesh"), true);
    file = std::make_unique<ParameterFile>(declaration);
    file->read_text("subsection Mesh\nset Type = " + type + "\nset File = " + file_name +
                    "\nend\n");
  }
  Parameters section() const { return file->parameters().section("Mesh"); }

private:
  Declaration                    declaration;
  std::unique_ptr<ParameterFile> file;
};

template <typename Function>
void
refused_or(const Function &function)
{
  try
    {
      function();
    }
  catch (const UserError &error)
    {
      if (error.title.empty() || error.where.empty() || error.found.empty() || error.cure.empty())
        {
          std::cerr << "refused, but not by name: " << error.what() << std::endl;
          std::abort();
        }
    }
}

void
must(const bool good)
{
  if (!good)
    std::abort();
}

template <int dim>
void
read()
{
  static const Case solid("file"), sheet("surface file");
  refused_or([&] {
    StructureMesh<dim> mesh(solid.section(), MPI_COMM_SELF);
    must(mesh.n_elements() > 0 && mesh.facets.size() > 0);
    for (const auto &node : mesh.nodes)
      must(std::isfinite(node.norm()));
    mesh.triangulation.refine_global(1);
  });
  refused_or([&] {
    SheetMesh<dim> mesh(sheet.section(), MPI_COMM_SELF);
    must(mesh.n_global_elements() > 0 && mesh.n_sheets() > 0);
  });
  try
    {
      for (const auto &facet : read_facets<dim>(file_name))
        for (const auto &vertex : facet)
          must(std::isfinite(vertex.norm()));
    }
  catch (const FileError &)
    {}
}
} // namespace

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  fuzz::start();
  fuzz::write(file_name, data, size);
  read<2>();
  read<3>();
  return 0;
}
