// SPDX-License-Identifier: GPL-3.0-or-later
// Each model can be chosen by its name and reads its entries; viscosity chooses the variant; a
// wrong name is answered with the nearest and all others.
#include "../tests.h"
#include "models.h"

using namespace coracle;

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();

  Declaration root;
  MaterialLibrary::declare(root);
  Declaration &bodies = root.named_sections("Bodies", "body", "All bodies");
  bodies.text("Material", "", "A name in Materials");

  ParameterFile file(root);
  file.read_text("subsection Materials\n"
                 "subsection water\n set Sound speed = 100 m/s\n end\n"
                 "subsection honey\n set Model = Tait\n set Viscosity = 10 Pa s\n set Density = "
                 "1.4 g/cm^3\n end\n"
                 "subsection steel\n set Model = linear elastic\n end\n"
                 "subsection rubber\n set Model = neo-Hookean\n set Young modulus = 1 MPa\n"
                 " set Poisson ratio = 0\n set Density = 1000\n end\n"
                 "end\n"
                 "subsection Bodies\n subsection pool\n set Material = watter\n end\n subsection "
                 "thing\n end\nend\n");
  const Parameters      parameters = file.parameters();
  const MaterialLibrary library(parameters);
  const Parameters      pool = parameters.section("Bodies").section("pool");

  for (const std::string name : {"water", "honey", "steel", "rubber"})
    std::visit(
      [&](const auto &model) {
        using Model        = std::decay_t<decltype(model)>;
        const double rho_0 = model.reference_density();
        deallog << name << ": " << Model::name << ", pressure only " << Model::isotropic_stress
                << ", needs F " << Model::needs_deformation_gradient << ", density " << rho_0
                << ", sound speed " << model.sound_speed(rho_0) << ", diffusivity "
                << model.diffusivity() << std::endl;
      },
      library.get(name, pool));

  const auto report = [&](const std::string &name, const Parameters &asker) {
    try
      {
        library.get(name, asker);
      }
    catch (const UserError &error)
      {
        deallog << error.title << "; " << error.where << "; " << error.found << "; " << error.cure
                << std::endl;
      }
  };
  report("watter", pool);
  report("", parameters.section("Bodies").section("thing"));
}
