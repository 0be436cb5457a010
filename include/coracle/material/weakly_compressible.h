// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/pack.h>
#include <coracle/base/parameters.h>

namespace coracle
{
/**
 * Equation of state of a weakly compressible liquid,
 *
 *   p = max(c0^2 (rho - rho0), -p_tension)      [Pa], compression positive.
 *
 * Below the density at which the tension limit is met the pressure stays
 * constant: the liquid opens without breaking, and closes again by the same
 * path, so that the law remains a potential. The default limit is 0: free water
 * carries no tension, and a drop leaves a wall or a surface. A positive limit
 * smooths free surfaces, but lets the liquid stick to what it touches.
 *
 * Source: Song, Liu & Zhang (2020), Eq. 67; the limited tension as in Chen et
 * al. (2015), section 4.3.
 */
class WeaklyCompressible
{
public:
  static constexpr const char *name        = "weakly compressible";
  static constexpr const char *description = "liquid with p = c0^2 (rho - rho0)";

  static void declare(Declaration &declaration)
  {
    declaration.quantity(
      "Density", "1000", "kg/m^3", "rho_0", "density at which the pressure is zero", 1e-12);
    declaration.quantity("Sound speed",
                         "50",
                         "m/s",
                         "c_0",
                         "artificial speed of sound, about ten times the highest speed expected: "
                         "higher is stiffer and needs smaller steps",
                         1e-12);
    declaration.quantity("Tension limit",
                         "0",
                         "Pa",
                         "p_t",
                         "largest tension that the fluid carries; 0 for free liquids",
                         0.);
  }

  explicit WeaklyCompressible(const Parameters &parameters)
    : WeaklyCompressible(parameters.quantity("Density"),
                         parameters.quantity("Sound speed"),
                         parameters.quantity("Tension limit"))
  {}

  /// rho0 [kg/m^3], c0 [m/s], p_tension [Pa].
  WeaklyCompressible(const double density, const double sound_speed, const double tension_limit)
    : rho_0(density)
    , c_0(sound_speed)
    , p_t(tension_limit)
    , rho_cut(density - tension_limit / (sound_speed * sound_speed))
  {}

  double reference_density() const { return rho_0; }

  template <typename T>
  T sound_speed(const T &) const
  {
    return splat<T>(c_0);
  }

  /// @param density current density [kg/m^3]
  template <typename T>
  T pressure(const T &density) const
  {
    return max(T(c_0 * c_0 * (density - rho_0)), splat<T>(-p_t));
  }

  /// Elastic energy per current volume, rho * integral of p/rho^2 from rho0 to rho [J/m^3].
  template <typename T>
  T energy_density(const T &density) const
  {
    // Below the cut the integrand is that of a constant pressure: the energy there is linear in
    // rho.
    const T clipped = max(density, splat<T>(rho_cut > 0. ? rho_cut : 1e-300));
    const T x       = (clipped - rho_0) / rho_0;
    const T elastic =
      c_0 * c_0 *
      (clipped * each_lane(x, [](const double y) { return std::log1p(y); }) - rho_0 * x);
    return elastic * density / clipped - p_t * (density / clipped - 1.);
  }

private:
  double rho_0, c_0, p_t, rho_cut;
};
} // namespace coracle
