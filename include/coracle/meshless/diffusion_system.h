// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/fluid_operators.h>
#include <coracle/meshless/scalar_system.h>

#include <deal.II/lac/la_parallel_vector.h>

namespace coracle::meshless
{
/**
 * The symmetric system (M + b S) u = f with a velocity per point: M lumped, S
 * the integrals of grad N_i . grad N_j, the same for all components, of which
 * each may be held at zero. Applied without a matrix and solved by conjugate
 * gradients with the diagonal: b S is small beside M where a fluid is as thin as
 * water, and a few iterations do. Collective.
 */
template <int dim>
class DiffusionSystem
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// @param halo that of the operators
  DiffusionSystem(const FluidOperators<dim> &operators, const Halo &halo, const MPI_Comm comm)
    : operators(operators), halo(halo), comm(comm)
  {}

  /**
   * @param mass M by own point, positive where a component is free
   * @param b    factor of S, at least 0
   * @param held by own point: bit d is set where component d is zero
   */
  void set(std::vector<double> mass, const double b, std::vector<unsigned char> held);

  /// @param u start, and result; own points
  SolveReport
  solve(const std::vector<Vector> &f, std::vector<Vector> &u, const SolverOptions &options);

private:
  using Column = dealii::LinearAlgebra::distributed::Vector<double>;
  struct Operator;

  bool is_held(const std::size_t i, const unsigned int d) const { return held[i] >> d & 1; }
  void copy(const std::vector<Vector> &from, Column &to) const;

  FluidOperators<dim>        operators;
  const Halo                &halo;
  const MPI_Comm             comm;
  std::vector<double>        mass;
  double                     b = 0;
  std::vector<unsigned char> held;
};
} // namespace coracle::meshless
