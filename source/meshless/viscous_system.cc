// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/viscous_system.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

namespace coracle::meshless
{
template <int dim>
void
ViscousSystem<dim>::reinit(const Tessellation<dim>   &tessellation,
                           const std::vector<double> &factor,
                           const Halo                &halo)
{
  const std::uint64_t n_own = halo.n_own(), first = mpi::offset(n_own, comm);
  number.resize(n_own);
  for (std::size_t i = 0; i < n_own; ++i)
    number[i] = first + i;
  halo.update(number);

  owned = dealii::IndexSet(dim * mpi::sum(n_own, comm));
  owned.add_range(dim * first, dim * (first + n_own));
  // Rows that this rank adds to: its own, and those of other ranks' points in its elements.
  dealii::IndexSet                             writable = owned;
  std::vector<dealii::types::global_dof_index> rows;
  for (const unsigned int node : tessellation.node)
    if (node >= n_own)
      for (unsigned int d = 0; d < dim; ++d)
        rows.push_back(row(node, d));
  std::sort(rows.begin(), rows.end());
  writable.add_indices(rows.begin(), std::unique(rows.begin(), rows.end()));

  // A rank without rows must not ask for room for them: deal.II 9.4 takes it for too many.
  const unsigned int                        per_row = n_own == 0 ? 0 : dim == 2 ? 16 : 60;
  dealii::TrilinosWrappers::SparsityPattern pattern(owned, owned, writable, comm, per_row);
  for (const auto i : owned)
    pattern.add(i, i);
  for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
    if (factor[e] > 0)
      {
        rows.clear();
        for (unsigned int k = tessellation.first_node[e]; k < tessellation.first_node[e + 1]; ++k)
          for (unsigned int d = 0; d < dim; ++d)
            rows.push_back(row(tessellation.node[k], d));
        std::sort(rows.begin(), rows.end());
        for (const auto i : rows)
          pattern.add_entries(i, rows.begin(), rows.end(), true);
      }
  pattern.compress();
  matrix.reinit(pattern);
  solution.reinit(owned, comm);
  right_side.reinit(owned, comm);
}

template <int dim>
void
ViscousSystem<dim>::assemble(const Tessellation<dim>          &tessellation,
                             const ElementRules<dim>          &rules,
                             const std::vector<double>        &mass,
                             const std::vector<double>        &factor,
                             const std::vector<unsigned char> &fixed)
{
  matrix             = 0;
  const auto n_local = owned.n_elements() / dim;
  fixed_rows.assign(fixed.begin(), fixed.begin() + n_local);
  const auto is_fixed = [&](const unsigned int node, const unsigned int d) {
    return fixed[node] >> d & 1;
  };
  dealii::FullMatrix<double>                   local;
  std::vector<dealii::types::global_dof_index> rows;
  const unsigned int                          *current = nullptr;
  const auto                                   hand_in = [&] {
    if (current != nullptr)
      matrix.add(rows, local, /*elide_zero_values=*/true);
  };
  rules.for_each(tessellation,
                 factor,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double *,
                     const Vector *gradient) {
                   if (weight == 0)
                     return;
                   if (nodes != current)
                     {
                       hand_in();
                       current = nodes;
                       local.reinit(dim * n, dim * n);
                       rows.clear();
                       for (unsigned int i = 0; i < n; ++i)
                         for (unsigned int d = 0; d < dim; ++d)
                           rows.push_back(row(nodes[i], d));
                     }
                   for (unsigned int i = 0; i < n; ++i)
                     for (unsigned int j = 0; j < n; ++j)
                       for (unsigned int a = 0; a < dim; ++a)
                         for (unsigned int b = 0; b < dim; ++b)
                           if (!is_fixed(nodes[i], a) && !is_fixed(nodes[j], b))
                             local(dim * i + a, dim * j + b) +=
                               weight * ((a == b ? gradient[i] * gradient[j] : 0.) +
                                         gradient[j][a] * gradient[i][b]);
                 });
  hand_in();
  for (std::size_t i = 0; i < n_local; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      matrix.add(row(i, d), row(i, d), is_fixed(i, d) ? 1. : mass[i]);
  matrix.compress(dealii::VectorOperation::add);
}

// Sweeps, like the diagonal, take the ratio of viscosities out: what is left is a solid's few rigid
// motions, and the modes of its own.
template <int dim>
SolveReport
ViscousSystem<dim>::solve(const std::vector<Vector> &f,
                          std::vector<Vector>       &u,
                          const SolverOptions       &options)
{
  const auto is_fixed = [&](const std::size_t i) { return fixed_rows[i / dim] >> i % dim & 1; };
  const std::size_t n = owned.n_elements();
  for (std::size_t i = 0; i < n; ++i)
    {
      solution.begin()[i]   = is_fixed(i) ? 0. : u[i / dim][i % dim];
      right_side.begin()[i] = is_fixed(i) ? 0. : f[i / dim][i % dim];
    }
  SolveReport  report;
  const double size = right_side.l2_norm();
  if (size == 0 || !std::isfinite(size))
    {
      // Nothing drives it; or it is not a number, which the caller finds and names.
      for (std::size_t i = 0; i < n; ++i)
        u[i / dim][i % dim] = size;
      return report;
    }
  dealii::TrilinosWrappers::PreconditionSSOR sweeps;
  sweeps.initialize(matrix);
  dealii::SolverControl    limits(options.largest_iterations,
                               options.tolerance * size,
                               /*log_history=*/false,
                               /*log_result=*/false);
  dealii::SolverCG<Column> cg(limits);
  try
    {
      cg.solve(matrix, solution, right_side, sweeps);
    }
  catch (const dealii::SolverControl::NoConvergence &)
    {
      report.converged = false;
    }
  report.iterations = limits.last_step();
  report.residual   = limits.last_value() / size;
  for (std::size_t i = 0; i < n; ++i)
    u[i / dim][i % dim] = solution.begin()[i];
  return report;
}

template class ViscousSystem<2>;
template class ViscousSystem<3>;
} // namespace coracle::meshless
