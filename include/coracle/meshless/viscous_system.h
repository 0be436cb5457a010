// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/scalar_system.h>

namespace coracle::meshless
{
/**
 * The symmetric system (M + K) u = f with a velocity per point: M lumped, K the
 * integrals of c (grad u + grad u^T) : grad N_i with a factor c of each element,
 * so that a rigid motion costs nothing. Solved by conjugate gradients; factors
 * may be 0, and differ by any ratio between elements. Collective.
 */
template <int dim>
class ViscousSystem
{
public:
  using Vector = dealii::Tensor<1, dim>;

  explicit ViscousSystem(const MPI_Comm comm) : comm(comm) {}

  /// The points and elements of a new tessellation.
  /// @param factor by element; where it is 0 no entries are kept
  void reinit(const Tessellation<dim>   &tessellation,
              const std::vector<double> &factor,
              const Halo                &halo);

  /**
   * @param mass   by own point, positive or the point is fixed
   * @param factor c by element, 0 where it was 0 in reinit()
   * @param fixed  by point and copy: bit d is set where component d is zero
   */
  void assemble(const Tessellation<dim>          &tessellation,
                const ElementRules<dim>          &rules,
                const std::vector<double>        &mass,
                const std::vector<double>        &factor,
                const std::vector<unsigned char> &fixed);

  /// @param u start, and result; own points
  SolveReport
  solve(const std::vector<Vector> &f, std::vector<Vector> &u, const SolverOptions &options);

private:
  using Column = dealii::TrilinosWrappers::MPI::Vector;

  /// Row of component d of a point.
  dealii::types::global_dof_index row(const unsigned int node, const unsigned int d) const
  {
    return dim * number[node] + d;
  }

  MPI_Comm                                     comm;
  dealii::IndexSet                             owned;
  std::vector<dealii::types::global_dof_index> number;
  std::vector<unsigned char>                   fixed_rows;
  dealii::TrilinosWrappers::SparseMatrix       matrix;
  Column                                       solution, right_side;
};
} // namespace coracle::meshless
