// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/scalar_system.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

namespace coracle::meshless
{
namespace
{
using Vector = dealii::TrilinosWrappers::MPI::Vector;

/// The matrix and what is added to it.
struct Operator
{
  const dealii::TrilinosWrappers::SparseMatrix        &matrix;
  const std::function<void(double *, const double *)> &addition;

  void vmult(Vector &result, const Vector &x) const
  {
    matrix.vmult(result, x);
    if (addition)
      addition(result.begin(), x.begin());
  }
};

/// A factorisation as a preconditioner.
struct Factors
{
  dealii::TrilinosWrappers::SolverDirect &direct;

  void vmult(Vector &result, const Vector &x) const { direct.solve(result, x); }
};
} // namespace

template <int dim>
void
ScalarSystem<dim>::reinit(const Tessellation<dim> &tessellation, const Halo &halo)
{
  multigrid.reset();
  direct.reset();
  const std::uint64_t n_own = halo.n_own(), first = mpi::offset(n_own, comm);
  number.resize(n_own);
  for (std::size_t i = 0; i < n_own; ++i)
    number[i] = first + i;
  halo.update(number);

  owned = dealii::IndexSet(mpi::sum(n_own, comm));
  owned.add_range(first, first + n_own);
  // Rows that this rank adds to: its own, and those of other ranks' points in its elements.
  dealii::IndexSet                             writable = owned;
  std::vector<dealii::types::global_dof_index> columns;
  for (const unsigned int node : tessellation.node)
    if (node >= n_own)
      columns.push_back(number[node]);
  std::sort(columns.begin(), columns.end());
  writable.add_indices(columns.begin(), std::unique(columns.begin(), columns.end()));

  // A rank without rows must not ask for room for them: deal.II 9.4 takes it for too many.
  const unsigned int                        per_row = n_own == 0 ? 0 : dim == 2 ? 8 : 20;
  dealii::TrilinosWrappers::SparsityPattern pattern(owned, owned, writable, comm, per_row);
  for (std::size_t i = 0; i < n_own; ++i)
    pattern.add(number[i], number[i]);
  for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
    {
      const unsigned int  n     = tessellation.n_nodes(e);
      const unsigned int *nodes = tessellation.node.data() + tessellation.first_node[e];
      columns.resize(n);
      for (unsigned int i = 0; i < n; ++i)
        columns[i] = number[nodes[i]];
      for (unsigned int i = 0; i < n; ++i)
        pattern.add_entries(columns[i], columns.begin(), columns.end());
    }
  pattern.compress();
  matrix.reinit(pattern);
  solution.reinit(owned, comm);
  right_side.reinit(owned, comm);
}

template <int dim>
void
ScalarSystem<dim>::assemble(const Tessellation<dim>          &tessellation,
                            const ElementRules<dim>          &rules,
                            const std::vector<double>        &mass,
                            const double                      b,
                            const std::vector<unsigned char> &fixed,
                            const std::vector<double>        &share)
{
  matrix = 0;
  fixed_rows.assign(fixed.begin(), fixed.begin() + owned.n_elements());
  double                                       largest = 0;
  std::vector<double>                          values;
  std::vector<dealii::types::global_dof_index> columns;
  rules.for_each(tessellation,
                 share,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double *,
                     const dealii::Tensor<1, dim> *gradient) {
                   for (unsigned int i = 0; i < n; ++i)
                     {
                       if (fixed[nodes[i]])
                         continue;
                       columns.clear();
                       values.clear();
                       for (unsigned int j = 0; j < n; ++j)
                         if (!fixed[nodes[j]])
                           {
                             columns.push_back(number[nodes[j]]);
                             values.push_back(b * weight * (gradient[i] * gradient[j]));
                             if (j == i)
                               largest = std::max(largest, values.back());
                           }
                       matrix.add(number[nodes[i]], columns.size(), columns.data(), values.data());
                     }
                 });
  // Rows of fixed unknowns are of the size of the others, for the preconditioner's sake.
  largest = mpi::max(largest, comm);
  for (std::size_t i = 0; i < fixed_rows.size(); ++i)
    if (fixed_rows[i])
      matrix.add(number[i], number[i], largest > 0 ? largest : 1.);
    else if (!mass.empty())
      matrix.add(number[i], number[i], mass[i]);
  matrix.compress(dealii::VectorOperation::add);
}

template <int dim>
void
ScalarSystem<dim>::prepare(const SolverOptions &options)
{
  multigrid.reset();
  direct.reset();
  if (is_direct(options))
    {
      direct.emplace(control);
      direct->initialize(matrix);
      return;
    }
  dealii::TrilinosWrappers::PreconditionAMG::AdditionalData data;
  data.elliptic              = true;
  data.higher_order_elements = false;
  data.smoother_sweeps       = 2;
  data.aggregation_threshold = 1e-3;
  multigrid.emplace();
  multigrid->initialize(matrix, data);
}

template <int dim>
SolveReport
ScalarSystem<dim>::solve(const std::vector<double> &f,
                         std::vector<double>       &x,
                         const SolverOptions       &options,
                         const Addition            &addition)
{
  for (std::size_t i = 0; i < fixed_rows.size(); ++i)
    {
      solution.begin()[i]   = fixed_rows[i] ? 0. : x[i];
      right_side.begin()[i] = fixed_rows[i] ? 0. : f[i];
    }
  SolveReport  report;
  const double size = right_side.l2_norm();
  if (size == 0 || !std::isfinite(size))
    {
      // Nothing drives it; or it is not a number, which the caller finds and names.
      std::fill_n(x.begin(), fixed_rows.size(), size);
      return report;
    }
  dealii::SolverControl    limits(options.largest_iterations,
                               options.tolerance * size,
                               /*log_history=*/false,
                               /*log_result=*/false);
  dealii::SolverCG<Vector> cg(limits);
  const Operator           system{matrix, addition};
  try
    {
      if (multigrid)
        cg.solve(system, solution, right_side, *multigrid);
      else
        cg.solve(system, solution, right_side, Factors{*direct});
    }
  catch (const dealii::SolverControl::NoConvergence &)
    {
      report.converged = false;
    }
  report.iterations = limits.last_step();
  report.residual   = limits.last_value() / size;
  for (std::size_t i = 0; i < fixed_rows.size(); ++i)
    x[i] = solution.begin()[i];
  return report;
}

template class ScalarSystem<2>;
template class ScalarSystem<3>;
} // namespace coracle::meshless
