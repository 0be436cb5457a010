// SPDX-License-Identifier: GPL-3.0-or-later
// A slender cantilever under a dead tip load comes to rest within 1 % of the elastica, whose tip
// for P L^2 / (E I) = 1 and 5 is at w/L = 0.301721, 0.713792 and u/L = 0.0564332, 0.387628
// (elliptic integrals, Bisshopp & Drucker 1945).
#include "bodies.h"

using namespace coracle;

namespace
{
constexpr double height = 0.05, young = 1e6, density = 1000;

void
test(const double load, const double w, const double u)
{
  const double inertia = height * height * height / 12;
  // Small vibrations; a bent beam is stiffer.
  const double frequency = 3.516 * std::sqrt(young * inertia / (density * height)),
               traction  = load * young * inertia / height;
  const BodyCase body_case(
    "subsection Materials\n subsection m\n set Model = neo-Hookean\n set Density = 1000\n set "
    "Young modulus = "
    "1e6\n set Poisson ratio = 0\n end\nend\nsubsection Bodies\n subsection body\n set Material = "
    "m\n"
    " subsection Mesh\n set Upper corner = 1, " +
      std::to_string(height) +
      "\n set Subdivisions = 120, 6\n end\n subsection Boundary conditions\n subsection wall\n"
      " set Boundary id = 0\n end\n end\n subsection Loads\n subsection tip\n set Type = traction\n"
      " set Boundary id = 1\n set Traction = 0; -" +
      std::to_string(traction) + "*min(1, t*" + std::to_string(frequency / 6) +
      ")\n end\n end\n subsection Damping\n set Coefficient = " + std::to_string(1.5 * frequency) +
      "\n end\n end\nend\n",
    2);
  const auto body = body_case.solid<2>();
  double     time = 0;
  while (time < 18 / frequency)
    {
      const double dt = 0.9 * stable_step(*body);
      step(*body, time, dt);
      time += dt;
    }
  dealii::Tensor<1, 2> tip;
  for (unsigned int n = 0; n < body->mesh().n_nodes(); ++n)
    if (body->mesh().nodes[n][0] > 1 - 1e-12)
      tip += body->displacement(n) / 7.;
  const auto energies = body->energies();
  deallog << "P L^2 / (E I) = " << load << ": w within 1 % " << std::boolalpha
          << (std::abs(-tip[1] / w - 1) < 0.01) << ", u within 2 % "
          << (std::abs(-tip[0] / u - 1) < 0.02) << ", at rest "
          << (energies.kinetic < 1e-4 * energies.strain) << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  test(1, 0.301721, 0.0564332);
  test(5, 0.713792, 0.387628);
}
