// SPDX-License-Identifier: GPL-3.0-or-later
// A short cantilever, nearly incompressible, under a tip load: with full integration (F-bar) a
// coarse mesh comes near the Timoshenko beam and a finer one nearer, so that nothing locks; one
// point does with its hourglass control, and without it the same mesh is much too soft or collapses
// into hourglasses.
#include "bodies.h"

using namespace coracle;

namespace
{
constexpr double length = 4, young = 1e6, poisson = 0.499, density = 1000, load = 100;

/// Deflection of the tip at rest, found by damping, over that of the beam.
double
relative_deflection(const std::string &integration, const int n, const std::string &more = "")
{
  const double plane = young / (1 - poisson * poisson), shear = young / (2 * (1 + poisson));
  const double exact =
    load * length * length * length / (3 * plane / 12) + load * length / (5. / 6. * shear);
  const double   frequency = 3.516 / (length * length) * std::sqrt(plane / 12 / density);
  const BodyCase body_case(
    "subsection Materials\n subsection m\n set Model = neo-Hookean\n set Density = " +
      std::to_string(density) + "\n set Young modulus = " + std::to_string(young) +
      "\n set Poisson ratio = " + std::to_string(poisson) +
      "\n end\nend\nsubsection Bodies\n subsection body\n set Material = m\n set Integration = " +
      integration + "\n" + more +
      "\n subsection Mesh\n set Upper corner = " + std::to_string(length) +
      ", 1\n set Subdivisions = " + std::to_string(int(length) * n / 2) + ", " + std::to_string(n) +
      "\n end\n subsection Boundary conditions\n subsection wall\n set Boundary id = 0\n end\n "
      "end\n"
      " subsection Loads\n subsection tip\n set Type = traction\n set Boundary id = 1\n"
      " set Traction = 0; -" +
      std::to_string(load) + "\n end\n end\n subsection Damping\n set Coefficient = " +
      std::to_string(1.6 * frequency) + "\n end\n end\nend\n",
    2);
  const auto   body = body_case.solid<2>();
  const double end  = 9 / frequency;
  double       time = 0;
  while (time < end)
    {
      const double dt = 0.9 * stable_step(*body);
      step(*body, time, dt);
      time += dt;
    }
  double deflection = 0;
  for (unsigned int i = 0; i < body->mesh().n_nodes(); ++i)
    deflection = std::max(deflection, -body->displacement(i)[1]);
  return deflection / exact;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  const double coarse = relative_deflection("full", 4), fine = relative_deflection("full", 8),
               finest = relative_deflection("full", 16);
  const double one    = relative_deflection("one point", 8, "set Hourglass coefficient = 1"),
               less   = relative_deflection("one point", 8, "set Hourglass coefficient = 0.1"),
               none   = relative_deflection("one point", 2, "set Hourglass coefficient = 0.01");
  deallog << "full, 16 elements high, within 5 % of the beam: " << (std::fabs(finest - 1) < 0.05)
          << std::endl
          << "4 high within 6 % of that: " << (std::fabs(coarse / finest - 1) < 0.06) << std::endl
          << "8 high within 2 %: " << (std::fabs(fine / finest - 1) < 0.02) << std::endl
          << "one point, 8 high within 3 %: " << (std::fabs(one / finest - 1) < 0.03) << std::endl
          << "softer with less hourglass control: " << (less > one) << std::endl
          << "2 high and nearly without: more than 20 % too soft: " << (none > 1.2 * finest)
          << std::endl;
}
