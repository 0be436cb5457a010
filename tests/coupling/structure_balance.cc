// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of structures are shared out by what they and their contacts cost: where a block touches
// with one end, the busiest rank has less to do than with even numbers, at the start and while the
// run goes on; the motion is that on one rank to 1e-10, and with Reproducible = true in every bit,
// with hanging nodes, thin sheets between, refinement on the way, and ranks without elements.
#include "case.h"

#include <map>

using namespace coracle;

namespace
{
const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
std::string
corners(const std::array<double, 3> &lower, const std::array<double, 3> &upper)
{
  std::ostringstream text;
  for (const bool is_upper : {false, true})
    {
      text << (is_upper ? " set Upper corner = " : " set Lower corner = ");
      for (int d = 0; d < dim; ++d)
        text << (d > 0 ? ", " : "") << (is_upper ? upper[d] : lower[d]);
      text << '\n';
    }
  return text.str();
}

/// A block comes down with one end on a rigid one, with the other on a sheet.
template <int dim>
std::string
text(const std::string &balance, const std::string &root, const std::string &of_block)
{
  const double up = dim == 2 ? 0. : 0.25;
  return root + "set Gravity = " + (dim == 2 ? "0, -10" : "0, -10, 0") +
         "\nsubsection Contact\n set " +
         (dim == 2 ? "Tolerance = 1e-11\n set Maximum iterations = 3000" : "Tolerance = 1e-6") +
         "\nend\n"
         "subsection Grid\n" +
         corners<dim>({-2, -2, -2}, {2, 2, 2}) + " set Cell size = 2\n subsection Load balance\n" +
         balance +
         " end\nend\nsubsection Materials\n subsection rubber\n set Model = neo-Hookean\n"
         " set Density = 1000\n set Young modulus = 2e5\n set Poisson ratio = 0.3\n end\nend\n"
         "subsection Bodies\n subsection block\n set Kind = solid\n set Material = rubber\n"
         " set Thickness = 0.01\n set Initial velocity = 0, -0.5" +
         (dim == 2 ? "" : ", 0") + "\n subsection Mesh\n" +
         corners<dim>({-1, 0, -up}, {1, 0.25, up}) +
         " set Subdivisions = " + (dim == 2 ? "24, 3" : "16, 3, 3") + "\n" + of_block +
         " end\n subsection anvil\n set Kind = rigid\n set Density = 5000\n set Thickness = 0.01\n"
         " set Free directions = none\n"
         " subsection Mesh\n" +
         corners<dim>({0.3, -0.3, -2 * up}, {1.05, -0.0102, 2 * up}) +
         " set Subdivisions = " + (dim == 2 ? "10, 2" : "10, 2, 5") +
         "\n end\n end\n subsection sheet\n set Kind = rigid\n set Mass = 100\n set Free "
         "directions = none\n"
         " set Thickness = 0.01\n subsection Mesh\n set Type = polyline\n"
         " set Points = -1.1, -0.016, -0.71, -0.016\n set Subdivisions = 3\n" +
         (dim == 2 ? "" : " set Length = 0.6\n") + " end\n end\nend\n";
}

const std::string often = " set Interval in steps = 4\n set Largest imbalance = 1.02\n"
                          " set Work of a contact = 60\n",
                  never = " set Largest imbalance = 0\n set Work of a contact = 60\n",
                  fine  = " set Refined region = -2, -1, -0.3, 0.1",
                  refining =
                    " end\n subsection Adaptivity\n set Interval in steps = 10\n subsection "
                    "Criteria\n subsection near\n set Kind = contact distance\n"
                    " set Refine nearer than = 0.02\n set Highest level = 1\n end\n end\n end\n";

/// Largest difference of positions [m] and, times 1e-3 s, of velocities; and is every bit the same?
template <int dim>
void
compare(Coupling<dim> &many, Coupling<dim> &one, double &worst, bool &bits)
{
  const auto look = [&](const StructuralBody<dim> &mine, const StructuralBody<dim> &all) {
    std::map<std::uint64_t, unsigned int> node_of_key;
    for (unsigned int node = 0; node < all.mesh().n_nodes(); ++node)
      node_of_key[all.key(node)] = node;
    for (unsigned int node = 0; node < mine.mesh().n_nodes(); ++node)
      {
        const unsigned int other = node_of_key.at(mine.key(node));
        for (int d = 0; d < dim; ++d)
          bits = bits && same(mine.position(node)[d], all.position(other)[d]) &&
                 same(mine.velocity(node)[d], all.velocity(other)[d]);
        worst = std::max({worst,
                          mine.position(node).distance(all.position(other)),
                          1e-3 * (mine.velocity(node) - all.velocity(other)).norm()});
      }
  };
  look(many.structure.solids.front(), one.structure.solids.front());
  for (auto a = many.structure.rigids.begin(), b = one.structure.rigids.begin();
       a != many.structure.rigids.end();
       ++a, ++b)
    look(*a, *b);
  worst = mpi::max(worst, comm);
  bits  = !mpi::any(!bits, comm);
}

template <int dim>
double
imbalance(Coupling<dim> &coupling)
{
  return coupling.adaptivity.imbalance(coupling.points, coupling.structure, coupling.contacts);
}

/// Returns whether elements have gone to other ranks after the start.
template <int dim>
bool
come_down(const std::string &name,
          const std::string &root,
          const std::string &of_block,
          const unsigned int n_steps)
{
  const bool alone      = mpi::n_ranks(comm) == 1;
  const auto many       = make_coupling<dim>(text<dim>(often, root, of_block)),
             even       = make_coupling<dim>(text<dim>(never, root, of_block)),
             one        = make_coupling<dim>(text<dim>(often, root, of_block), MPI_COMM_SELF);
  const auto  &block    = many->structure.solids.front().mesh();
  const auto   changes  = block.n_changes();
  const double at_start = imbalance(*many), at_start_if_even = imbalance(*even);
  double       worst = 0, busiest = 0, busiest_if_even = 0;
  bool         bits       = true;
  unsigned int in_contact = 0;
  for (unsigned int step = 0; step < n_steps; ++step)
    {
      for (auto *coupling : {many.get(), even.get(), one.get()})
        coupling->advance(1.);
      compare(*many, *one, worst, bits);
      busiest += imbalance(*many);
      busiest_if_even += imbalance(*even);
      in_contact += many->contacts.report().n_contacts > 0;
    }
  deallog << dim << "-D, " << name << ": they touch " << (in_contact > n_steps / 2)
          << ", half as uneven at the start "
          << (at_start - 1 < 0.5 * (at_start_if_even - 1) || alone) << ", more even later "
          << (busiest < busiest_if_even || alone) << ", as on one rank " << (worst < 1e-10);
  if (!root.empty())
    deallog << ", in every bit " << bits;
  deallog << ", passed " << many->contacts.n_penetrations() << std::endl;
  return block.n_changes() > changes;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  const std::string bitwise = "set Reproducible = true\n";
  bool              later   = come_down<2>("uniform", "", " end\n", 30);
  later = come_down<2>("hanging nodes", bitwise, fine + "\n end\n", 30) || later;
  come_down<2>("refined on the way", "", refining, 30);
  later = come_down<3>("uniform", bitwise, " end\n", 16) || later;
  later = come_down<3>("hanging nodes",
                       bitwise,
                       " set Refined region = -2, -1, -1, -0.3, 0.1, 1\n end\n",
                       16) ||
          later;
  deallog << "shared out while the run went on: " << (later || mpi::n_ranks(comm) == 1)
          << std::endl;
}
