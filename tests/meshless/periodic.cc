// SPDX-License-Identifier: GPL-3.0-or-later
// Through a periodic face water with a free surface moves on as a rigid body, with its volume and
// velocity to the solver's tolerance; a channel driven by a body force has the exact velocity with
// second order in spacing and, with the time weight 1/2, in the step; on any number of ranks alike.
#include <coracle/base/mpi.h>

#include "tank.h"

using namespace tank;
using dealii::numbers::PI;

/// A lattice in a box of unit width, n points in each periodic direction, displaced at random
/// inside.
template <int dim, typename Velocity>
void
fill_periodic(Fluid<dim>        &fluid,
              const unsigned int n,
              const double       height,
              const double       share,
              const Velocity    &velocity)
{
  std::mt19937_64                  engine(1);
  std::uniform_real_distribution<> shift(-share / n, share / n);
  const unsigned int               rows     = std::lround(height * n) + 1;
  const auto                       n_points = std::lround(std::pow(n, dim - 1) * rows);
  for (unsigned int id = 0; id < n_points; ++id)
    {
      dealii::Point<dim> x, moved;
      for (unsigned int d = 0, rest = id; d < dim; ++d)
        {
          const unsigned int m = d == dim - 1 ? rows : n;
          x[d]                 = double(rest % m) / n;
          rest /= m;
          moved[d] = x[d] + shift(engine);
        }
      // Points of the floor and of the surface stay there.
      const unsigned int row = id / std::lround(std::pow(n, dim - 1));
      if (row == 0 || row == rows - 1)
        moved[dim - 1] = x[dim - 1];
      if (id % mpi::n_ranks(comm) == mpi::rank(comm))
        fluid.add_point(moved, velocity(moved), id);
    }
  fluid.remesh();
}

template <int dim>
FluidOptions<dim>
periodic_box(const unsigned int n)
{
  auto options        = box<dim>(n);
  options.time_weight = 0.5;
  for (unsigned int d = 0; d + 1 < dim; ++d)
    {
      options.periodic[d]  = true;
      options.walls[2 * d] = options.walls[2 * d + 1] = Wall::open;
    }
  return options;
}

template <int dim>
void
carry()
{
  const unsigned int     n       = dim == 2 ? 20 : 10;
  auto                   options = periodic_box<dim>(n);
  dealii::Tensor<1, dim> speed;
  speed[0] = 1;
  if (dim == 3)
    speed[1] = -0.7;
  options.refill.enabled = false;
  Fluid<dim> fluid("water", options, comm);
  fill_periodic<dim>(fluid, n, 0.5, 0.2, [&](const auto &) { return speed; });
  const double volume = fluid.summary().volume;
  advance(fluid, 40, 0.2 / n);
  double change = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    change = std::max(change, (fluid.velocity[i] - speed).norm());
  change             = mpi::max(change, comm);
  const auto summary = fluid.summary();
  deallog << dim << "-D: volume 0.5: " << (std::fabs(volume - 0.5) < 1e-12)
          << ", drift below 1e-9: " << (std::fabs(summary.volume - volume) < 1e-9)
          << ", change of velocity below 1e-8: " << (change < 1e-8)
          << ", surface at the top only: " << (summary.n_free == std::lround(std::pow(n, dim - 1)))
          << ", points left " << fluid.counts.left
          << ", appeared below 1e-9: " << (fluid.volume_appeared < 1e-9) << std::endl;
}

double
exact(const double y, const double t)
{
  return 2.5 * y * (1 - y) - 0.4 * std::sin(PI * y) * std::exp(-0.2 * PI * PI * t);
}

/// Root of the mean square error over that of the velocity, at t = 0.4; nu = 0.2, f = 1.
double
channel_error(const unsigned int n, const unsigned int n_steps, const double time_weight)
{
  auto options     = periodic_box<2>(n);
  options.walls[2] = options.walls[3] = Wall::stick;
  options.gravity                     = dealii::Point<2>(1, 0);
  options.viscosity                   = 200;
  options.time_weight                 = time_weight;
  Fluid<2> fluid("oil", options, comm);
  fill_periodic<2>(fluid, n, 1, 0.2, [](const auto &x) {
    return dealii::Point<2>(exact(x[1], 0), 0);
  });
  advance(fluid, n_steps, 0.4 / n_steps);
  double square = 0, size = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      const dealii::Point<2> right(exact(fluid.points.position[i][1], 0.4), 0);
      square += fluid.volume[i] * (fluid.velocity[i] - right).norm_square();
      size += fluid.volume[i] * right.norm_square();
    }
  return std::sqrt(mpi::sum(square, comm) / mpi::sum(size, comm));
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  carry<2>();
  carry<3>();
  const double coarse = channel_error(10, 5, 0.5), fine = channel_error(20, 10, 0.5),
               first = channel_error(20, 10, 1);
  deallog << "channel: order of at least 1.8: " << (std::log2(coarse / fine) > 1.8)
          << ", error below 0.3 %: " << (fine < 3e-3)
          << ", of first order in time more: " << (first > 3 * fine) << std::endl;
}
