// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/stick_slip.h>

#include <algorithm>

namespace coracle::contact
{
template <int dim>
IterationReport
solve_stick_slip(Delassus<dim>                       &delassus,
                 const std::vector<bool>             &active,
                 std::vector<dealii::Tensor<1, dim>> &impulses,
                 Velocities<dim>                     &v,
                 MPI_Comm                             communicator)
{
  const auto           &rows   = delassus.rows();
  const Velocities<dim> before = v;
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      const auto &row = rows[c];
      impulses[c]     = dealii::Tensor<1, dim>();
      if (!active[c] || row.fixed)
        continue;
      const auto   u        = delassus.relative_velocity(row, before);
      const double approach = -(u * row.normal);
      if (approach <= 0)
        continue;
      const double normal = approach / row.true_inverse_mass;
      impulses[c]         = normal * row.normal;
      if (row.friction > 0)
        {
          auto         tangential = -(u + approach * row.normal) / row.true_tangential_inverse_mass;
          const double size = tangential.norm(), limit = row.friction * normal;
          if (size > limit)
            tangential *= limit / size;
          impulses[c] += tangential;
        }
      delassus.apply(row, impulses[c], v);
    }
  double unused = 0;
  delassus.synchronise(v, before, unused);

  IterationReport report;
  report.iterations = 1;
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (active[c] && !rows[c].fixed)
      report.residual =
        std::max(report.residual, -(delassus.relative_velocity(rows[c], v) * rows[c].normal));
  MPI_Allreduce(MPI_IN_PLACE, &report.residual, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return report;
}

template IterationReport solve_stick_slip(Delassus<2> &,
                                          const std::vector<bool> &,
                                          std::vector<dealii::Tensor<1, 2>> &,
                                          Velocities<2> &,
                                          MPI_Comm);
template IterationReport solve_stick_slip(Delassus<3> &,
                                          const std::vector<bool> &,
                                          std::vector<dealii::Tensor<1, 3>> &,
                                          Velocities<3> &,
                                          MPI_Comm);
} // namespace coracle::contact
