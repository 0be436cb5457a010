// SPDX-License-Identifier: GPL-3.0-or-later
// With Reproducible = true a coupled run is the same on several ranks as on one, in every bit of
// the state: through contact with rigid, elastic and thin bodies and among structures, friction,
// hanging nodes, adapted cells and the split and merged particles in them.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
std::string
numbers(const std::array<double, 3> &values)
{
  std::ostringstream text;
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << values[d];
  return text.str();
}

template <int dim>
std::string
box(const std::array<double, 3> &lower, const std::array<double, 3> &upper)
{
  return " set Lower corner = " + numbers<dim>(lower) +
         "\n set Upper corner = " + numbers<dim>(upper) + "\n";
}

/// A box of 1 m, its floor rough, and what things are made of.
template <int dim>
std::string
frame(const std::string &grid)
{
  return "set Reproducible = true\nset Gravity = " + numbers<dim>({0, -10, 0}) +
         "\nsubsection Grid\n" + box<dim>({0, 0, 0}, {1, 1, 1}) + " set Cell size = 0.125\n" +
         grid +
         "end\nsubsection Contact\n set Friction = 0.3\nend\nsubsection Materials\n"
         " subsection water\n set Model = weakly compressible\n set Sound speed = 30\n end\n"
         " subsection rubber\n set Model = neo-Hookean\n set Density = 1100\n"
         " set Young modulus = 3e5\n set Poisson ratio = 0.3\n end\nend\n";
}

template <int dim>
bool
same_particles(const MaterialPoints<dim> &mine, const MaterialPoints<dim> &all)
{
  std::map<std::uint64_t, std::size_t> row_of_id;
  for (std::size_t row = 0; row < all.n_rows(); ++row)
    if (!all.is_hole(row))
      row_of_id[all.id(row)] = row;
  std::uint64_t n      = 0;
  bool          result = true;
  for (std::size_t row = 0; row < mine.n_rows(); ++row)
    if (!mine.is_hole(row))
      {
        ++n;
        const auto found = row_of_id.find(mine.id(row));
        result           = result && found != row_of_id.end();
        for (unsigned int c = 0; result && c < mine.columns.n_columns(); ++c)
          result = same(mine.columns[c][row], all.columns[c][found->second]);
      }
  const bool complete = mpi::sum(n, comm) == row_of_id.size();
  return result && complete;
}

template <int dim>
bool
same_nodes(const StructuralBody<dim> &mine, const StructuralBody<dim> &all)
{
  std::map<std::uint64_t, unsigned int> node_of_key;
  for (unsigned int node = 0; node < all.mesh().n_nodes(); ++node)
    node_of_key[all.key(node)] = node;
  bool result = true;
  for (unsigned int node = 0; node < mine.mesh().n_nodes(); ++node)
    for (int d = 0; d < dim; ++d)
      {
        const unsigned int other = node_of_key.at(mine.key(node));
        result                   = result && same(mine.position(node)[d], all.position(other)[d]) &&
                 same(mine.velocity(node)[d], all.velocity(other)[d]);
      }
  return result;
}

/// Of this rank's part and the whole on one rank.
template <int dim>
bool
same_state(const Coupling<dim> &mine, const Coupling<dim> &all)
{
  bool result = same(mine.time(), all.time());
  for (auto a = mine.points.bodies.begin(), b = all.points.bodies.begin();
       a != mine.points.bodies.end();
       ++a, ++b)
    result = same_particles(a->points, b->points) && result;
  for (auto a = mine.structure.solids.begin(), b = all.structure.solids.begin();
       a != mine.structure.solids.end();
       ++a, ++b)
    result = same_nodes<dim>(*a, *b) && result;
  for (auto a = mine.structure.rigids.begin(), b = all.structure.rigids.begin();
       a != mine.structure.rigids.end();
       ++a, ++b)
    result = same_nodes<dim>(*a, *b) && result;
  return !mpi::any(!result, comm);
}

template <int dim>
void
compare(const std::string &name, const std::string &text, const unsigned int n_steps)
{
  const auto   many = make_coupling<dim>(text), one = make_coupling<dim>(text, MPI_COMM_SELF);
  unsigned int first_difference = 0, in_contact = 0, step = 0;
  for (step = 1; step <= n_steps && first_difference == 0; ++step)
    {
      many->advance(1e300);
      one->advance(1e300);
      in_contact += one->contacts.report().n_contacts > 0;
      if (!same_state(*many, *one))
        first_difference = step;
    }
  deallog << name << ": first step that differs " << first_difference << ", in contact "
          << (in_contact > n_steps / 2) << ", split and merged "
          << (one->points.bodies.front().points.ledger.split > 0) << ' '
          << (one->points.bodies.front().points.ledger.merged > 0) << ", penetrations "
          << one->contacts.n_penetrations() << std::endl;
}

/// Water falls on a rubber block with a refined corner, a free rigid one and a sheet.
template <int dim>
std::string
bodies(const std::string &water)
{
  const double z = dim == 2 ? 0 : 0.25;
  return "subsection Bodies\n subsection water\n set Material = water\n"
         " set Particle spacing = 0.0625\n" +
         box<dim>({0.125, 0.5625, 0.25}, {0.875, 0.8125, 0.75}) +
         " set Initial velocity = " + numbers<dim>({0.4, -4, 0}) + "\n" + water +
         " end\n subsection rubber\n set Kind = solid\n set Material = rubber\n"
         " set Thickness = 5 mm\n subsection Mesh\n set Type = box\n" +
         box<dim>({0.15, 0.26, z}, {0.45, 0.51, z + 0.4}) +
         " set Subdivisions = " + (dim == 2 ? "5, 4" : "5, 4, 5") +
         "\n set Refined region = " + numbers<dim>({0.25, 0.35, 0.4}) + ", " +
         numbers<dim>({0.6, 0.6, 0.8}) +
         "\n end\n end\n subsection float\n set Kind = rigid\n set Mass = 50\n"
         " set Thickness = 5 mm\n subsection Mesh\n set Type = box\n" +
         box<dim>({0.46, 0.3, z}, {0.74, 0.52, z + 0.4}) +
         " set Subdivisions = " + (dim == 2 ? "4, 3" : "4, 3, 4") + "\n end\n end\n";
}

/// Beside them, and in space from one side of the box to the other.
const std::string sheet = " subsection sheet\n set Kind = rigid\n set Density = 3000\n"
                          " set Thickness = 20 mm\n set Free directions = y\n subsection Mesh\n"
                          " set Type = polyline\n set Points = 0.76, 0.5, 0.95, 0.42\n"
                          " set Subdivisions = 3\n set Length = 1\n end\n end\n";

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  const std::string adaptivity =
    " subsection Adaptivity\n set Interval in steps = 7\n subsection Criteria\n subsection near\n"
    " set Kind = distance to surfaces\n set Refine nearer than = 0.1\n set Coarsen farther than = "
    "0.12\n"
    " end\n subsection force\n set Kind = contact force\n set Refine above contact pressure = "
    "1000\n"
    " set Coarsen below contact pressure = 10\n end\n end\n end\n subsection Load balance\n"
    " set Interval in steps = 13\n set Largest imbalance = 1.01\n end\n";
  compare<2>("plain", frame<2>("") + bodies<2>("") + sheet + "end\n", 100);
  compare<2>("adaptive",
             frame<2>(adaptivity) +
               bodies<2>(" set Shape functions = gimp\n set Velocity transfer = apic\n"
                         " set Volume strain = cell mean\n set Mean pressure in forces = true\n") +
               sheet + "end\n",
             100);
  compare<3>("in space",
             frame<3>(adaptivity) + bodies<3>(" set Stress update = usf\n") + sheet + "end\n",
             40);
}
