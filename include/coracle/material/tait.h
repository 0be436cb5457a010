// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/pack.h>
#include <coracle/base/parameters.h>

#include <cmath>

namespace coracle
{
/**
 * Tait's equation of state in Murnaghan's form, common for water,
 *
 *   p = max(rho0 c0^2 / gamma ((rho/rho0)^gamma - 1), -p_tension)   [Pa], compression positive.
 *
 * For the tension limit see WeaklyCompressible. Whole exponents are raised by
 * repeated squaring, all lanes at once; others lane by lane, some ten times
 * slower.
 *
 * Source: Murnaghan, Proc. Natl. Acad. Sci. 30 (1944) 244; gamma = 7 for water
 * as in Cole, Underwater Explosions (1948).
 */
class Tait
{
public:
  static constexpr const char *name = "Tait";
  static constexpr const char *description =
    "liquid with p = rho0 c0^2/gamma ((rho/rho0)^gamma - 1)";

  static void declare(Declaration &declaration)
  {
    declaration.quantity(
      "Density", "1000", "kg/m^3", "rho_0", "density at which the pressure is zero", 1e-12);
    declaration.quantity("Sound speed",
                         "50",
                         "m/s",
                         "c_0",
                         "artificial speed of sound at the reference density, about ten times the "
                         "highest speed expected: higher is stiffer and needs smaller steps",
                         1e-12);
    declaration.quantity("Exponent", "7", "1", "gamma", "growth of the bulk modulus", 1.001, 100.);
    declaration.quantity("Tension limit",
                         "0",
                         "Pa",
                         "p_t",
                         "largest tension that the fluid carries; 0 for free liquids",
                         0.);
  }

  explicit Tait(const Parameters &parameters)
    : Tait(parameters.quantity("Density"),
           parameters.quantity("Sound speed"),
           parameters.quantity("Exponent"),
           parameters.quantity("Tension limit"))
  {}

  /// rho0 [kg/m^3], c0 [m/s], gamma > 1 [1], p_tension [Pa].
  Tait(const double density,
       const double sound_speed,
       const double exponent,
       const double tension_limit)
    : rho_0(density)
    , c_0(sound_speed)
    , gamma(exponent)
    , p_t(tension_limit)
    , stiffness(density * sound_speed * sound_speed / exponent)
    , whole_gamma(std::round(exponent) == exponent ? static_cast<int>(exponent) : 0)
  {
    // A limit beyond -p(0) is never met.
    const double remaining = 1. - p_t / stiffness;
    cut_ratio              = remaining > 0. ? std::pow(remaining, 1. / gamma) : 0.;
  }

  double reference_density() const { return rho_0; }

  /// Square root of dp/drho above rho0, c0 below: a stretched point may be back at rho0 within a
  /// step.
  template <typename T>
  T sound_speed(const T &density) const
  {
    const T ratio = max(T(density / rho_0), splat<T>(1.));
    return c_0 * sqrt(T(raised(ratio) / ratio));
  }

  /// @param density current density [kg/m^3]
  template <typename T>
  T pressure(const T &density) const
  {
    return max(T(stiffness * (raised(T(density / rho_0)) - 1.)), splat<T>(-p_t));
  }

  /// Elastic energy per current volume, rho * integral of p/rho^2 from rho0 to rho [J/m^3].
  template <typename T>
  T energy_density(const T &density) const
  {
    const T ratio   = max(T(density / rho_0), splat<T>(cut_ratio > 0. ? cut_ratio : 1e-300));
    const T elastic = stiffness * ((raised(ratio) - ratio) / (gamma - 1.) + 1. - ratio);
    const T opening = density / (rho_0 * ratio);
    return elastic * opening - p_t * (opening - 1.);
  }

private:
  /// ratio^gamma; the branch is the same for every point of the body.
  template <typename T>
  T raised(const T &ratio) const
  {
    if (whole_gamma == 0)
      return pow(ratio, gamma);
    T result = splat<T>(1.), square = ratio;
    for (int n = whole_gamma; n > 0; n /= 2, square *= square)
      if (n % 2 == 1)
        result *= square;
    return result;
  }

  double rho_0, c_0, gamma, p_t, stiffness, cut_ratio = 0;
  int    whole_gamma;
};
} // namespace coracle
