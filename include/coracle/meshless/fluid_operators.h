// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/element_rules.h>
#include <coracle/meshless/halo.h>

namespace coracle::meshless
{
/**
 * The integrals of a step, applied without a matrix. Arguments hold own points
 * and up-to-date copies; results are summed over ranks and right for own points.
 * All functions are collective.
 *
 * Source: Del Pin and others (2003), Eqs. 33-35.
 */
template <int dim>
class FluidOperators
{
public:
  using Vector = dealii::Tensor<1, dim>;

  FluidOperators(const Tessellation<dim> &tessellation,
                 const ElementRules<dim> &rules,
                 const Halo              &halo)
    : tessellation(tessellation), rules(rules), halo(halo)
  {}

  /// m_i = integral of N_i [m^dim], times a factor of each element if there are any.
  void lumped_volume(std::vector<double> &result, const std::vector<double> &factor = {}) const;
  /// integral of N_i grad p, B^T p of Eq. 31 [p m^(dim-1)].
  void gradient(const std::vector<double> &p, std::vector<Vector> &result) const;
  /// integral of grad N_i . u, B u of Eq. 29 [u m^(dim-1)].
  void divergence(const std::vector<Vector> &u, std::vector<double> &result) const;
  /// integral of grad N_i . grad u_d for each component d, K u of Eq. 27 [u m^(dim-2)].
  void laplacian(const std::vector<Vector> &u, std::vector<Vector> &result) const;
  /// integral of grad N_i . grad N_i [m^(dim-2)].
  void laplacian_diagonal(std::vector<double> &result) const;
  /// integral of mu (grad u + grad u^T) grad N_i, mu by element [Pa s u m^(dim-2)]; 0 where u is a
  /// rigid motion.
  void viscous_force(const std::vector<Vector> &u,
                     const std::vector<double> &viscosity,
                     std::vector<Vector>       &result) const;

private:
  const Tessellation<dim> &tessellation;
  const ElementRules<dim> &rules;
  const Halo              &halo;
};
} // namespace coracle::meshless
