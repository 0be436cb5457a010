// SPDX-License-Identifier: GPL-3.0-or-later
// The Taylor-Green vortex in a box full of viscous fluid decays as the exact solution does; the
// error falls with the square of the spacing and, with the time weight 1/2, of the step. Not too
// early: while the squares of the start are being cut up orders scatter from 1.8 to 2.2.
#include <coracle/base/mpi.h>

#include "tank.h"

using namespace tank;
using dealii::numbers::PI;

dealii::Tensor<1, 2>
vortex(const dealii::Point<2> &x)
{
  return dealii::Point<2>(std::sin(PI * x[0]) * std::cos(PI * x[1]),
                          -std::cos(PI * x[0]) * std::sin(PI * x[1]));
}

/// Root of the mean square error of velocity at t = 0.4, over the initial one.
double
error(const unsigned int n, const unsigned int n_steps, const double time_weight)
{
  auto options        = box<2>(n);
  options.gravity     = dealii::Tensor<1, 2>();
  options.viscosity   = 20;
  options.time_weight = time_weight;
  Fluid<2> fluid("oil", options, comm);
  fill<2>(fluid, {0, 0}, {1, 1}, {n, n}, 0., vortex);
  advance(fluid, n_steps, 0.4 / n_steps);
  double       square = 0, volume = 0;
  const double decay = std::exp(-2 * PI * PI * 0.02 * 0.4);
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      square += fluid.volume[i] *
                (fluid.velocity[i] - decay * vortex(fluid.points.position[i])).norm_square();
      volume += fluid.volume[i];
    }
  return std::sqrt(2 * mpi::sum(square, comm) / mpi::sum(volume, comm));
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  const double coarse = error(16, 32, 0.5), fine = error(32, 64, 0.5), first = error(32, 64, 1);
  deallog << "order of at least 1.9: " << (std::log2(coarse / fine) > 1.9)
          << ", error below 0.2 %: " << (fine < 2e-3)
          << ", of first order in time more: " << (first > 2 * fine) << std::endl;
}
