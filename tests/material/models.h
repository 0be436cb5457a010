// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/material/library.h>

#include <random>

/**
 * What the tests of the materials share: one of each model, and states to try it in.
 */
namespace coracle
{
inline std::vector<MaterialVariant>
all_models()
{
  const WeaklyCompressible water(1000, 50, 2e4), never_cut(1000, 50, 5e6);
  const Tait               tait(1000, 50, 7, 2e4), broken_power(1000, 50, 7.15, 0);
  const ElasticConstants   rubber(1100, 1e6, 0.4);
  return {Fluid<WeaklyCompressible, false>(water, 0, 0.06, 1.2),
          Fluid<WeaklyCompressible, true>(never_cut, 3., 0.06, 1.2),
          Fluid<Tait, false>(tait, 0, 0.06, 1.2),
          Fluid<Tait, true>(broken_power, 3., 0.06, 1.2),
          LinearElastic(rubber),
          NeoHookean(rubber)};
}

/// A smooth random number in [-1,1], the same on every machine.
inline double
random_number()
{
  static std::mt19937 generator(4711);
  return 2. * (generator() / 4294967296.) - 1.;
}

template <int dim>
Matrix<dim, double>
random_matrix(const double size)
{
  Matrix<dim, double> a;
  for (auto &row : a)
    for (double &entry : row)
      entry = size * random_number();
  return a;
}

/// A motion that starts from rest in F, with the density that follows from J.
template <int dim>
Motion<dim, double>
motion_at(const Matrix<dim, double> &deformation_gradient, const double reference_density)
{
  Motion<dim, double> motion{};
  motion.deformation_gradient = deformation_gradient;
  motion.density              = reference_density / determinant<dim, double>(deformation_gradient);
  motion.length               = 0.02;
  motion.dt                   = 1e-4;
  return motion;
}
} // namespace coracle
