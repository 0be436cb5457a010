// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/tensor.h>

namespace coracle
{
/// What a body's particles carry, decided once by its material and options.
struct ParticleNeeds
{
  /// Stress is -p I: one column of pressure instead of the tensor.
  bool isotropic_stress     = false;
  bool deformation_gradient = false;
  /// Doubles of material history.
  int n_history = 0;
  /// Affine velocity (APIC).
  bool affine = false;
  /// Surfaces that a particle may touch.
  bool touches = false;
  /// Surfaces with material on both sides, of which a particle must know its own.
  int n_sheets = 0;
};

/**
 * Numbers of the first column of each quantity; -1 if the body has none.
 * All columns are doubles, so that a row migrates and restarts as it is; ids
 * are whole numbers below 2^53.
 */
template <int dim>
struct ParticleLayout
{
  explicit ParticleLayout(const ParticleNeeds &needs)
    : n_stress(needs.isotropic_stress ? 1 : Symmetric<dim, double>::size)
    , n_history(needs.n_history)
    , n_sheets(needs.n_sheets)
  {
    int        next = stress + n_stress;
    const auto take = [&next](const int n) {
      const int first = n > 0 ? next : -1;
      next += n;
      return first;
    };
    history              = take(n_history);
    deformation_gradient = take(needs.deformation_gradient ? dim * dim : 0);
    affine               = take(needs.affine ? dim * dim : 0);
    touch                = take(needs.touches ? Symmetric<dim, double>::size : 0);
    side                 = take(n_sheets);
    n_columns            = next;
  }

  /// Position [m] and velocity [m/s]; position at the end of the step [m].
  static constexpr int position = 0, velocity = dim, next_position = 2 * dim;
  /// Mass [kg] (per metre of depth in 2-D), current density [kg/m^3], edge of the particle's box
  /// [m].
  static constexpr int mass = 3 * dim, density = mass + 1, size = mass + 2, id = mass + 3;
  /// Pressure or Cauchy stress [Pa].
  static constexpr int stress = mass + 4;
  int                  n_stress, history, n_history, deformation_gradient, affine;
  /// Symmetric tensor: sum over the surfaces that the particle touches of n n times the share of
  /// the particle that does not deform along n [1].
  int touch;
  int side, n_sheets;
  int n_columns;
};
} // namespace coracle
