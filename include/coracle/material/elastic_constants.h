// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>

namespace coracle
{
/// The constants that isotropic elastic solids share, as entries and as Lame's.
struct ElasticConstants
{
  static void declare(Declaration &declaration)
  {
    declaration.quantity("Density", "7850", "kg/m^3", "rho_0", "density without stress", 1e-12);
    declaration.quantity("Young modulus", "210 GPa", "Pa", "E", "stiffness in tension", 1e-12);
    declaration.quantity(
      "Poisson ratio", "0.3", "1", "nu", "lateral contraction, below 0.5", -0.999, 0.4999);
  }

  explicit ElasticConstants(const Parameters &parameters)
    : ElasticConstants(parameters.quantity("Density"),
                       parameters.quantity("Young modulus"),
                       parameters.quantity("Poisson ratio"))
  {}

  /// rho0 [kg/m^3], E [Pa], nu [1].
  ElasticConstants(const double density, const double young_modulus, const double poisson_ratio)
    : density(density)
    , young_modulus(young_modulus)
    , poisson_ratio(poisson_ratio)
    , lambda(young_modulus * poisson_ratio / ((1. + poisson_ratio) * (1. - 2. * poisson_ratio)))
    , mu(young_modulus / (2. * (1. + poisson_ratio)))
  {}

  double density, young_modulus, poisson_ratio, lambda, mu;
};
} // namespace coracle
