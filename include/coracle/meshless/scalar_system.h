// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/element_rules.h>
#include <coracle/meshless/halo.h>

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <functional>
#include <optional>

namespace coracle::meshless
{
/// How a linear system was solved.
struct SolveReport
{
  unsigned int iterations = 0;
  bool         converged  = true;
  /// |b - A x| / |b|.
  double residual = 0;
};

/// What to solve symmetric positive systems with.
struct SolverOptions
{
  /// |b - A x| / |b| at the end.
  double       tolerance          = 1e-10;
  unsigned int largest_iterations = 500;
  /// Up to so many unknowns a factorisation is used instead.
  unsigned int direct_up_to = 500;
};

/**
 * The symmetric system (a M + b S) x = f with one unknown per point: M lumped,
 * S the integrals of grad N_i . grad N_j. Unknowns are numbered by ranks, owned
 * points in their order; the matrix is Trilinos', solved by conjugate gradients
 * with smoothed-aggregation multigrid (ML) or a factorisation (Amesos).
 * Collective.
 */
template <int dim>
class ScalarSystem
{
public:
  explicit ScalarSystem(const MPI_Comm comm) : comm(comm) {}

  /// The points and elements of a new tessellation.
  void reinit(const Tessellation<dim> &tessellation, const Halo &halo);

  /**
   * @param mass  a M, by own point; empty: none. Any diagonal part will do.
   * @param b     factor of S
   * @param fixed by point and copy: unknowns that are zero
   * @param share of S that an element has, by element; empty: 1
   */
  void assemble(const Tessellation<dim>          &tessellation,
                const ElementRules<dim>          &rules,
                const std::vector<double>        &mass,
                const double                      b,
                const std::vector<unsigned char> &fixed,
                const std::vector<double>        &share = {});

  /// The preconditioner for the matrix as it is now; it may serve later matrices that differ
  /// little.
  void prepare(const SolverOptions &options);

  /// What is added to the matrix where it is applied: (result, x), by own point.
  using Addition = std::function<void(double *, const double *)>;

  /**
   * @param x        start, and result; own points
   * @param addition symmetric; the matrix with it must be positive. The matrix alone makes the
   *                 preconditioner.
   */
  SolveReport solve(const std::vector<double> &f,
                    std::vector<double>       &x,
                    const SolverOptions       &options,
                    const Addition            &addition = {});

  using Matrix = dealii::TrilinosWrappers::SparseMatrix;

  std::uint64_t n_unknowns() const { return matrix.m(); }
  const Matrix &get_matrix() const { return matrix; }

private:
  using Vector = dealii::TrilinosWrappers::MPI::Vector;

  bool is_direct(const SolverOptions &options) const
  {
    return n_unknowns() <= options.direct_up_to;
  }

  MPI_Comm                                                 comm;
  dealii::IndexSet                                         owned;
  std::vector<dealii::types::global_dof_index>             number;
  std::vector<unsigned char>                               fixed_rows;
  Matrix                                                   matrix;
  std::optional<dealii::TrilinosWrappers::PreconditionAMG> multigrid;
  std::optional<dealii::TrilinosWrappers::SolverDirect>    direct;
  Vector                                                   solution, right_side;
  dealii::SolverControl                                    control{1, 0., false, false};
};
} // namespace coracle::meshless
