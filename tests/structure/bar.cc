// SPDX-License-Identifier: GPL-3.0-or-later
// Waves in an elastic bar (Poisson ratio 0). An end that is pulled at a speed v sends a stress rho
// c v along the bar at the speed c; a bar that hits a wall at v presses with rho c v for the time
// 2L/c; energies balance.
#include "bodies.h"

using namespace coracle;

namespace
{
constexpr double speed = 100, density = 1000, young = density * speed * speed, velocity = 0.1;

std::string
text(const std::string &integration, const std::string &more, const std::string &condition)
{
  return "subsection Materials\n subsection m\n set Model = linear elastic\n set Density = 1000\n "
         "set "
         "Young modulus = " +
         std::to_string(young) +
         "\n set Poisson ratio = 0\n end\nend\nsubsection Bodies\n subsection body\n set Material "
         "= m\n"
         " set Integration = " +
         integration + "\n" + more +
         "\n subsection Mesh\n set Upper corner = 1, 0.01, 0.01\n set Subdivisions = 100, 1, 1\n "
         "end\n"
         " subsection Boundary conditions\n subsection end\n set Boundary id = 0\n" +
         condition + "\n end\n end\n end\nend\n";
}

/// Mean stress between the end and half the distance the wave has gone.
void
pulled_end(const std::string &integration)
{
  const BodyCase body_case(
    text(integration, "", "set Type = velocity\nset Directions = x\nset Velocity = -0.1; 0; 0"), 3);
  const auto body = body_case.solid<3>();
  double     time = 0;
  while (time < 0.6 / speed)
    {
      const double dt = 0.8 * stable_step(*body);
      step(*body, time, dt);
      time += dt;
    }
  double       behind = 0, ahead = 0;
  unsigned int n_behind = 0;
  for (unsigned int e = 0; e < body->mesh().n_elements(); ++e)
    {
      const double x = body->mesh().nodes[body->mesh().elements[e][0]][0];
      if (x < 0.3)
        {
          behind += body->stress(e)[0];
          ++n_behind;
        }
      if (x > 0.7)
        ahead = std::max(ahead, std::fabs(body->stress(e)[0]));
    }
  const double   exact  = density * speed * velocity;
  const Energies energy = body->energies();
  deallog << integration << ", pulled: stress within 1 % "
          << (std::fabs(behind / n_behind / exact - 1) < 0.01) << ", none ahead of the wave "
          << (ahead < 0.01 * exact) << ", energy balances "
          << (std::fabs(energy.kinetic + energy.strain + energy.hourglass - energy.external_work) <
              1e-12 * energy.external_work)
          << ", half of it kinetic "
          << (std::fabs(energy.kinetic / energy.external_work - 0.5) < 0.02) << std::endl;
}

/// Force on the wall in time: internal force of its nodes.
void
impact(const std::string &integration)
{
  const BodyCase body_case(
    text(integration, "set Initial velocity = -0.1, 0, 0", "set Type = symmetric"), 3);
  const auto     body  = body_case.solid<3>();
  const Energies start = body->energies();
  double         time = 0, impulse = 0, last = 0, end = 0;
  while (time < 2.5 / speed)
    {
      const double dt = 0.8 * stable_step(*body);
      step(*body, time, dt);
      time += dt;
      double force = 0;
      for (unsigned int n = 0; n < body->mesh().n_nodes(); ++n)
        if (body->mesh().nodes[n][0] == 0)
          force -= body->nodes()[NodeColumns<3>::internal][n];
      if (time < 1.8 / speed)
        impulse += force * dt;
      if (last > 0 && force <= 0 && end == 0)
        end = time;
      last = force;
    }
  const double   exact  = density * speed * velocity * 1e-4;
  const Energies energy = body->energies();
  deallog << integration << ", impact: force within 1 % "
          << (std::fabs(impulse / (1.8 / speed) / exact - 1) < 0.01) << ", lasts 2L/c within 2 % "
          << (std::fabs(end / (2 / speed) - 1) < 0.02) << ", energy balances "
          << (std::fabs(energy.kinetic + energy.strain + energy.hourglass - energy.external_work -
                        start.kinetic) < 1e-12 * start.kinetic)
          << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  for (const char *integration : {"full", "one point"})
    {
      pulled_end(integration);
      impact(integration);
    }
}
