// SPDX-License-Identifier: GPL-3.0-or-later
// Loads and supports: pressure on a closed body has no resultant, before and after it deforms; a
// bar under traction comes to the analytic uniform stress, also across hanging nodes; symmetry
// planes give the quarter the full body's motion; an inverted element is named; wrong sections are
// refused.
#include "bodies.h"

using namespace coracle;

namespace
{
const std::string material =
  "subsection Materials\n subsection m\n set Model = linear elastic\n set Density = 1000\n"
  " set Young modulus = 1 MPa\n set Poisson ratio = 0.3\n end\nend\n";

std::string
text(const std::string &lines)
{
  return material + "subsection Bodies\n subsection body\n set Material = m\n" + lines +
         "\n end\nend\n";
}

void
closed_pressure()
{
  const BodyCase body_case(text(
                             " set Initial velocity = 0, 0, 0\n subsection Mesh\n set Type = "
                             "ball\n set Refinements = 1\n end\n"
                             " subsection Loads\n subsection p\n set Pressure = 1e5\n end\n end\n"),
                           3);
  const auto     body  = body_case.solid<3>();
  double         worst = 0;
  for (int i = 0; i < 50; ++i)
    {
      const double dt = 0.5 * stable_step(*body);
      step(*body, 0., dt);
      body->assemble_forces(0.);
      dealii::Tensor<1, 3> sum;
      double               size = 0;
      for (unsigned int n = 0; n < body->mesh().n_nodes(); ++n)
        for (int d = 0; d < 3; ++d)
          {
            sum[d] += body->nodes()[NodeColumns<3>::external + d][n];
            size += std::fabs(body->nodes()[NodeColumns<3>::external + d][n]);
          }
      worst = std::max(worst, sum.norm() / size);
    }
  deallog << "closed surface, no resultant " << (worst < 1e-14) << ", smaller "
          << (body->displacement(body->surface_nodes()[0]) *
                body->position(body->surface_nodes()[0]) <
              0)
          << std::endl;
}

void
uniform_stress(const std::string &integration, const std::string &region)
{
  const BodyCase body_case(
    text(" set Integration = " + integration +
         "\n subsection Mesh\n set Upper corner = 2, 1\n set Subdivisions = 4, 4\n" + region +
         "\n end\n subsection Boundary conditions\n subsection left\n set Boundary id = 0\n set "
         "Type = symmetric\n end\n"
         " subsection below\n set Boundary id = 2\n set Type = symmetric\n end\n end\n"
         " subsection Loads\n subsection pull\n set Type = traction\n set Boundary id = 1\n set "
         "Traction = 100; 0\n end\n end\n"
         " subsection Damping\n set Coefficient = 25\n end\n"),
    2);
  const auto body = body_case.solid<2>();
  double     time = 0;
  while (time < 2)
    {
      const double dt = 0.9 * stable_step(*body);
      step(*body, time, dt);
      time += dt;
    }
  double worst = 0;
  for (unsigned int e = 0; e < body->mesh().n_elements(); ++e)
    {
      const auto s = body->stress(e);
      worst        = std::max(
        {worst, std::fabs(s[0] - 100), std::fabs(s[1]), std::fabs(s[2] - 30), std::fabs(s[3])});
    }
  deallog << integration << (region.empty() ? "" : ", hanging nodes") << ": uniform stress "
          << (worst < 0.05) << std::endl;
}

void
symmetry()
{
  const auto run = [](const std::string &mesh, const std::string &conditions) {
    const BodyCase body_case(text(" subsection Mesh\n" + mesh + "\n end\n" + conditions +
                                  " subsection Loads\n subsection p\n set Type = acceleration\n"
                                  " set Acceleration = 10*x*y^2; -20*y\n end\n end\n"),
                             2);
    const auto     body = body_case.solid<2>();
    for (int i = 0; i < 100; ++i)
      step(*body, i * 1e-3, 1e-3);
    for (unsigned int n = 0; n < body->mesh().n_nodes(); ++n)
      if (body->mesh().nodes[n].distance(dealii::Point<2>(1, 1)) < 1e-12)
        return body->displacement(n);
    return dealii::Tensor<1, 2>();
  };
  const auto whole = run("set Lower corner = -1, -1\nset Subdivisions = 8", "");
  const auto part  = run("set Subdivisions = 4",
                        " subsection Boundary conditions\n subsection x\n set Boundary id = 0\n "
                         "set Type = symmetric\n end\n"
                         " subsection y\n set Boundary id = 2\n set Type = symmetric\n end\n end\n");
  deallog << "a quarter moves as the whole " << ((whole - part).norm() < 1e-12 * whole.norm())
          << ", it moves " << (whole.norm() > 1e-3) << std::endl;
}

void
inverted()
{
  const BodyCase body_case(
    text(" subsection Mesh\n end\n subsection Boundary conditions\n subsection crush\n"
         " set Boundary id = 3\n set Type = velocity\n set Velocity = 0; -100\n end\n"
         " subsection floor\n set Boundary id = 2\n end\n end\n"),
    2);
  const auto body = body_case.solid<2>();
  try
    {
      for (int i = 0; i < 100; ++i)
        step(*body, i * 1e-3, 1e-3);
      deallog << "not noticed" << std::endl;
    }
  catch (const RunFailure &failure)
    {
      deallog << failure.title << ": names the element "
              << (failure.details.find("element 0") != std::string::npos) << std::endl;
    }
}

void
refused(const std::string &lines)
{
  try
    {
      BodyCase(text(lines), 2).solid<2>();
      deallog << "accepted" << std::endl;
    }
  catch (const UserError &e)
    {
      deallog << "refused: " << e.title << " | " << e.found << std::endl;
    }
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  closed_pressure();
  for (const char *integration : {"full", "one point"})
    for (const char *region : {"", "set Refined region = 0.4, 0.2, 1.2, 0.8"})
      uniform_stress(integration, region);
  symmetry();
  inverted();
  const std::string condition = " subsection Boundary conditions\n subsection c\n";
  refused(condition + " end\n end\n");
  refused(condition + " set Boundary id = 7\n end\n end\n");
  refused(condition + " set Region = 0, 0, 1\n end\n end\n");
  refused(condition + " set Boundary id = 1\n set Directions = x, z\n end\n end\n");
  refused(condition + " set Region = 0, 0, 1, 1\n set Type = symmetric\n end\n end\n");
  refused(condition +
          " set Boundary id = 1\n set Type = velocity\n set Velocity = 1\n end\n end\n");
}
