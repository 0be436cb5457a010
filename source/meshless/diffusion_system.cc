// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/diffusion_system.h>

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

namespace coracle::meshless
{
template <int dim>
struct DiffusionSystem<dim>::Operator
{
  const DiffusionSystem      &system;
  mutable std::vector<Vector> u, flux;

  void vmult(Column &result, const Column &x) const
  {
    const std::size_t n = system.mass.size();
    u.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      for (unsigned int d = 0; d < dim; ++d)
        u[i][d] = x.local_element(dim * i + d);
    system.halo.update(u);
    system.operators.laplacian(u, flux);
    for (std::size_t i = 0; i < n; ++i)
      for (unsigned int d = 0; d < dim; ++d)
        result.local_element(dim * i + d) =
          system.is_held(i, d) ? u[i][d] : system.mass[i] * u[i][d] + system.b * flux[i][d];
  }
};

template <int dim>
void
DiffusionSystem<dim>::set(std::vector<double>        mass_of_points,
                          const double               factor,
                          std::vector<unsigned char> held_components)
{
  mass = std::move(mass_of_points);
  b    = factor;
  held = std::move(held_components);
}

template <int dim>
void
DiffusionSystem<dim>::copy(const std::vector<Vector> &from, Column &to) const
{
  for (std::size_t i = 0; i < mass.size(); ++i)
    for (unsigned int d = 0; d < dim; ++d)
      to.local_element(dim * i + d) = is_held(i, d) ? 0. : from[i][d];
}

template <int dim>
SolveReport
DiffusionSystem<dim>::solve(const std::vector<Vector> &f,
                            std::vector<Vector>       &u,
                            const SolverOptions       &options)
{
  const std::uint64_t n = dim * mass.size(), first = mpi::offset(n, comm);
  dealii::IndexSet    owned(mpi::sum(n, comm));
  owned.add_range(first, first + n);
  Column solution(owned, comm), right_side(owned, comm);
  copy(u, solution);
  copy(f, right_side);
  SolveReport  report;
  const double size = right_side.l2_norm();
  if (size == 0 || !std::isfinite(size))
    {
      // Nothing drives it; or it is not a number, which the caller finds and names.
      for (Vector &component : u)
        for (unsigned int d = 0; d < dim; ++d)
          component[d] = size;
      return report;
    }

  std::vector<double> slope;
  operators.laplacian_diagonal(slope);
  dealii::DiagonalMatrix<Column> inverse_diagonal(right_side);
  for (std::size_t i = 0; i < mass.size(); ++i)
    for (unsigned int d = 0; d < dim; ++d)
      inverse_diagonal.get_vector().local_element(dim * i + d) =
        is_held(i, d) ? 1. : 1. / (mass[i] + b * slope[i]);

  dealii::SolverControl    limits(options.largest_iterations,
                               options.tolerance * size,
                               /*log_history=*/false,
                               /*log_result=*/false);
  dealii::SolverCG<Column> cg(limits);
  try
    {
      cg.solve(Operator{*this, {}, {}}, solution, right_side, inverse_diagonal);
    }
  catch (const dealii::SolverControl::NoConvergence &)
    {
      report.converged = false;
    }
  report.iterations = limits.last_step();
  report.residual   = limits.last_value() / size;
  for (std::size_t i = 0; i < mass.size(); ++i)
    for (unsigned int d = 0; d < dim; ++d)
      u[i][d] = solution.local_element(dim * i + d);
  return report;
}

template class DiffusionSystem<2>;
template class DiffusionSystem<3>;
} // namespace coracle::meshless
