// SPDX-License-Identifier: GPL-3.0-or-later
// Water on both faces of a thin plate that moves through refined cells: each side keeps its
// velocity to round-off while they pass each other; without the split, or beyond the plate's rim,
// they drag at each other and only the sum of their momenta is kept.
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

// The plate is y = 0.3 + 0.1 x up to x = end and moves upwards at 0.5 m/s; so does the water
// besides passing along it.
template <int dim>
std::string
text(const double end, const std::string &body, const std::string &contact)
{
  std::ostringstream points;
  points << "-0.1, 0.29, 0.2, 0.32, " << end << ", " << 0.3 + 0.1 * end;
  const auto water = [&](const std::string &name, const double side) {
    return " subsection " + name + "\n set Material = water\n set Particle spacing = 0.05\n" +
           " set Lower corner = " + numbers<dim>({0.3, side > 0 ? 0.4 : 0.1, 0.1}) +
           "\n set Upper corner = " + numbers<dim>({0.7, side > 0 ? 0.6 : 0.3, 0.3}) +
           "\n set Initial velocity = " + numbers<dim>({side, 0.5 + 0.1 * side, 0}) + "\n" + body +
           " end\n";
  };
  return "subsection Grid\n set Lower corner = " + numbers<dim>({0, 0, 0}) +
         "\n set Upper corner = " + numbers<dim>({1, 0.8, 0.4}) +
         "\n set Cell size = 0.1\n subsection Refinement\n subsection middle\n set Lower corner "
         "= " +
         numbers<dim>({0.4, 0.2, 0.1}) + "\n set Upper corner = " + numbers<dim>({0.6, 0.4, 0.2}) +
         "\n set Level = 1\n end\n end\nend\n"
         "subsection Materials\n subsection water\n set Model = weakly compressible\n set Sound "
         "speed = 10\n end\nend\nsubsection Contact\n" +
         contact + "end\nsubsection Bodies\n" + water("above", 1) + water("below", -1) +
         " subsection plate\n set Kind = rigid\n set Mass = 1\n set Motion = velocity\n set "
         "Velocity = " +
         (dim == 2 ? "0; 0.5" : "0; 0.5; 0") +
         "\n set Thickness = 1e-3\n subsection Mesh\n set Type = polyline\n set Points = " +
         points.str() + "\n set Subdivisions = 7\n" +
         (dim == 3 ? " set Length = 0.4\n set Subdivisions along z = 3\n" : "") +
         " end\n end\nend\n";
}

template <int dim>
void
pass(const std::string &name, const double end, const std::string &body, const std::string &contact)
{
  using Layout        = ParticleLayout<dim>;
  const auto coupling = make_coupling<dim>(text<dim>(end, body, contact));
  const auto momentum = [&] {
    dealii::Tensor<1, dim> sum;
    for (const auto &b : coupling->points.bodies)
      {
        const Totals<dim> totals(b.points);
        sum += totals.momentum;
      }
    // Less what the plate has given.
    for (const auto &given : coupling->contacts.contact_momentum())
      sum -= mpi::sum(given, comm);
    return sum;
  };
  const auto   before = momentum();
  unsigned int n_cut  = 0;
  for (unsigned int i = 0; i < 40; ++i)
    {
      coupling->advance(1e300);
      for (const auto &b : coupling->points.bodies)
        n_cut += mpi::sum(b.points.cuts.size(), comm);
    }
  double change = 0, side = 1;
  for (const auto &b : coupling->points.bodies)
    {
      for (std::size_t row = 0; row < b.points.n_rows(); ++row)
        if (!b.points.is_hole(row))
          for (int d = 0; d < dim; ++d)
            {
              const double v = d == 0 ? side : d == 1 ? 0.5 + 0.1 * side : 0.;
              change = std::max(change, std::fabs(b.points.column(Layout::velocity + d)[row] - v));
            }
      side = -side;
    }
  change           = mpi::max(change, comm);
  const auto &book = coupling->points.books();
  deallog << dim << "d, " << name << ": cuts " << n_cut << ", velocities kept " << (change < 1e-12)
          << ", drag " << (change > 0.01) << ", momentum kept "
          << ((momentum() - before).norm() < 1e-10 * before.norm()) << ", energy lost to the grid "
          << (std::fabs(mpi::sum(book.transfer, comm)) > 1e-10) << ", penetrations "
          << coupling->contacts.n_penetrations() << std::endl;
}

template <int dim>
void
test()
{
  const std::string gimp =
    " set Shape functions = gimp\n set Velocity transfer = apic\n set Volume strain = cell mean\n";
  pass<dim>("linear",
            1.1,
            " set Volume strain = cell mean\n set Mean pressure in forces = true\n",
            "");
  pass<dim>("gimp, apic", 1.1, gimp, "");
  pass<dim>("usf", 1.1, " set Stress update = usf\n", "");
  pass<dim>("not split", 1.1, "", " set Split fields = false\n");
  pass<dim>("half a plate", 0.5, "", "");
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
