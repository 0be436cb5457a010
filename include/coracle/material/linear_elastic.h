// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/material/elastic_constants.h>
#include <coracle/material/motion.h>
#include <coracle/material/rotation.h>

namespace coracle
{
/**
 * Isotropic linear elasticity in rate form: the Jaumann rate of the Cauchy
 * stress is linear in the rate of deformation, D = sym(L),
 *
 *   sigma_new = R (sigma_old + C/2) R^T + C/2,     C = lambda tr(D dt) I + 2 mu D dt,
 *
 * with R the incremental rotation of Hughes & Winget, so that a rigid rotation
 * of any size turns the stress and adds nothing (with the mid-step gradient,
 * see rotation.h). Half of the change is added before the rotation and half
 * after it, which makes stretch and rotation together second order in the step.
 * For small strain and any rotation; at strains beyond some ten per cent the
 * rate form is not the derivative of an energy, and NeoHookean is the better
 * choice. Plane strain keeps sigma_zz.
 *
 * Source: Hughes & Winget, Int. J. Numer. Meth. Engng 15 (1980) 1862.
 */
class LinearElastic
{
public:
  static constexpr const char *name             = "linear elastic";
  static constexpr const char *description      = "isotropic solid, small strain, large rotation";
  static constexpr bool        isotropic_stress = false;
  static constexpr bool        needs_deformation_gradient = false;
  static constexpr bool        remembers_stress           = true;
  static constexpr int         n_history                  = 0;

  static void declare(Declaration &declaration) { ElasticConstants::declare(declaration); }
  static bool accepts(const Parameters &) { return true; }

  explicit LinearElastic(const Parameters &parameters) : constants(parameters) {}
  explicit LinearElastic(const ElasticConstants &constants) : constants(constants) {}

  double reference_density() const { return constants.density; }
  double diffusivity() const { return 0.; }

  /// Of pressure waves.
  template <typename T>
  T sound_speed(const T &density) const
  {
    return sqrt(T((constants.lambda + 2. * constants.mu) / density));
  }

  template <int dim, typename T>
  void update(const Motion<dim, T> &motion, Symmetric<dim, T> &stress, T *) const
  {
    const Symmetric<dim, T> rate        = symmetric_part<dim, T>(motion.velocity_gradient);
    const T                 mean_change = (0.5 * constants.lambda * motion.dt) * rate.trace();
    Symmetric<dim, T>       half_change;
    for (int i = 0; i < stress.size; ++i)
      half_change[i] = (constants.mu * motion.dt) * rate[i];
    for (int i = 0; i < 3; ++i)
      half_change[i] += mean_change;

    for (int i = 0; i < stress.size; ++i)
      stress[i] += half_change[i];
    stress =
      rotated<dim, T>(stress, incremental_rotation<dim, T>(motion.velocity_gradient, motion.dt));
    for (int i = 0; i < stress.size; ++i)
      stress[i] += half_change[i];
  }

  /// 1/2 sigma : C^-1 : sigma [J/m^3].
  template <int dim, typename T>
  T energy_density(const Motion<dim, T> &, const Symmetric<dim, T> &stress) const
  {
    T squares = T{};
    for (int i = 0; i < stress.size; ++i)
      squares += (i < 3 ? 1. : 2.) * stress[i] * stress[i];
    const T trace = stress.trace();
    return (0.5 / constants.young_modulus) *
           ((1. + constants.poisson_ratio) * squares - constants.poisson_ratio * trace * trace);
  }

private:
  ElasticConstants constants;
};
} // namespace coracle
