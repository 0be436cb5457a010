// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/material/elastic_constants.h>
#include <coracle/material/motion.h>

namespace coracle
{
/**
 * Compressible neo-Hookean solid, energy per reference volume
 *
 *   Psi = mu/2 (tr b - 3) - mu ln J + lambda/2 (ln J)^2,     b = F F^T, J = det F,
 *
 * hence the Cauchy stress sigma = (mu (b - I) + lambda ln J I) / J [Pa]. In
 * plane strain F_zz = 1. J <= 0 (a point turned inside out) gives NaN, which
 * whoever owns the point reports with its place.
 *
 * Source: Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element
 * Analysis (Cambridge University Press), chapter on hyperelasticity.
 */
class NeoHookean
{
public:
  static constexpr const char *name                       = "neo-Hookean";
  static constexpr const char *description                = "isotropic solid, large elastic strain";
  static constexpr bool        isotropic_stress           = false;
  static constexpr bool        needs_deformation_gradient = true;
  static constexpr bool        remembers_stress           = false;
  static constexpr int         n_history                  = 0;

  static void declare(Declaration &declaration) { ElasticConstants::declare(declaration); }
  static bool accepts(const Parameters &) { return true; }

  explicit NeoHookean(const Parameters &parameters) : constants(parameters) {}
  explicit NeoHookean(const ElasticConstants &constants) : constants(constants) {}

  double reference_density() const { return constants.density; }
  double diffusivity() const { return 0.; }

  /// Of waves that compress further in a state of uniaxial strain; not below that of the unstressed
  /// solid.
  template <typename T>
  T sound_speed(const T &density) const
  {
    const double lambda = constants.lambda, mu = constants.mu;
    const T      j       = constants.density / density;
    const T      modulus = lambda * (1. - log(j)) + mu * (1. + j * j);
    return sqrt(T(max(modulus, splat<T>(lambda + 2. * mu)) / constants.density));
  }

  template <int dim, typename T>
  void update(const Motion<dim, T> &motion, Symmetric<dim, T> &stress, T *) const
  {
    const Matrix<dim, T> &f         = motion.deformation_gradient;
    const T               inverse_j = 1. / determinant<dim, T>(f);
    const T               shift = -inverse_j * (constants.mu + constants.lambda * log(inverse_j));

    stress = left_cauchy_green<dim, T>(f);
    for (int i = 0; i < stress.size; ++i)
      stress[i] *= constants.mu * inverse_j;
    for (int i = 0; i < 3; ++i)
      stress[i] += shift;
  }

  /// Psi / J.
  template <int dim, typename T>
  T energy_density(const Motion<dim, T> &motion, const Symmetric<dim, T> &) const
  {
    const Matrix<dim, T> &f     = motion.deformation_gradient;
    const T               j     = determinant<dim, T>(f);
    const T               log_j = log(j);
    return (0.5 * constants.mu * (left_cauchy_green<dim, T>(f).trace() - 3.) -
            constants.mu * log_j + 0.5 * constants.lambda * log_j * log_j) /
           j;
  }

private:
  template <int dim, typename T>
  static Symmetric<dim, T> left_cauchy_green(const Matrix<dim, T> &f)
  {
    Symmetric<dim, T> b;
    for (int i = 0; i < dim; ++i)
      for (int j = i; j < dim; ++j)
        {
          b(i, j) = f[i][0] * f[j][0];
          for (int k = 1; k < dim; ++k)
            b(i, j) += f[i][k] * f[j][k];
        }
    if constexpr (dim == 2)
      b[2] = splat<T>(1.);
    return b;
  }

  ElasticConstants constants;
};
} // namespace coracle
