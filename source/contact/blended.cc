// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/blended.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
/// What one contact adds to its impulse, alone with the true masses.
template <int dim>
dealii::Tensor<1, dim>
increment(const typename Delassus<dim>::Row        &row,
          const double                              friction,
          const typename Delassus<dim>::TrueMasses &masses,
          const dealii::Tensor<1, dim>             &u,
          const double                              wanted)
{
  const auto   normal   = to_tensor<dim>(row.normal);
  const double approach = u * normal, more = (wanted - approach) / masses.normal;
  if (more <= 0)
    return dealii::Tensor<1, dim>();
  dealii::Tensor<1, dim> result = more * normal;
  if (row.has_friction)
    {
      auto         tangential = -(u - approach * normal) / masses.tangential;
      const double limit = friction * more, size = tangential.norm();
      if (size > limit)
        tangential *= limit / size;
      result += tangential;
    }
  return result;
}
} // namespace

template <int dim>
IterationReport
solve_blended(Delassus<dim>                       &delassus,
              const std::vector<double>           &wanted,
              const std::vector<bool>             &active,
              const IterationLimits               &limits,
              std::vector<dealii::Tensor<1, dim>> &impulses,
              LaneVelocities<dim>                 &v,
              MPI_Comm                             communicator)
{
  const auto         &rows   = delassus.rows();
  const auto         &masses = delassus.true_inverse_masses();
  LaneVelocities<dim> before;
  IterationReport     report;
  for (;;)
    {
      before          = v;
      report.residual = 0;
      for (std::size_t c = 0; c < rows.size(); ++c)
        if (active[c] && !rows[c].fixed)
          {
            const auto u = to_tensor<dim>(delassus.relative_velocity(rows[c], before));
            const auto step =
              increment<dim>(rows[c], delassus.sliding(c).friction, masses[c], u, wanted[c]);
            report.residual = std::max(report.residual, step.norm() * masses[c].normal);
            impulses[c] += step;
            delassus.apply(rows[c], to_lanes<dim>(step), v);
          }
      MPI_Allreduce(MPI_IN_PLACE, &report.residual, 1, MPI_DOUBLE, MPI_MAX, communicator);
      double unused = 0;
      delassus.synchronise(v, before, unused);
      report.converged = (report.residual <= limits.tolerance);
      if (report.converged || report.iterations >= limits.iterations)
        return report;
      ++report.iterations;
    }
}

template IterationReport solve_blended(Delassus<2> &,
                                       const std::vector<double> &,
                                       const std::vector<bool> &,
                                       const IterationLimits &,
                                       std::vector<dealii::Tensor<1, 2>> &,
                                       LaneVelocities<2> &,
                                       MPI_Comm);
template IterationReport solve_blended(Delassus<3> &,
                                       const std::vector<double> &,
                                       const std::vector<bool> &,
                                       const IterationLimits &,
                                       std::vector<dealii::Tensor<1, 3>> &,
                                       LaneVelocities<3> &,
                                       MPI_Comm);
} // namespace coracle::contact
