// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes are read from a parameter file, and each mistake in one is refused with what was found.
#include <coracle/particles/generate.h>

#include "../tests.h"

using namespace coracle;
using dealii::Point;

/// One body with these lines, filled with particles everywhere; prints how many or the error.
template <int dim>
void
test(const std::string &lines)
{
  Declaration  root;
  Declaration &body = root.named_sections("Bodies", "body", "All bodies");
  body.choice("Kind", "material points", {"material points", "rigid"}, "What it is");
  GenerationSettings::declare(body.when("Kind", "material points"));
  ParameterFile file(root);
  try
    {
      file.read_text("subsection Bodies\n subsection water\n" + lines + " end\nend\n");
      const Parameters         water = file.parameters().section("Bodies").section("water");
      dealii::BoundingBox<dim> everywhere;
      everywhere.extend(9.);
      const auto particles = generate_particles<dim>(
        water, [](const Point<dim> &) { return true; }, everywhere, MPI_COMM_SELF);
      deallog << "particles " << particles.n_total << ", volume "
              << particles.n_total * particles.volume << std::endl;
    }
  catch (const UserError &error)
    {
      // Files are named with their folder, which differs between machines.
      const std::size_t name = error.found.rfind('/') + 1;
      deallog << "error: " << error.title << "; " << error.where << "; " << error.found.substr(name)
              << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();

  test<2>("set Upper corner = 2 m, 1 m\n set Particle spacing = 50 mm\n");
  test<3>("set Lower corner = 0, 0, -10 cm\n set Upper corner = 2, 1, 0.1\n set Particle spacing = "
          "5 cm\n");
  test<2>(
    "set Shape = ball\n set Centre = 1, 1\n set Radius = 20 cm\n set Particle spacing = 1 cm\n");
  test<2>("set Shape = polygon\n set Vertices = 0, 0, 1, 0, 1, 2\n set Particle spacing = 10 cm\n");
  test<3>("set Shape = polygon\n set Vertices = 0, 0, 1, 0, 1, 1\n set Height range = 0, 1\n set "
          "Particle spacing = 0.1\n");
  test<2>("set Shape = indicator\n set Indicator = 0.5 - x*y\n set Upper corner = 1, 1\n set "
          "Particle spacing = "
          "0.125\n");

  test<2>("set Upper corner = 2, 0\n");
  test<2>("set Upper corner = 2, 1, 3\n");
  test<2>("set Upper corner = 2 m, 1 mm\n set Particle spacing = 10 mm\n");
  test<2>("set Shape = polygon\n set Vertices = 0, 0, 1, 0, 1\n");
  test<2>("set Shape = polygon\n set Vertices = 0, 0, 1, 1, 1, 0, 0, 1\n");
  test<2>("set Shape = polygon\n set Vertices = 0, 0, 1, 1, 2, 2\n");
  test<2>("set Shape = polygon\n set Vertices = 0, 0, 1, 0, 1, 1\n set Height range = 0, 1\n");
  test<3>("set Shape = polygon\n set Vertices = 0, 0, 1, 0, 1, 1\n");
  test<2>("set Shape = indicator\n set Indicator = -1\n set Upper corner = 1, 1\n");
  test<2>("set Shape = ball\n set Upper corner = 1, 1\n");

  std::ofstream("open.stl") << "solid\n vertex 0 0 0 vertex 1 0 0 vertex 0 1 0\nendsolid\n";
  std::ofstream("broken.stl") << "solid\n vertex 0 0 0 vertex 1 0 0 vertex 0 1\nendsolid\n";
  std::ofstream("empty.vtk") << "nothing\n";
  test<3>("set Shape = surface mesh\n set Surface file = open.stl\n");
  test<3>("set Shape = surface mesh\n set Surface file = broken.stl\n");
  test<3>("set Shape = surface mesh\n set Surface file = empty.vtk\n");
}
