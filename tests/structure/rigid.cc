// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies: mass and inertia of a box are exact and of a ball convergent; a box that spins
// about its middle axis tumbles with its angular momentum kept to round-off and its energy to
// second order; free directions, prescribed motion and contact impulses do what Newton says.
#include "bodies.h"

using namespace coracle;

namespace
{
template <int dim>
std::unique_ptr<RigidBody<dim>>
rigid(const std::string &lines, const dealii::Tensor<1, dim> &gravity = {})
{
  return BodyCase("subsection Bodies\n subsection body\n set Kind = rigid\n" + lines +
                    "\n end\nend\n",
                  dim)
    .template rigid<dim>(gravity);
}

const std::string brick =
  " subsection Mesh\n set Upper corner = 1, 2, 3\n set Subdivisions = 1, 2, 1\n end\n";

void
inertia()
{
  const auto   box     = rigid<3>("set Density = 2\n" + brick);
  const auto   inverse = box->inverse_inertia();
  const double m       = 12;
  deallog << "box: mass " << box->mass() << ", centre " << box->centre() << ", inertia exact "
          << (std::fabs(inverse[0][0] * m * 13 / 12 - 1) < 1e-12 &&
              std::fabs(inverse[1][1] * m * 10 / 12 - 1) < 1e-12 &&
              std::fabs(inverse[2][2] * m * 5 / 12 - 1) < 1e-12 && std::fabs(inverse[0][1]) < 1e-12)
          << std::endl;
  const auto rectangle =
    rigid<2>("set Mass = 6\n subsection Mesh\n set Upper corner = 1, 2\n end\n");
  deallog << "rectangle: 1/I " << rectangle->inverse_inertia()[2][2] * 6 * 5 / 12 << std::endl;

  double last = 0;
  for (const char *refinements : {"1", "2", "3"})
    {
      const auto ball =
        rigid<3>(std::string("set Mass = 5\n subsection Mesh\n set Type = ball\n set "
                             "Refinements = ") +
                 refinements + "\n end\n");
      const double error = 0.5 / ball->inverse_inertia()[0][0] - 1;
      if (last != 0)
        deallog << "ball: inertia converges with order 2: "
                << (std::log2(last / error) > 1.8 && std::log2(last / error) < 2.3) << std::endl;
      last = error;
    }
}

/// Largest relative changes of angular momentum and energy of a tumbling brick.
std::pair<double, double>
tumble(const double dt)
{
  const auto   body     = rigid<3>("set Mass = 12\nset Initial spin = 0.01, 10, 0.02\n" + brick);
  const auto   momentum = body->orientation().angular_momentum();
  const double energy   = body->orientation().kinetic_energy();
  double       lost = 0, drift = 0, lowest = 10;
  for (int i = 0; i * dt < 4; ++i)
    {
      body->assemble_forces(i * dt);
      body->predict_velocities(dt);
      body->apply_contact_impulses();
      body->move(dt);
      lost  = std::max(lost,
                      (body->orientation().angular_momentum() - momentum).norm() / momentum.norm());
      drift = std::max(drift, std::fabs(body->orientation().kinetic_energy() / energy - 1));
      const auto spin = body->spin();
      lowest =
        std::min(lowest, spin * body->orientation().turned(dealii::Tensor<1, 3>({0., 1., 0.})));
    }
  // The middle axis is unstable: the brick turns over.
  deallog << "turned over " << (lowest < -9) << ", angular momentum kept " << (lost < 1e-12)
          << std::endl;
  return {lost, drift};
}

void
motion()
{
  const dealii::Tensor<1, 2> gravity({0., -10.});
  const std::string          square = " subsection Mesh\n end\n";
  const auto                 free_y =
    rigid<2>("set Mass = 2\nset Free directions = y\nset Initial velocity = 3, 1\n" + square,
             gravity);
  const auto moved =
    rigid<2>("set Mass = 2\nset Motion = displacement\nset Displacement = 0.1*sin(t); t^2\n"
             "set Spin = 2\n" +
               square,
             gravity);
  const auto held = rigid<2>(
    "set Mass = 2\nset Motion = velocity\nset Velocity = 1; 0\nset Free directions = y, rz\n" +
      square,
    gravity);
  const double dt    = 0.01;
  const auto   start = held->energies();
  for (int i = 0; i < 100; ++i)
    {
      for (auto *body : {free_y.get(), moved.get(), held.get()})
        {
          body->assemble_forces(i * dt);
          body->predict_velocities(dt);
        }
      // A push of 1 and 2 N s at the lower left corner, at half time.
      if (i == 50)
        for (const unsigned int n : held->surface_nodes())
          if (held->mesh().nodes[n].norm() < 1e-12)
            held->add_contact_impulse(n, dealii::Tensor<1, 2>({1., 2.}));
      for (auto *body : {free_y.get(), moved.get(), held.get()})
        {
          body->apply_contact_impulses();
          body->move(dt);
        }
    }
  const auto fall = free_y->summary(), driven = moved->summary(), pushed = held->summary();
  // Leapfrog is exact for constant acceleration at whole steps.
  deallog << "free fall along y: " << fall.centre << ", exact "
          << (std::fabs(fall.centre[1] - (0.5 + 1 - 5)) < 1e-12) << std::endl
          << "driven: displacement exact "
          << (driven.centre.distance(dealii::Point<2>(0.5 + 0.1 * std::sin(1), 1.5)) < 1e-12)
          << ", angle exact "
          << (std::fabs(moved->orientation().orientation()[3] - std::sin(1.)) < 1e-12) << std::endl;
  const Energies end = held->energies();
  deallog << "pushed: velocity " << pushed.velocity[0] << ' ' << pushed.velocity[1] + 9.95
          << ", spins " << (std::fabs(pushed.spin[2]) > 0.1) << ", energy balances "
          << (std::fabs(end.kinetic - start.kinetic - end.contact_work - end.external_work) <
              1e-12 * end.kinetic)
          << std::endl;
}

void
refused(const std::string &lines)
{
  try
    {
      rigid<2>(lines + "\n subsection Mesh\n end\n");
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
  inertia();
  const double coarse = tumble(2e-3).second, fine = tumble(1e-3).second;
  deallog << "energy error small " << (fine < 1e-4) << ", order 2 " << (coarse / fine > 3.5)
          << std::endl;
  motion();
  refused("");
  refused("set Mass = 1\nset Density = 1");
  refused("set Mass = 1\nset Free directions = z");
  refused("set Mass = 1\nset Free directions = all, x");
  refused("set Mass = 1\nset Free directions = all\nset Motion = velocity");
  refused("set Mass = 1\nset Initial spin = 1, 2");
}
