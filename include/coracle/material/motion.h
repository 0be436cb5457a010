// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/tensor.h>

namespace coracle
{
/**
 * What a constitutive model is told about one step of one point, or of a pack
 * of points. Particles and elements fill it alike.
 */
template <int dim, typename T>
struct Motion
{
  /// L_ij = dv_i/dx_j at the middle of the step [1/s]; its trace may have been averaged over a
  /// cell.
  Matrix<dim, T> velocity_gradient;
  /// F at the end of the step [1]; filled only if Material::needs_deformation_gradient.
  Matrix<dim, T> deformation_gradient;
  /// Mass density at the end of the step [kg/m^3].
  T density;
  /// Size of the cell or element, for artificial bulk viscosity [m].
  T length;
  /// Step [s].
  double dt;
};

/**
 * A material is a class of this form (see weakly_compressible.h for one):
 *
 *   static constexpr const char *name, *description;
 *   static constexpr bool isotropic_stress;            // stress is -p I: a particle keeps only p
 *   static constexpr bool needs_deformation_gradient;
 *   static constexpr bool remembers_stress;            // the new stress depends on the old one, or
 * on history static constexpr int  n_history;                   // doubles a point keeps besides
 * the stress static void declare(Declaration &); static bool accepts(const Parameters &);   // is
 * this the variant that these entries of the model ask for? explicit Material(const Parameters &);
 * double reference_density() const; template <typename T> T sound_speed(const T &density) const; //
 * for the stable step double diffusivity() const;   // of momentum [m^2/s], for the stable step of
 * viscous flow
 *
 *   // Cauchy stress [Pa], tension positive: in the value at the start of the step, out at its end.
 *   template <int dim, typename T>
 *   void update(const Motion<dim, T> &motion, Symmetric<dim, T> &stress, T *history) const;
 *
 *   // isotropic_stress only: the pressure [Pa], compression positive
 *   template <int dim, typename T>
 *   T pressure(const Motion<dim, T> &motion) const;
 *
 *   // Recoverable energy per current volume [J/m^3] of a point
 *   template <int dim, typename T>
 *   T energy_density(const Motion<dim, T> &motion, const Symmetric<dim, T> &stress) const;
 */
} // namespace coracle
