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
                 LaneVelocities<dim>                 &v,
                 MPI_Comm                             communicator)
{
  const auto               &rows   = delassus.rows();
  const LaneVelocities<dim> before = v;
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      const auto &row = rows[c];
      impulses[c]     = dealii::Tensor<1, dim>();
      if (!active[c] || row.fixed)
        continue;
      const auto   n        = to_tensor<dim>(row.normal);
      const auto   u        = to_tensor<dim>(delassus.relative_velocity(row, before));
      const double approach = -(u * n);
      if (approach <= 0)
        continue;
      const double normal = approach / delassus.true_inverse_masses()[c].normal;
      impulses[c]         = normal * n;
      if (row.has_friction)
        {
          auto tangential   = -(u + approach * n) / delassus.true_inverse_masses()[c].tangential;
          const double size = tangential.norm(), limit = delassus.sliding(c).friction * normal;
          if (size > limit)
            tangential *= limit / size;
          impulses[c] += tangential;
        }
      delassus.apply(row, to_lanes<dim>(impulses[c]), v);
    }
  double unused = 0;
  delassus.synchronise(v, before, unused);

  IterationReport report;
  report.iterations = 1;
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (active[c] && !rows[c].fixed)
      report.residual = std::max(report.residual,
                                 -dot<dim>(delassus.relative_velocity(rows[c], v), rows[c].normal));
  MPI_Allreduce(MPI_IN_PLACE, &report.residual, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return report;
}

template IterationReport solve_stick_slip(Delassus<2> &,
                                          const std::vector<bool> &,
                                          std::vector<dealii::Tensor<1, 2>> &,
                                          LaneVelocities<2> &,
                                          MPI_Comm);
template IterationReport solve_stick_slip(Delassus<3> &,
                                          const std::vector<bool> &,
                                          std::vector<dealii::Tensor<1, 3>> &,
                                          LaneVelocities<3> &,
                                          MPI_Comm);
} // namespace coracle::contact
