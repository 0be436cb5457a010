// SPDX-License-Identifier: GPL-3.0-or-later
// Regions of a meshless fluid: layers of different density and viscosity at rest have their exact
// pressure; a blob a thousand million times as viscous as water turns as a rigid body and keeps its
// shape, and falls as a stone does; two layers in a channel have the exact velocities; a region
// that is drawn out gets points of its own; a blob that dips into water does so on any number of
// ranks alike.
#include <coracle/base/mpi.h>

#include "tank.h"

using namespace tank;

/// Mud, water and oil above each other.
template <int dim>
void
layers()
{
  const unsigned int n       = dim == 2 ? 16 : 8;
  auto               options = box<dim>(n);
  options.viscosity          = 0.001;
  options.regions            = {{"oil", 300, 5}, {"mud", 2500, 1000}};
  Fluid<dim> fluid("water", options, comm);
  fill<dim>(fluid,
            corner<dim>(0, 0),
            corner<dim>(1, 0.75),
            intervals<dim>(n, 3 * n / 4),
            0.2,
            rest<dim>,
            [](const auto &x) {
              const double y = x[dim - 1];
              return y < 0.25 + 1e-9 ? 2u : y > 0.5 - 1e-9 ? 1u : 0u;
            });
  advance(fluid, 3, 0.01);
  double worst = 0, fastest = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      const double y     = fluid.points.position[i][dim - 1];
      const double exact = y > 0.5    ? 3000 * (0.75 - y)
                           : y > 0.25 ? 750 + 1e4 * (0.5 - y)
                                      : 3250 + 25000 * (0.25 - y);
      worst              = std::max(worst, std::fabs(fluid.pressure[i] - exact) / 9500);
      fastest            = std::max(fastest, fluid.velocity[i].norm());
    }
  const double mass = fluid.summary().mass / 950 - 1;
  deallog << "layers: pressure to 1e-9 " << (mpi::max(worst, comm) < 1e-9) << ", at rest "
          << (mpi::max(fastest, comm) < 1e-9) << ", their mass " << (std::fabs(mass) < 1e-12)
          << std::endl;
}

/// Velocity of a turn about the middle of the box with 1 rad/s, and a fall.
template <int dim>
dealii::Tensor<1, dim>
turn(const dealii::Point<dim> &x, const double fall)
{
  dealii::Tensor<1, dim> v;
  v[0]       = -(x[dim - 1] - 0.5);
  v[dim - 1] = x[0] - 0.5 + fall;
  return v;
}

/// Of all points: momentum about their centre over that of one radian per second, and the largest
/// change of a distance to the centre against the start, over the spacing.
template <int dim>
std::pair<double, double>
spin(const Fluid<dim> &fluid, std::map<std::uint64_t, double> &distance)
{
  const auto of     = fluid.summary();
  double     moment = 0, inertia = 0, worst = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      const auto r = fluid.points.position[i] - of.centre;
      const auto v = fluid.velocity[i] - of.velocity;
      moment += fluid.mass[i] * (r[0] * v[dim - 1] - r[dim - 1] * v[0]);
      inertia += fluid.mass[i] * (r[0] * r[0] + r[dim - 1] * r[dim - 1]);
    }
  std::map<std::uint64_t, double> here;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    here[fluid.points.id[i]] = fluid.points.position[i].distance(of.centre);
  std::map<std::uint64_t, double> all;
  for (const auto &there : dealii::Utilities::MPI::all_gather(comm, here))
    all.insert(there.begin(), there.end());
  if (distance.empty())
    distance = all;
  for (const auto &[id, d] : all)
    worst = std::max(worst, std::fabs(d - distance.at(id)) / fluid.options.spacing);
  return {mpi::sum(moment, comm) / mpi::sum(inertia, comm), worst};
}

template <int dim>
void
rigid()
{
  const unsigned int n       = dim == 2 ? 16 : 8;
  auto               options = box<dim>(n);
  options.time_weight        = 0.5;
  options.viscosity          = 0.001;
  options.regions            = {{"stone", 2000, 1e6}};
  Fluid<dim> fluid("water", options, comm);
  fill<dim>(
    fluid,
    corner<dim>(0.25, 0.25),
    corner<dim>(0.75, 0.75),
    intervals<dim>(n / 2, n / 2),
    dim == 2 ? 0.1 : 0.,
    [](const auto &x) { return turn<dim>(x, 0.); },
    [](const auto &) { return 1u; });
  std::map<std::uint64_t, double> distance;
  const auto                      start = spin(fluid, distance);
  const double                    top   = fluid.summary().centre[dim - 1];
  const unsigned int              steps = 10;
  advance(fluid, steps, 0.01);
  const auto   end  = spin(fluid, distance);
  const auto   now  = fluid.summary();
  const double t    = 0.01 * steps;
  const double drop = (top - now.centre[dim - 1]) / (5 * t * t) - 1,
               gain = -now.velocity[dim - 1] / (10 * t) - 1;
  deallog << "a viscous blob falls as a stone: " << (std::fabs(drop) < 1e-8)
          << (std::fabs(gain) < 1e-8)
          << ", keeps its spin: " << (std::fabs(end.first / start.first - 1) < 1e-4)
          << ", and its shape: " << (end.second < 1e-3)
          << ", it is solved for: " << (fluid.unconverged_viscous_solves == 0) << std::endl;
}

/// Two layers driven along a periodic channel: mu u' is linear in y, and the layers share u and it.
void
channel()
{
  const unsigned int n       = 16;
  auto               options = box<2>(n);
  options.gravity            = dealii::Tensor<1, 2>();
  options.walls              = {{Wall::open, Wall::open, Wall::stick, Wall::stick}};
  options.periodic           = {{true, false}};
  options.time_weight        = 0.5;
  options.viscosity          = 50;
  options.regions            = {{"syrup", 1000, 5000}};
  const double a = 5000, b = 50, f = 1000;
  // mu u' = s - f y; u(0) = u(1) = 0.
  const double s     = f * (0.125 / a + 0.375 / b) / (0.5 / a + 0.5 / b);
  const auto   exact = [&](const double y) {
    return y < 0.5 ? (s * y - f * y * y / 2) / a : (-s * (1 - y) + f * (1 - y * y) / 2) / b;
  };
  Fluid<2> fluid("water", options, comm);
  fluid.body_force =
    std::make_shared<dealii::Functions::ConstantFunction<2>>(std::vector<double>{1., 0.});
  fill<2>(
    fluid,
    {0, 0},
    {1 - 1. / n, 1},
    {n - 1, n},
    0.,
    [&](const auto &x) { return dealii::Point<2>(exact(x[1]), 0.); },
    [](const auto &x) { return x[1] < 0.5 + 1e-9 ? 1u : 0u; });
  advance(fluid, 8, 0.02);
  double worst = 0, fastest = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      const double u = exact(fluid.points.position[i][1]);
      worst          = std::max(worst, std::fabs(fluid.velocity[i][0] - u));
      fastest        = std::max(fastest, u);
    }
  worst = mpi::max(worst, comm) / mpi::max(fastest, comm);
  deallog << "two layers in a channel to 1 %: " << (worst < 0.01) << std::endl;
}

/// All of a fluid is a region, and drawn out.
void
stretch()
{
  auto options    = box<2>(16);
  options.gravity = dealii::Tensor<1, 2>();
  options.regions = {{"oil", 800, 0.1}};
  Fluid<2> fluid("water", options, comm);
  fill<2>(
    fluid,
    {0.3, 0.3},
    {0.7, 0.7},
    {{6, 6}},
    0.,
    [](const auto &x) { return dealii::Point<2>(3 * (x[0] - 0.5), -3 * (x[1] - 0.5)); },
    [](const auto &) { return 1u; });
  advance(fluid, 20, 0.01);
  const double share = fluid.region_summaries()[0].volume / fluid.summary().volume;
  deallog << "what is drawn out gets points: " << (fluid.counts.inserted > 0)
          << ", and stays what it is: " << (std::fabs(share - 1) < 1e-12) << std::endl;
}

/// A light stone is thrown into water.
template <int dim>
void
dip()
{
  const unsigned int n       = dim == 2 ? 20 : 10;
  auto               options = box<dim>(n);
  options.tessellation.alpha = 1.3;
  options.volume_relaxation  = 0.1;
  options.regions            = {{"stone", 400, 1e6}};
  Fluid<dim> fluid("water", options, comm);
  fill<dim>(
    fluid, corner<dim>(0, 0), corner<dim>(1, 0.3), intervals<dim>(n, 3 * n / 10), 0., rest<dim>);
  const auto at = corner<dim>(0.3, 0.4), to = corner<dim>(0.7, 0.8);
  const auto down = [](const dealii::Point<dim> &) {
    return -2 * dealii::Point<dim>::unit_vector(dim - 1);
  };
  Fluid<dim> stone("stone", options, comm);
  fill<dim>(stone, at, to, intervals<dim>(4 * n / 10, 4 * n / 10), 0., down, [](const auto &) {
    return 1u;
  });
  for (std::size_t i = 0; i < stone.points.n_own; ++i)
    fluid.add_point(stone.points.position[i], stone.velocity[i], 100000 + stone.points.id[i], 1);
  fluid.remesh();
  const auto start = fluid.region_summaries()[0];
  advance(fluid, 8, 0.01);
  const auto end = fluid.region_summaries()[0];
  deallog << "a stone that dips, in percent: fallen by "
          << 100 * (start.centre - end.centre)[dim - 1] << ", velocity "
          << 100 * end.velocity[dim - 1] << ", volume " << 100 * end.volume / start.volume
          << "; points put in and taken out " << fluid.counts.inserted << ' '
          << fluid.counts.taken_out << ", all solved "
          << (fluid.unconverged_solves + fluid.unconverged_viscous_solves == 0) << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  layers<dim>();
  rigid<dim>();
  dip<dim>();
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  stretch();
  channel();
  test<3>();
}
