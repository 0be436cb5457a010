// SPDX-License-Identifier: GPL-3.0-or-later
// Water meets a rigid plate: nothing passes, both sides' momenta add up to round-off, at rest the
// plate carries the weight, and a start inside the plate is refused.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
std::string
text(const double plate_top, const std::string &plate, const std::string &water, const bool gravity)
{
  const bool        flat = dim == 2;
  const std::string top  = std::to_string(plate_top);
  return std::string(gravity ? (flat ? "set Gravity = 0, -10\n" : "set Gravity = 0, 0, -10\n")
                             : "") +
         "subsection Grid\n set Lower corner = " + (flat ? "0, 0" : "0, 0, 0") +
         "\n set Upper corner = " + (flat ? "0.4, 0.5" : "0.4, 0.2, 0.5") +
         "\n set Cell size = 0.1\n subsection Refinement\n subsection floor\n set Lower corner = " +
         (flat ? "0, 0.1" : "0, 0, 0.1") +
         "\n set Upper corner = " + (flat ? "0.2, 0.3" : "0.2, 0.2, 0.3") +
         "\n set Level = 1\n end\n end\nend\n"
         "subsection Materials\n subsection water\n set Model = weakly compressible\n set Sound "
         "speed = 20\n end\nend\n"
         "subsection Bodies\n subsection water\n set Material = water\n set Particle spacing = "
         "0.025\n"
         " set Lower corner = " +
         (flat ? "0, 0.2" : "0, 0, 0.2") +
         "\n set Upper corner = " + (flat ? "0.4, 0.4\n" : "0.4, 0.2, 0.4\n") + water +
         " end\n subsection plate\n set Kind = rigid\n" + plate +
         " subsection Mesh\n set Type = box\n set Subdivisions = " + (flat ? "4, 1" : "4, 2, 1") +
         "\n set Lower corner = " + (flat ? "-0.1, 0.05" : "-0.1, -0.1, 0.05") +
         "\n set Upper corner = " + (flat ? "0.5, " : "0.5, 0.3, ") + top + "\n end\n end\nend\n";
}

template <int dim>
void
test_free_plate()
{
  // A plate without gravity, that the water hits: what one loses the other gains. The particles
  // start 2 mm above the contact distance, half a spacing from the plate's top.
  const std::string down = dim == 2 ? "0, -1" : "0, 0, -1";
  const auto        coupling =
    make_coupling<dim>(text<dim>(0.198,
                                 dim == 2 ? " set Mass = 50\n set Free directions = y\n"
                                          : " set Mass = 10\n set Free directions = z\n",
                                 " set Initial velocity = " + down + "\n",
                                 false));
  const Totals<dim> start(coupling->points.bodies.front().points);
  double            worst    = 0;
  unsigned int      touching = 0;
  bool              agree    = true;
  for (unsigned int i = 0; i < 60; ++i)
    {
      coupling->advance(1e300);
      const Totals<dim> now(coupling->points.bodies.front().points);
      const auto       &plate = coupling->structure.rigids.front();
      worst =
        std::max(worst,
                 std::fabs(now.momentum[dim - 1] + plate.mass() * plate.centre_velocity()[dim - 1] -
                           start.momentum[dim - 1]));
      touching += mpi::sum<unsigned int>(coupling->contacts.report().n_contacts, comm) > 0;
      const double given = mpi::sum(coupling->contacts.contact_momentum().empty()
                                      ? 0.
                                      : coupling->contacts.contact_momentum()[0][dim - 1],
                                    comm),
                   taken = mpi::sum(coupling->structure.contact_momentum()[0][dim - 1], comm);
      agree              = agree && std::fabs(given + taken) < 1e-12 * start.mass;
    }
  const Totals<dim> now(coupling->points.bodies.front().points);
  deallog << "free plate: penetrations " << mpi::max(coupling->contacts.n_penetrations(), comm)
          << ", touched " << (touching > 10) << ", momentum kept " << (worst < 1e-12 * start.mass)
          << ", books of both sides agree " << agree << ", was pushed down "
          << (coupling->structure.rigids.front().centre_velocity()[dim - 1] < -0.1) << std::endl;
  bool        above  = true;
  const auto &plate  = coupling->structure.rigids.front();
  const auto &points = coupling->points.bodies.front().points;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      above =
        above && points.position(row)[dim - 1] > plate.centre()[dim - 1] + 0.5 * (0.198 - 0.05);
  deallog << "all particles are above it: " << !mpi::any(!above, comm) << ", ledger "
          << coupling->points.ledger_error() << std::endl;
}

template <int dim>
void
test_weight()
{
  // A floor that stands still; damped until the water rests.
  const auto coupling = make_coupling<dim>(
    text<dim>(0.1999, " set Mass = 1\n set Free directions = none\n", " set Damping = 20\n", true));
  const Totals<dim> start(coupling->points.bodies.front().points);
  double            impulse = 0, since = 0;
  while (coupling->time() < 0.8 - 1e-9)
    {
      coupling->advance(0.8);
      if (coupling->time() > 0.5)
        {
          const double given = mpi::sum(coupling->structure.contact_momentum()[0][dim - 1], comm);
          if (since == 0)
            {
              impulse = given;
              since   = coupling->time();
            }
          else if (coupling->time() > 0.8 - 1e-9)
            impulse = (given - impulse) / (coupling->time() - since);
        }
    }
  const Totals<dim> now(coupling->points.bodies.front().points);
  deallog << "water at rest: force is the weight to 1 % "
          << (std::fabs(impulse / (-10 * start.mass) - 1) < 0.01) << ", speed below 2 mm/s "
          << (now.momentum.norm() < 0.002 * start.mass) << ", penetrations "
          << mpi::max(coupling->contacts.n_penetrations(), comm) << std::endl;
}

template <int dim>
void
test_overlap()
{
  std::string found, cure;
  try
    {
      make_coupling<dim>(text<dim>(0.205, " set Mass = 1\n", "", true));
    }
  catch (const UserError &error)
    {
      found = error.found;
      cure  = error.cure;
    }
  const auto all  = dealii::Utilities::MPI::all_gather(comm, found);
  bool       same = true;
  for (const auto &other : all)
    same = same && other == found;
  // The lowest row: 7.5 mm above the plate instead of half a spacing, 12.5 mm.
  deallog << "refused alike on all ranks: " << same << ", "
          << found.substr(0, found.find(" at ")).substr(0, found.find("number")) << "..."
          << std::endl
          << found.substr(found.find(") m, ") + 5) << "; " << cure << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test_free_plate<2>();
  test_weight<2>();
  test_overlap<2>();
  deallog.pop();
  deallog.push("3d");
  test_free_plate<3>();
  test_overlap<3>();
  deallog.pop();
}
