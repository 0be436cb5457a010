// SPDX-License-Identifier: GPL-3.0-or-later
// Material points alone through whole steps: free fall is exact, momentum is kept, the energy books
// close, and a particle that leaves through a closed face is named on all ranks.
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
block(const std::string &extra, const std::string &material, const std::string &largest_step)
{
  return "set Gravity = " + numbers<dim>({0, dim == 2 ? -10. : 0., -10.}) +
         "\nsubsection Time\n set Largest step = " + largest_step +
         "\nend\nsubsection Grid\n set Lower corner = " + numbers<dim>({0, 0, 0}) +
         "\n set Upper corner = " + numbers<dim>({1, 1, 1}) +
         "\n set Cell size = 0.125\n subsection Refinement\n subsection middle\n set Lower corner "
         "= " +
         numbers<dim>({0.4, 0.4, 0.4}) + "\n set Upper corner = " + numbers<dim>({0.6, 0.6, 0.6}) +
         "\n set Level = 1\n end\n end\nend\n"
         "subsection Materials\n subsection stuff\n" +
         material +
         " end\nend\n"
         "subsection Bodies\n subsection block\n set Material = stuff\n set Particle spacing = "
         "0.0625\n"
         " set Lower corner = " +
         numbers<dim>({0.25, 0.375, 0.375}) +
         "\n set Upper corner = " + numbers<dim>({0.625, 0.75, 0.75}) + "\n" + extra +
         " end\nend\n";
}

const std::string water = " set Model = weakly compressible\n set Sound speed = 50\n";
const std::string rubber =
  " set Model = neo-Hookean\n set Density = 1000\n set Young modulus = 1e6\n"
  " set Poisson ratio = 0.3\n";

template <int dim>
void
test_free_fall()
{
  using Layout = ParticleLayout<dim>;
  for (const std::string update : {"musl", "usf", "usl"})
    for (const std::string shape : {"linear", "gimp"})
      for (const std::string transfer : {"flip", "apic"})
        {
          const auto coupling = make_coupling<dim>(
            block<dim>(" set Stress update = " + update + " \n set Shape functions = " + shape +
                         "\n set Velocity transfer = " + transfer + "\n",
                       water,
                       "2 ms"));
          auto             &points = coupling->points.bodies.front().points;
          const Totals<dim> start(points);
          const double      balance = energy_balance(*coupling);
          // v = g t, and with velocities at the ends of steps x = g dt^2 (1 + 2 + ... + n).
          const double end = 0.05;
          double       v = 0, fallen = 0;
          while (coupling->time() < end)
            {
              coupling->advance(end);
              v += 10 * coupling->last_step();
              fallen += v * coupling->last_step();
            }
          const Totals<dim> now(points);
          double            error = 0;
          for (std::size_t row = 0; row < points.n_rows(); ++row)
            if (!points.is_hole(row))
              error = std::max(error,
                               std::fabs(points.column(Layout::velocity + dim - 1)[row] + v) +
                                 std::fabs(points.column(Layout::density)[row] / 1000 - 1));
          deallog << update << ' ' << shape << ' ' << transfer << ": "
                  << (mpi::max(error, comm) < 1e-12) << ' ' << (std::fabs(v - 10 * end) < 1e-13)
                  << ' ' << (std::fabs(now.momentum[dim - 1] / start.mass + v) < 1e-12) << ' '
                  << (std::fabs(start.centre[dim - 1] - now.centre[dim - 1] - fallen) < 1e-13)
                  << ' ' << (std::fabs(energy_balance(*coupling) - balance) < 1e-11 * start.mass)
                  << std::endl;
        }
}

// A block at 1 m/s into a wall, elastic: what the balance of energy lacks goes to zero with the
// step.
template <int dim>
void
test_bounce()
{
  for (const std::string update : {"musl", "usf", "usl"})
    {
      std::array<double, 2> lack{};
      bool                  stopped = true, closed = true;
      for (const unsigned int i : {0, 1})
        {
          std::string text =
            block<dim>(" set Stress update = " + update +
                         "\n set PIC fraction = 0\n set Volume strain = particle\n" +
                         "set Initial velocity = " + numbers<dim>({-2, 0, 0}) + "\n",
                       rubber,
                       i == 0 ? "0.2 ms" : "0.1 ms");
          text.replace(text.find("set Gravity"), text.find('\n'), "");
          const auto        coupling = make_coupling<dim>(text);
          const Totals<dim> start(coupling->points.bodies.front().points);
          const double      balance = energy_balance(*coupling);
          while (coupling->time() < 0.09 - 1e-12)
            coupling->advance(0.09);
          const Totals<dim> now(coupling->points.bodies.front().points);
          lack[i] = std::fabs(energy_balance(*coupling) - balance) / balance;
          stopped = stopped && now.momentum[0] > -start.mass;
          for (int d = 1; d < dim; ++d)
            closed = closed && std::fabs(now.momentum[d]) < 1e-10 * start.mass;
        }
      deallog << update << ": is stopped " << stopped << ", along the wall nothing " << closed
              << ", balance to 1 % " << (lack[0] < 0.01) << ", better with half the step "
              << (lack[1] < 0.6 * lack[0]) << std::endl;
    }
}

template <int dim>
void
test_lost()
{
  using Layout        = ParticleLayout<dim>;
  const auto coupling = make_coupling<dim>(block<dim>("", water, "1 ms"));
  auto      &body     = coupling->points.bodies.front();
  coupling->advance(1.);
  for (std::size_t row = 0; row < body.points.n_rows(); ++row)
    if (body.points.id(row) == 7 && !body.points.is_hole(row))
      body.points.column(Layout::next_position + 1)[row] = 1.5;
  coupling->points.locate(coupling->time());
  deallog << "ranks that saw it: " << mpi::sum<unsigned int>(bool(coupling->points.failure), comm)
          << std::endl;
  bool named = false;
  try
    {
      coupling->advance(1.);
    }
  catch (const RunFailure &failure)
    {
      named = failure.details.find("particle 7 of 'block'") != std::string::npos &&
              failure.details.find("face 'y max' is not open") != std::string::npos;
    }
  deallog << "all ranks stop and name it: "
          << (mpi::sum<unsigned int>(named, comm) == mpi::n_ranks(comm)) << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  test_free_fall<dim>();
  test_bounce<dim>();
  test_lost<dim>();
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
