// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of structures that are lost without the continuous check are held by it: a strip that folds
// onto itself, a block that two flying plates close on, a spinning bar that strikes a strip; in the
// plane and in space, on any ranks. Where nothing would be lost, nothing changes, bit by bit.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
std::string
place(const double x, const double y, const double z)
{
  std::ostringstream out;
  out << x << ", " << y;
  if (dim == 3)
    out << ", " << z;
  return out.str();
}

/// A section of a body with a box mesh, twice `half` wide around the place.
template <int dim>
std::string
block(const std::string           &name,
      const std::string           &entries,
      const std::array<double, 3> &middle,
      const std::array<double, 3> &half,
      const std::string           &subdivisions)
{
  const auto corner = [&](const double s) {
    return place<dim>(middle[0] + s * half[0], middle[1] + s * half[1], middle[2] + s * half[2]);
  };
  return " subsection " + name + "\n" + entries + " subsection Mesh\n set Type = box\n" +
         " set Lower corner = " + corner(-1) + "\n set Upper corner = " + corner(1) +
         "\n set Subdivisions = " + subdivisions + (dim == 3 ? ", 1" : "") + "\n end\n end\n";
}

const std::string solid = " set Kind = solid\n set Material = rubber\n";

/// A whole case.
template <int dim>
std::string
text(const std::string &bodies, const bool check)
{
  return std::string("subsection Grid\n set Lower corner = ") + place<dim>(0, 0, 0) +
         "\n set Upper corner = " + place<dim>(1, 1, 1) +
         "\nend\nsubsection Time\n set Safety factor = 0.9\nend\n"
         "subsection Materials\n subsection rubber\n set Model = neo-Hookean\n set Density = 1000\n"
         " set Young modulus = 1e6\n set Poisson ratio = 0.3\n end\nend\n"
         "subsection Contact\n set Continuous check = " +
         (check ? "true" : "false") + "\nend\nsubsection Bodies\n" + bodies + "end\n";
}

/// A strip between two rigid plates that come together and turn.
template <int dim>
std::string
strip()
{
  const auto plate = [](const double side, const double spin) {
    std::ostringstream entries;
    entries << " set Kind = rigid\n set Mass = 1\n set Motion = velocity\n set Velocity = "
            << -side * 14 << (dim == 2 ? "; 0" : "; 0; 0")
            << "\n set Spin = " << (dim == 2 ? "" : "0; 0; ") << spin << "\n";
    return block<dim>(side < 0 ? "left" : "right",
                      entries.str(),
                      {{side * 0.104, 0, 0}},
                      {{0.002, 0.03, 0.01}},
                      "1, 3");
  };
  return block<dim>("strip",
                    solid + " set Self contact = true\n",
                    {{0, 0, 0}},
                    {{0.1, 0.002, 0.002}},
                    "40, 1") +
         plate(-1, -14) + plate(1, 19);
}

/// A bar that is set spinning, beside a strip that stands at its end.
template <int dim>
std::string
spinning()
{
  return block<dim>("bar", solid, {{0, 0, 0}}, {{0.1, 0.005, 0.005}}, "8, 1") +
         block<dim>("strip", solid, {{0.094, 0.03, 0}}, {{0.002, 0.02, 0.006}}, "1, 6");
}

struct Result
{
  unsigned long penetrations = 0, resolved = 0, failed = 0;
  /// Of all positions: a sum that tells runs apart.
  double sum = 0;
};

template <int dim>
Result
run(const std::string &text, const double spin, const double end)
{
  const auto coupling = make_coupling<dim>(text);
  if (spin != 0)
    {
      auto &body  = coupling->structure.solids.front();
      auto &nodes = body.nodes();
      using Node  = NodeColumns<dim>;
      for (unsigned int n = 0; n < nodes.size(); ++n)
        {
          nodes[Node::velocity][n]     = -spin * nodes[Node::position + 1][n];
          nodes[Node::velocity + 1][n] = spin * nodes[Node::position][n];
        }
    }
  Result result;
  try
    {
      while (coupling->time() < end * (1 - 1e-12))
        coupling->advance(end);
    }
  catch (const RunFailure &)
    {
      // Elements turn inside out.
    }
  result.penetrations = coupling->contacts.n_penetrations();
  result.resolved     = coupling->contacts.report().n_resolved;
  result.failed       = coupling->contacts.report().n_failed;
  for (const auto &body : coupling->structure.solids)
    for (unsigned int n = 0; n < body.mesh().n_owned_nodes(); ++n)
      for (int d = 0; d < dim; ++d)
        result.sum += body.nodes()[NodeColumns<dim>::position + d][n];
  return result;
}

template <int dim>
void
compare(const std::string &name, const std::string &bodies, const double spin, const double end)
{
  const Result without = run<dim>(text<dim>(bodies, false), spin, end),
               with    = run<dim>(text<dim>(bodies, true), spin, end);
  deallog << name << ": lost without the check " << (without.penetrations > 0) << ", with it "
          << with.penetrations << ", ends changed " << (with.resolved > 0) << ", failed "
          << with.failed << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog << std::boolalpha;
  compare<2>("strip", strip<2>(), 0, 0.0065);
  compare<2>("spinning bar", spinning<2>(), 500, 0.0009);
  // Contact alone keeps these apart.
  const std::string bodies = spinning<3>();
  const Result      with   = run<3>(text<3>(bodies, true), 300, 0.002),
               without     = run<3>(text<3>(bodies, false), 300, 0.002);
  deallog << "slower, in space: ends changed " << with.resolved << ", the same bit by bit "
          << (with.sum == without.sum) << std::endl;
}
