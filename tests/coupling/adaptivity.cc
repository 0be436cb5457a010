// SPDX-License-Identifier: GPL-3.0-or-later
// The octree changes while water stands and while it hits a body: water at rest stays at rest,
// momentum and particles are accounted for, none passes a surface, and results do not depend on the
// ranks.
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
grid(const std::string &criteria, const std::string &more = "")
{
  return "subsection Grid\n set Lower corner = " + numbers<dim>({0, 0, 0}) +
         "\n set Upper corner = " + numbers<dim>({1, 1, 1}) + "\n set Cell size = 0.125\n" + more +
         " subsection Adaptivity\n set Interval in steps = 10\n" + " subsection Criteria\n" +
         criteria + " end\n end\nend\n";
}

const std::string water =
  "subsection Materials\n subsection water\n set Model = weakly compressible\n"
  " set Sound speed = 30\n end\nend\n";

template <int dim>
double
largest_speed(const MaterialPoints<dim> &points)
{
  double result = 0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    for (int d = 0; d < dim; ++d)
      result = std::max(result, std::fabs(points.column(ParticleLayout<dim>::velocity + d)[row]));
  return mpi::max(result, comm);
}

// No two particles on any ranks have one id.
template <int dim>
bool
ids_differ(const MaterialPoints<dim> &points)
{
  std::map<unsigned int, std::vector<std::uint64_t>> mine;
  mine[0];
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      mine[0].push_back(points.id(row));
  std::vector<std::uint64_t> all;
  for (const auto &[rank, ids] : mpi::exchange_values(mine, comm))
    all.insert(all.end(), ids.begin(), ids.end());
  std::sort(all.begin(), all.end());
  return !mpi::any(std::adjacent_find(all.begin(), all.end()) != all.end(), comm);
}

template <int dim>
void
test_rest()
{
  const std::string up       = dim == 2 ? "y" : "z";
  const auto        coupling = make_coupling<dim>(
    "set Gravity = " + numbers<dim>({0, dim == 2 ? -10. : 0., -10}) + "\n" +
    grid<dim>(" subsection middle\n set Kind = function\n"
                     " set Function = if(abs(x - 0.5) < 0.3, -cos(20 * pi * t), -1)\n"
                     " set Refine above = 0.5\n set Coarsen below = -0.5\n end\n") +
    water +
    "subsection Bodies\n subsection water\n set Material = water\n set Particle spacing = 0.0625\n"
           " set Shape functions = gimp\n set Lower corner = " +
    numbers<dim>({0, 0, 0}) +
    "\n set Upper corner = " + numbers<dim>({1, dim == 2 ? 0.5 : 1, 0.5}) +
    "\n set Initial pressure = 1000 * 10 * (0.5 - " + up + ")\n end\nend\n");
  auto              &points = coupling->points.bodies.front().points;
  const Totals<dim>  start(points);
  const std::int64_t n_start = mpi::sum(coupling->points.n_particles(), comm);
  std::int64_t       most    = 0;
  double             speed   = 0;
  while (coupling->time() < 0.1)
    {
      coupling->advance(0.1);
      most  = std::max<std::int64_t>(most, mpi::sum(coupling->points.n_particles(), comm));
      speed = std::max(speed, largest_speed(points));
    }
  const Totals<dim>  now(points);
  const std::int64_t n_end = mpi::sum(coupling->points.n_particles(), comm);
  deallog << "at rest: particles " << n_start << ", " << most << ", " << n_end
          << ", ledger is closed " << (coupling->points.ledger_error() == 0) << ", ids differ "
          << ids_differ(points) << std::endl;
  // Falling freely it would have reached 1 m/s.
  deallog << "at rest: speed stays below 5 mm/s " << (speed < 5e-3) << ", mass is kept "
          << (std::fabs(now.mass - start.mass) < 1e-12 * start.mass)
          << ", centre stays within 0.1 mm " << ((now.centre - start.centre).norm() < 1e-4)
          << std::endl;
}

template <int dim>
std::string
drop()
{
  return "set Gravity =\n" +
         grid<dim>(
           " subsection near\n set Kind = distance to surfaces\n set Refine nearer than = 0.1\n"
           " end\n subsection surface\n set Kind = free surface\n set Refine within layers = 1\n"
           " end\n") +
         water +
         "subsection Bodies\n subsection water\n set Material = water\n set Particle spacing = "
         "0.0625\n"
         " set Lower corner = " +
         numbers<dim>({0.25, 0.25, 0.25}) +
         "\n set Upper corner = " + numbers<dim>({0.75, 0.5, 0.75}) +
         "\n set Initial velocity = " + numbers<dim>({0.5, 3, 0}) +
         "\n end\n subsection block\n set Kind = rigid\n set Mass = 200\n subsection Mesh\n set "
         "Type = box\n"
         " set Lower corner = " +
         numbers<dim>({0.3, 0.6, 0.3}) + "\n set Upper corner = " + numbers<dim>({0.6, 0.8, 0.6}) +
         "\n set Subdivisions = " + (dim == 2 ? "3, 2" : "3, 2, 3") + "\n end\n end\nend\n";
}

template <int dim>
void
test_drop()
{
  const auto        coupling = make_coupling<dim>(drop<dim>());
  auto             &points   = coupling->points.bodies.front().points;
  const Totals<dim> start(points);
  // Short of the faces of the box.
  const double end = 0.04;
  while (coupling->time() < end)
    coupling->advance(end);
  const Totals<dim> now(points);
  const auto        body   = coupling->structure.rigids.front().summary();
  const auto       &ledger = points.ledger;
  deallog << "drop: split " << (mpi::sum(ledger.split, comm) > 0) << ", ledger is closed "
          << (coupling->points.ledger_error() == 0) << ", ids differ " << ids_differ(points)
          << ", penetrations " << coupling->contacts.n_penetrations() << std::endl;
  deallog << "drop: mass is kept " << (std::fabs(now.mass - start.mass) < 1e-12 * start.mass)
          << ", momentum of all "
          << ((now.momentum + body.mass * body.velocity - start.momentum).norm() <
              1e-10 * start.momentum.norm())
          << ", the body moves " << (body.velocity.norm() > 0.1) << std::endl;
  // The contact solver stops at 1e-4 of the speeds.
  const auto rounded = [](const dealii::Tensor<1, dim> &vector) {
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = std::round(1000 * vector[d]) / 1000 + 0.;
    return result;
  };
  deallog << "drop: centre of the water " << rounded(now.centre) << ", velocity of the body "
          << rounded(body.velocity) << ", particles "
          << mpi::sum(coupling->points.n_particles(), comm) << ", cells "
          << mpi::sum(coupling->points.octree.n_owned_leaves(), comm) << std::endl;
  // Few particles in whole families of cells: it can't be much better.
  deallog << "drop: work is shared "
          << (coupling->adaptivity.imbalance(coupling->points,
                                             coupling->structure,
                                             coupling->contacts) < 1.5)
          << std::endl;
}

void
test_mistakes()
{
  const auto message = [](const std::string &criterion) {
    try
      {
        make_coupling<2>(grid<2>(" subsection near\n" + criterion + " end\n") + water);
      }
    catch (const UserError &error)
      {
        const std::string text = error.what();
        return text.substr(0, text.find('\n'));
      }
    return std::string("none");
  };
  deallog << message(" set Kind = distance to surfaces\n set Refine nearer than = 0.1\n")
          << std::endl;
  deallog << message(" set Kind = free surface\n") << std::endl;
  deallog << message(" set Kind = free surface\n set Refine within layers = 2\n"
                     " set Coarsen beyond layers = 2\n")
          << std::endl;
  deallog << message(
               " set Kind = free surface\n set Refine within layers = 2\n set Highest level = 0\n"
               " set Lowest level = 1\n")
          << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test_rest<2>();
  test_drop<2>();
  deallog.pop();
  deallog.push("3d");
  test_rest<3>();
  test_drop<3>();
  deallog.pop();
  test_mistakes();
}
