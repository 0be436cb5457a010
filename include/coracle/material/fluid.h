// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>
#include <coracle/material/motion.h>

namespace coracle
{
/**
 * A fluid: an equation of state, artificial bulk viscosity and, if `viscous`,
 * Newtonian shear viscosity. Cauchy stress [Pa], tension positive,
 *
 *   sigma = -(p(rho) + q) I + 2 mu dev(D),    D = sym(L),
 *   q     = rho h |tr D| (b1 c + b2^2 h |tr D|)  where tr D < 0, otherwise 0,
 *
 * with h the size of the cell or element. q smears a shock over a few cells and
 * damps the ringing behind it. Stokes' hypothesis holds: mu gives no pressure.
 *
 * Whether mu > 0 is known at compile time, so that an inviscid point keeps its
 * pressure only.
 *
 * EquationOfState (see WeaklyCompressible): name, description, declare(),
 * reference_density(), sound_speed(rho), pressure(rho), energy_density(rho).
 *
 * Source: von Neumann & Richtmyer, J. Appl. Phys. 21 (1950) 232 (quadratic
 * term); Landshoff, Los Alamos report LA-1930 (1955) (linear term).
 */
template <typename EquationOfState, bool viscous>
class Fluid
{
public:
  static constexpr const char *name                       = EquationOfState::name;
  static constexpr const char *description                = EquationOfState::description;
  static constexpr bool        isotropic_stress           = !viscous;
  static constexpr bool        needs_deformation_gradient = false;
  static constexpr bool        remembers_stress           = false;
  static constexpr int         n_history                  = 0;

  static void declare(Declaration &declaration)
  {
    EquationOfState::declare(declaration);
    declaration.quantity(
      "Viscosity", "0", "Pa s", "mu", "Newtonian shear viscosity; 0 is an inviscid fluid", 0.);
    declaration.quantity("Linear bulk viscosity",
                         "0",
                         "1",
                         "b_1",
                         "artificial viscosity against ringing, usually 0 to 0.1",
                         0.);
    declaration.quantity("Quadratic bulk viscosity",
                         "0",
                         "1",
                         "b_2",
                         "artificial viscosity that spreads shocks, usually 0 to 1.5",
                         0.);
  }

  /// Is this the variant (viscous or not) that the parameters ask for?
  static bool accepts(const Parameters &parameters)
  {
    return (parameters.quantity("Viscosity") > 0.) == viscous;
  }

  explicit Fluid(const Parameters &parameters)
    : Fluid(EquationOfState(parameters),
            parameters.quantity("Viscosity"),
            parameters.quantity("Linear bulk viscosity"),
            parameters.quantity("Quadratic bulk viscosity"))
  {}

  /// Equation of state, mu [Pa s], b1 [1], b2 [1].
  Fluid(const EquationOfState &equation_of_state,
        const double           viscosity,
        const double           linear_bulk_viscosity,
        const double           quadratic_bulk_viscosity)
    : eos(equation_of_state)
    , mu(viscosity)
    , b_1(linear_bulk_viscosity)
    , b_2_squared(quadratic_bulk_viscosity * quadratic_bulk_viscosity)
  {}

  double reference_density() const { return eos.reference_density(); }

  template <typename T>
  T sound_speed(const T &density) const
  {
    return eos.sound_speed(density);
  }

  /// 4/3 mu/rho0 [m^2/s]: an explicit step must stay below h^2 / (2 dim diffusivity).
  double diffusivity() const { return 4. / 3. * mu / eos.reference_density(); }

  /// p + q [Pa], compression positive.
  template <int dim, typename T>
  T pressure(const Motion<dim, T> &motion) const
  {
    // Expansion gives closing = 0, and with it q = 0.
    const T closing = motion.length * max(T(-trace<dim, T>(motion.velocity_gradient)), T{});
    return eos.pressure(motion.density) +
           motion.density * closing *
             (b_1 * eos.sound_speed(motion.density) + b_2_squared * closing);
  }

  template <int dim, typename T>
  void update(const Motion<dim, T> &motion, Symmetric<dim, T> &stress, T *) const
  {
    T mean_stress = -pressure(motion);
    stress        = {};
    if constexpr (viscous)
      {
        stress = symmetric_part<dim, T>(motion.velocity_gradient);
        mean_stress -= 2. / 3. * mu * stress.trace();
        for (int i = 0; i < stress.size; ++i)
          stress[i] *= 2. * mu;
      }
    for (int i = 0; i < 3; ++i)
      stress[i] += mean_stress;
  }

  /// Energy of compression; what viscosity takes is lost.
  template <int dim, typename T>
  T energy_density(const Motion<dim, T> &motion, const Symmetric<dim, T> &) const
  {
    return eos.energy_density(motion.density);
  }

private:
  EquationOfState eos;
  double          mu, b_1, b_2_squared;
};
} // namespace coracle
