// SPDX-License-Identifier: GPL-3.0-or-later
// Meshless fluids in a box, for the tests of its step.
#pragma once

#include <coracle/meshless/fluid.h>

#include "../tests.h"
#include <random>

namespace tank
{
using namespace coracle;
using namespace coracle::meshless;

const MPI_Comm comm = MPI_COMM_WORLD;

/// A box of unit width, slip walls all around, points 1/n apart.
template <int dim>
FluidOptions<dim>
box(const unsigned int n)
{
  FluidOptions<dim> options;
  options.spacing             = 1. / n;
  options.solver.tolerance    = 1e-12;
  options.gravity[dim - 1]    = -10;
  options.tessellation.alpha  = 1.5;
  options.surface_alpha       = dim == 2 ? 0.85 : 1.05;
  options.refill.longest_edge = 1.9;
  options.volume_relaxation   = 0;
  dealii::Point<dim> upper;
  for (unsigned int d = 0; d < dim; ++d)
    upper[d] = 1;
  options.box = dealii::BoundingBox<dim>({dealii::Point<dim>(), upper});
  return options;
}

/// Region of a place.
template <int dim>
using Regions = std::function<unsigned int(const dealii::Point<dim> &)>;

/// Is a place on the rim of a region, along axes?
template <int dim>
bool
on_rim(const Regions<dim> &region, const dealii::Point<dim> &x, const double spacing)
{
  for (unsigned int d = 0; region && d < dim; ++d)
    for (const double way : {-spacing, spacing})
      if (auto y = x; y[d] += way, region(x) > 0 && region(y) != region(x))
        return true;
  return false;
}

template <int dim>
dealii::Point<dim>
corner(const double x, const double height)
{
  dealii::Point<dim> p;
  for (unsigned int d = 0; d < dim; ++d)
    p[d] = d + 1 == dim ? height : x;
  return p;
}

template <int dim>
std::array<unsigned int, dim>
intervals(const unsigned int n, const unsigned int up)
{
  std::array<unsigned int, dim> result;
  result.fill(n);
  result[dim - 1] = up;
  return result;
}

template <int dim>
dealii::Tensor<1, dim>
rest(const dealii::Point<dim> &)
{
  return {};
}

/**
 * Points of a lattice from `lower` to `upper`, numbers of intervals `n`, those inside, and not on
 * the rim of a region, displaced at random by a share of the spacing; each rank takes every so
 * many-th.
 */
template <int dim, typename Velocity>
void
fill(Fluid<dim>                          &fluid,
     const dealii::Point<dim>            &lower,
     const dealii::Point<dim>            &upper,
     const std::array<unsigned int, dim> &n,
     const double                         share,
     const Velocity                      &velocity,
     const Regions<dim>                  &region = {})
{
  std::mt19937_64 engine(1);
  unsigned int    n_points = 1;
  for (const unsigned int m : n)
    n_points *= m + 1;
  for (unsigned int id = 0; id < n_points; ++id)
    {
      dealii::Point<dim> x;
      bool               inside = true;
      for (unsigned int d = 0, rest = id; d < dim; rest /= n[d] + 1, ++d)
        {
          const unsigned int i = rest % (n[d] + 1);
          x[d]                 = lower[d] + (upper[d] - lower[d]) * i / n[d];
          inside &= i > 0 && i < n[d];
        }
      const unsigned int of = region ? region(x) : 0;
      inside &= !on_rim(region, x, fluid.options.spacing);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double random = std::uniform_real_distribution<>(-share, share)(engine);
          if (inside)
            x[d] += random * fluid.options.spacing;
        }
      if (id % mpi::n_ranks(comm) == mpi::rank(comm))
        fluid.add_point(x, velocity(x), id, of);
    }
  fluid.remesh();
}

template <int dim>
void
advance(Fluid<dim> &fluid, const unsigned int n_steps, const double dt)
{
  TimingTable timed;
  for (unsigned int step = 0; step < n_steps; ++step)
    {
      fluid.advance(step * dt, dt, timed);
      fluid.refill();
      fluid.remesh();
    }
}
} // namespace tank
