// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh becomes finer in front of what strikes it - another body, a rigid one, particles - and
// nothing passes: elements grow in number where contact comes, mass stays, and the momentum of all
// bodies stays to round-off while they touch across hanging nodes; a rigid body gets more facets
// and keeps its mass; coarsening and what cannot adapt are refused.
#include "case.h"

using namespace coracle;

namespace
{
template <int dim>
std::string
corners(const std::vector<double> &lower, const std::vector<double> &upper)
{
  std::ostringstream text;
  text << " set Lower corner = ";
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << lower[d];
  text << "\n set Upper corner = ";
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << upper[d];
  return text.str() + "\n";
}

const std::string adaptivity =
  " subsection Adaptivity\n set Interval in steps = 5\n subsection Criteria\n subsection near\n"
  " set Kind = contact distance\n set Refine nearer than = 0.08\n set Highest level = 2\n end\n "
  "end\n "
  "end\n";

/// A block flies at something.
template <int dim>
std::string
text(const std::string &other, const bool reproducible = false)
{
  return std::string(reproducible ? "set Reproducible = true\n" : "") +
         "subsection Contact\n set Tolerance = 1e-10\n"
         " set Maximum iterations = 10000\nend\nsubsection Grid\n" +
         corners<dim>({-2, -2, -2}, {2, 2, 2}) +
         " set Cell size = 0.25\nend\nsubsection Materials\n subsection rubber\n set Model = "
         "neo-Hookean\n"
         " set Density = 1000\n set Young modulus = 1 MPa\n set Poisson ratio = 0.3\n end\n "
         "subsection water\n"
         " set Model = weakly compressible\n set Density = 1000\n set Sound speed = 20\n end\nend\n"
         "subsection Bodies\n subsection block\n set Kind = solid\n set Material = rubber\n"
         " set Thickness = 0.01\n set Initial velocity = 0, " +
         (dim == 2 ? "-4" : "0, -4") + "\n subsection Mesh\n" +
         corners<dim>({-0.5, dim == 2 ? 0 : -0.5, 0}, {0.5, 0.5, 0.5}) +
         " set Subdivisions = " + (dim == 2 ? "4, 2" : "4, 4, 2") + "\n end\n" + adaptivity +
         " end\n" + other + "end\n";
}

template <int dim>
std::string
striker(const std::string &kind)
{
  return " subsection other\n set Kind = " + kind + "\n set Thickness = 0.01\n" +
         (kind == "rigid" ? " set Density = 2000\n" + adaptivity : " set Material = rubber\n") +
         " set Initial velocity = 0.5, " + (dim == 2 ? "2" : "0, 2") + "\n subsection Mesh\n" +
         corners<dim>({-0.1, dim == 2 ? -0.5 : -0.1, -0.5}, {0.13, dim == 2 ? -0.3 : 0.13, -0.3}) +
         " end\n end\n";
}

/// Of all structures.
template <int dim>
dealii::Tensor<1, dim>
momentum_of(Coupling<dim> &coupling)
{
  dealii::Tensor<1, dim> momentum;
  for (auto &body : coupling.structure.solids)
    for (unsigned int n = 0; n < body.mesh().n_owned_nodes(); ++n)
      momentum += body.nodes()[NodeColumns<dim>::mass][n] * body.velocity(n);
  momentum = mpi::sum(momentum, MPI_COMM_WORLD);
  for (auto &body : coupling.structure.rigids)
    momentum += body.mass() * body.centre_velocity();
  return momentum;
}

template <int dim>
void
strike(const std::string &kind, const unsigned int n_steps)
{
  const auto    coupling = make_coupling<dim>(text<dim>(striker<dim>(kind)));
  auto         &block    = coupling->structure.solids.front();
  const auto    start    = momentum_of(*coupling);
  const double  mass     = block.summary().mass;
  const auto    before   = block.mesh().n_global_elements();
  double        worst = 0, rigid_mass = 0;
  std::uint64_t rigid_elements = 0;
  if (kind == "rigid")
    {
      rigid_mass     = coupling->structure.rigids.front().mass();
      rigid_elements = coupling->structure.rigids.front().mesh().n_global_elements();
    }
  unsigned long      contacts = 0;
  const unsigned int changes  = block.mesh().n_changes();
  for (unsigned int i = 0; i < n_steps; ++i)
    {
      coupling->advance(1.);
      const auto now = momentum_of(*coupling);
      worst          = std::max(worst, (now - start).norm());
      contacts += coupling->contacts.report().n_contacts;
    }
  deallog << dim << "-D, " << kind << ": elements " << before << " -> "
          << block.mesh().n_global_elements() << ", they touch: " << (contacts > 0)
          << ", changed after the start: " << (block.mesh().n_changes() > changes)
          << ", mass: " << (std::fabs(block.summary().mass / mass - 1) < 1e-13)
          << ", momentum: " << (worst < 1e-11 * mass * 4);
  if (kind == "rigid")
    deallog << ", rigid body finer: "
            << (coupling->structure.rigids.front().mesh().n_global_elements() > rigid_elements)
            << ", of the same mass: " << (coupling->structure.rigids.front().mass() == rigid_mass);
  deallog << ", passed " << coupling->contacts.n_penetrations() << std::endl;
}

/// Particles strike the block.
template <int dim>
void
splash(const unsigned int n_steps)
{
  const std::string water =
    " subsection water\n set Material = water\n set Particle spacing = 0.05\n"
    " set Shape = box\n" +
    corners<dim>({-0.2, dim == 2 ? -0.5 : -0.2, -0.5}, {0.2, dim == 2 ? -0.3 : 0.2, -0.3}) +
    " end\n";
  const auto    coupling = make_coupling<dim>(text<dim>(water));
  auto         &block    = coupling->structure.solids.front();
  const auto    before   = block.mesh().n_global_elements();
  unsigned long contacts = 0;
  for (unsigned int i = 0; i < n_steps; ++i)
    {
      coupling->advance(1.);
      contacts += coupling->contacts.report().n_contacts;
    }
  deallog << dim << "-D, particles: elements " << before << " -> "
          << block.mesh().n_global_elements() << ", they touch: " << (contacts > 0) << ", passed "
          << coupling->contacts.n_penetrations() << std::endl;
}

void
refusals()
{
  const auto refused = [](std::string whole, const std::string &from, const std::string &to) {
    whole.replace(whole.find(from), from.size(), to);
    try
      {
        make_coupling<2>(whole);
      }
    catch (const UserError &error)
      {
        deallog << "refused: " << error.title << std::endl;
        return;
      }
    deallog << "NOT refused: " << to << std::endl;
  };
  const std::string whole = text<2>(striker<2>("solid"));
  refused(whole, "set Highest level = 2", "set Coarsen farther than = 1");
  refused(whole, "set Highest level = 2", "set Highest level = 11\n set Bodies = moon");
  refused(whole, "set Refine nearer than = 0.08", "");
  refused(whole, "subsection Contact\n", "subsection Contact\n set Method = grid\n");
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  strike<2>("solid", 100);
  strike<3>("solid", 80);
  strike<2>("rigid", 100);
  strike<3>("rigid", 80);
  splash<2>(100);
  splash<3>(70);
  refusals();
}
