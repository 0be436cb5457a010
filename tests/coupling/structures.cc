// SPDX-License-Identifier: GPL-3.0-or-later
// Structures meet each other: elastic bars exchange their velocities and keep momentum and energy
// as wave theory has it, a block slides to rest on another by friction as a point mass does, a
// thin rigid sheet carries a solid's weight, nothing passes, and a start too near is refused; on
// any ranks.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

const std::string rubber =
  "subsection Materials\n subsection rubber\n set Model = neo-Hookean\n set Density = 1000\n"
  " set Young modulus = 1e6\n set Poisson ratio = 0\n end\nend\n";

/// A section `Bodies/<name>` with a box mesh from corner to corner.
std::string
block(const std::string &name,
      const std::string &entries,
      const std::string &lower,
      const std::string &upper,
      const std::string &subdivisions)
{
  return " subsection " + name + "\n" + entries +
         " subsection Mesh\n set Type = box\n set Lower corner = " + lower +
         "\n set Upper corner = " + upper + "\n set Subdivisions = " + subdivisions +
         "\n end\n end\n";
}

const std::string solid = " set Kind = solid\n set Material = rubber\n set Thickness = 0.001\n",
                  rigid = " set Kind = rigid\n set Density = 1000\n set Thickness = 0.001\n";

/// The box of the grid that no particle uses must have the right dimension.
template <int dim>
std::string
grid()
{
  return dim == 2
           ? ""
           : "subsection Grid\n set Lower corner = 0, 0, 0\n set Upper corner = 1, 1, 1\nend\n";
}

template <int dim>
struct Sums
{
  explicit Sums(const Coupling<dim> &coupling)
  {
    const auto add = [this](const auto &body) {
      const auto summary = body.summary();
      momentum += summary.mass * summary.velocity;
      const auto e = body.energies();
      balance += e.kinetic + e.strain + e.hourglass + e.damping - e.contact_work - e.external_work;
      kinetic += e.kinetic;
      contact += e.contact_work;
    };
    for (const auto &body : coupling.structure.solids)
      add(body);
    for (const auto &body : coupling.structure.rigids)
      add(body);
  }
  dealii::Tensor<1, dim> momentum;
  double                 balance = 0, kinetic = 0, contact = 0;
};

template <int dim>
void
collide()
{
  // c = sqrt(E/rho) = 31.6 m/s; contact lasts 2L/c = 63 ms.
  const bool        flat     = dim == 2;
  const std::string none     = " set Thickness = 0.001\n";
  const auto        coupling = make_coupling<dim>(
    grid<dim>() + rubber + "subsection Bodies\n" +
    block("striker",
          solid + " set Initial velocity = " + (flat ? "0.2, 0\n" : "0.2, 0, 0\n"),
          flat ? "-1.001, 0" : "-1.001, 0, 0",
          flat ? "-0.001, 0.1" : "-0.001, 0.1, 0.1",
          flat ? "40, 2" : "40, 2, 1") +
    block("bar",
          solid,
          flat ? "0, 0" : "0, 0, 0",
          flat ? "1, 0.1" : "1, 0.1, 0.1",
          flat ? "40, 2" : "40, 1, 2") +
    "end\n");
  const Sums<dim> start(*coupling);
  double          worst = 0, unbalanced = 0, last_contact = 0;
  while (coupling->time() < 0.09 - 1e-12)
    {
      coupling->advance(0.09);
      const Sums<dim> now(*coupling);
      worst      = std::max(worst, (now.momentum - start.momentum).norm());
      unbalanced = std::max(unbalanced, std::fabs(now.balance - start.balance));
      if (coupling->contacts.report().n_contacts > 0 &&
          coupling->contacts.report().worst_gap < 1e-9)
        last_contact = coupling->time();
    }
  const auto     &bodies = coupling->structure.solids;
  const Sums<dim> end(*coupling);
  deallog << "bars: momentum kept " << (worst < 1e-12 * start.momentum.norm())
          << ", energy balance " << (unbalanced < 1e-12 * start.kinetic)
          << ", contact takes energy, less than 1 % "
          << (end.contact <= 0 && end.contact > -0.01 * start.kinetic)
          << ", velocities exchanged to 3 % "
          << (std::fabs(bodies.back().summary().velocity[0] / 0.2 - 1) < 0.03 &&
              std::fabs(bodies.front().summary().velocity[0] / 0.2) < 0.03)
          << ", contact time to 3 % " << (std::fabs(last_contact / 0.06325 - 1) < 0.03)
          << ", penetrations " << coupling->contacts.n_penetrations() << std::endl;
}

template <int dim>
void
slide(const bool deformable)
{
  // On a floor that is held: v = v_0 - mu g t, at rest after v_0/(mu g) = 0.1 s.
  const bool        flat     = dim == 2;
  const std::string friction = " set Friction = 0.2\n";
  const auto        coupling = make_coupling<dim>(
    std::string("subsection Time\n set Largest step = 5e-4\nend\nset Gravity = ") +
    (flat ? "0, -10\n" : "0, 0, -10\n") + grid<dim>() + rubber + "subsection Bodies\n" +
    block("slider",
          (deformable ? solid : rigid) + friction +
            " set Initial velocity = " + (flat ? "0.2, 0\n" : "0.2, 0, 0\n"),
          flat ? "0.11, 0" : "0.11, 0.1, 0",
          flat ? "0.21, 0.02" : "0.21, 0.2, 0.02",
          flat ? "6, 2" : "4, 4, 2") +
    block("floor",
          rigid + friction + " set Free directions = none\n",
          flat ? "0, -0.1" : "0, 0, -0.1",
          flat ? "0.4, -0.001" : "0.4, 0.3, -0.001",
          flat ? "7, 1" : "7, 5, 1") +
    "end\n");
  const auto velocity = [&] {
    return deformable ? coupling->structure.solids.front().summary().velocity[0]
                      : coupling->structure.rigids.front().summary().velocity[0];
  };
  double at_half = 0;
  while (coupling->time() < 0.12 - 1e-12)
    {
      coupling->advance(coupling->time() < 0.05 - 1e-12 ? 0.05 : 0.12);
      if (std::fabs(coupling->time() - 0.05) < 1e-12)
        at_half = velocity();
    }
  deallog << (deformable ? "solid" : "rigid") << " block slides: half as fast after half the time "
          << (std::fabs(at_half / 0.1 - 1) < (deformable ? 0.05 : 0.01)) << ", then at rest "
          << (std::fabs(velocity()) < 0.004) << ", penetrations "
          << coupling->contacts.n_penetrations() << std::endl;
}

void
rest()
{
  // A thin rigid sheet that is held carries a block by its weight, 100 N per metre.
  const auto coupling = make_coupling<2>(
    "set Gravity = 0, -10\n" + rubber + "subsection Bodies\n" +
    block("block",
          solid + " subsection Damping\n set Coefficient = 100\n set End = 0.1\n end\n",
          "0, 0.001",
          "0.1, 0.101",
          "4, 4") +
    " subsection sheet\n set Kind = rigid\n set Mass = 1\n set Free directions = none\n"
    " set Thickness = 0.001\n subsection Mesh\n set Type = polyline\n set Points = -0.2, 0, 0.3, "
    "0\n"
    " set Subdivisions = 7\n end\n end\nend\n");
  // Nodes are struck in turns: the mean counts.
  dealii::Tensor<1, 2> before;
  while (coupling->time() < 0.2 - 1e-12)
    {
      coupling->advance(coupling->time() < 0.1 - 1e-12 ? 0.1 : 0.2);
      if (std::fabs(coupling->time() - 0.1) < 1e-12)
        before = mpi::sum(coupling->structure.contact_momentum()[0], comm);
    }
  const auto force = (mpi::sum(coupling->structure.contact_momentum()[0], comm) - before) / 0.1;
  deallog << "a sheet carries a block: weight to 1 % " << (std::fabs(force[1] / 100 - 1) < 0.01)
          << ", nothing along it " << (std::fabs(force[0]) < 0.1) << ", penetrations "
          << coupling->contacts.n_penetrations() << std::endl;
}

void
refuse()
{
  std::string found, cure;
  try
    {
      make_coupling<2>(rubber + "subsection Bodies\n" +
                       block("upper", solid, "0, 0", "1, 1", "4, 4") +
                       block("lower", rigid, "0.1, -1", "0.9, -0.0004", "2, 2") + "end\n");
    }
  catch (const UserError &error)
    {
      found = error.found;
      cure  = error.cure;
    }
  deallog << found << std::endl << cure << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog << std::boolalpha;
  collide<2>();
  collide<3>();
  slide<2>(false);
  slide<2>(true);
  slide<3>(false);
  rest();
  refuse();
}
