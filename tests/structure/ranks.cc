// SPDX-License-Identifier: GPL-3.0-or-later
// A body's whole motion is the same on any number of ranks, also with hanging nodes and on ranks
// without elements: sums of mass, momentum and energies, with contact impulses that come from
// several ranks, and energy is accounted for to round-off.
#include "bodies.h"

#include <iomanip>

using namespace coracle;

namespace
{
std::string
text(const std::string &integration, const std::string &mesh)
{
  return "subsection Materials\n subsection m\n set Model = neo-Hookean\n set Density = 1000\n set "
         "Young modulus = "
         "1 MPa\n set Poisson ratio = 0.3\n end\nend\nsubsection Bodies\n subsection body\n set "
         "Material = m\n"
         " set Integration = " +
         integration + "\n set Initial velocity = 1, -2\n subsection Mesh\n" + mesh +
         "\n end\n subsection Loads\n subsection squeeze\n set Pressure = if(y > 0.5, 1e4, 0)\n "
         "end\n"
         " subsection stir\n set Type = acceleration\n set Acceleration = 100*y; -100*x\n end\n "
         "end\n"
         " subsection Boundary conditions\n subsection low\n set Region = -9, -9, 9, 0\n"
         " set Type = displacement\n set Directions = x\n set Displacement = 0.01*sin(100*t); 0\n "
         "end\n end\n"
         " subsection Damping\n set Coefficient = 10\n set Start = 0.01\n end\n end\nend\n";
}

void
report(const std::string &title, const std::string &integration, const std::string &mesh)
{
  const BodyCase body_case(text(integration, mesh), 2);
  const auto     body  = body_case.solid<2>(dealii::Tensor<1, 2>({0., -9.81}));
  const Energies start = body->energies();
  const double   dt    = 0.5 * stable_step(*body);
  for (int i = 0; i < 400; ++i)
    {
      body->assemble_forces(i * dt);
      body->predict_velocities(dt);
      // Every rank pushes its facets: half of an impulse to each node.
      for (const auto &facet : body->facets())
        for (const unsigned int n : facet.nodes)
          if (body->mesh().nodes[n][0] < 0.3)
            body->add_contact_impulse(n, dealii::Tensor<1, 2>({0.001, 0.0005}));
      body->apply_contact_impulses();
      for (const auto &facet : body->facets())
        for (const unsigned int n : facet.nodes)
          body->add_correction(n, dealii::Tensor<1, 2>({1e-6, 0.}));
      body->apply_corrections();
      body->move(dt);
      body->update_stress(dt);
    }
  const Energies e       = body->energies();
  const auto     s       = body->summary();
  const double   balance = e.kinetic - start.kinetic + e.strain + e.hourglass + e.damping -
                         e.contact_work - e.external_work;
  deallog << title << ", " << integration << std::setprecision(9) << ": mass " << s.mass
          << ", centre " << s.centre << ", velocity " << s.velocity << ", contact force "
          << s.contact_force << ", moment " << s.contact_moment[2] << std::endl
          << "  kinetic " << e.kinetic << ", strain+hourglass " << e.strain + e.hourglass
          << ", damping " << e.damping << ", contact " << e.contact_work << ", external "
          << e.external_work << ", balance " << (std::fabs(balance) < 1e-12 * e.kinetic)
          << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  for (const char *integration : {"full", "one point"})
    {
      report("wedge of three", integration, "set Type = wedge\nset Subdivisions = 1");
      report("wedge", integration, "set Type = wedge\nset Subdivisions = 4");
      report("hanging nodes",
             integration,
             "set Subdivisions = 4\nset Refined region = 0.2, 0.2, 0.8, 0.8");
    }
}
