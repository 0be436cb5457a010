// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/gauss_seidel.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
template <int dim>
GaussSeidel<dim>::GaussSeidel(MPI_Comm communicator, const bool accelerate, const bool in_blocks)
  : communicator(communicator), accelerate(accelerate), in_blocks(in_blocks)
{}

template <int dim>
double
GaussSeidel<dim>::sweep(const Delassus<dim>       &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        const bool                 back,
                        LaneVelocities<dim>       &v)
{
  double            largest = 0;
  const auto       &rows    = delassus.rows();
  const std::size_t n       = rows.size();
  for (std::size_t k = 0; k < n; ++k)
    {
      const std::size_t c   = (back ? n - 1 - k : k);
      const auto       &row = rows[c];
      if (row.fixed)
        continue;
      const auto *const slide  = (friction && row.has_friction ? &delassus.sliding(c) : nullptr);
      const Lanes<dim>  u      = delassus.relative_velocity(row, v);
      const Lanes<dim>  next   = next_impulse<dim>(row, slide, impulses[c], u, target[c]);
      const Lanes<dim>  step   = next - impulses[c];
      const double      square = dot<dim>(step, step);
      if (square == 0)
        continue;
      impulses[c] = next;
      delassus.apply(row, step, v);
      largest = std::max(largest, square * row.normal_inverse_mass * row.normal_inverse_mass);
    }
  return std::sqrt(largest);
}

template <int dim>
double
GaussSeidel<dim>::residual(const Delassus<dim>       &delassus,
                           const std::vector<double> &target,
                           const bool                 friction,
                           const LaneVelocities<dim> &v) const
{
  double      result = 0;
  const auto &rows   = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (!rows[c].fixed)
      {
        const auto *const slide =
          (friction && rows[c].has_friction ? &delassus.sliding(c) : nullptr);
        const Lanes<dim> u = delassus.relative_velocity(rows[c], v);
        const Lanes<dim> step =
          next_impulse<dim>(rows[c], slide, impulses[c], u, target[c]) - impulses[c];
        const double size = rows[c].normal_inverse_mass;
        result            = std::max(result, dot<dim>(step, step) * size * size);
      }
  return std::sqrt(result);
}

template <int dim>
IterationReport
GaussSeidel<dim>::solve(Delassus<dim>             &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        const IterationLimits     &limits,
                        std::vector<Vector>       &result,
                        LaneVelocities<dim>       &v)
{
  const auto &rows = delassus.rows();
  impulses.resize(rows.size());
  // Velocities with the impulses to start from.
  before        = v;
  double unused = 0;
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      impulses[c] = (rows[c].fixed ? Lanes<dim>{} : to_lanes<dim>(result[c]));
      if (dot<dim>(impulses[c], impulses[c]) > 0)
        delassus.apply(rows[c], impulses[c], v);
    }
  delassus.synchronise(v, before, unused);
  const auto report = iterate(delassus, target, friction, limits, v);
  for (std::size_t c = 0; c < rows.size(); ++c)
    result[c] = to_tensor<dim>(impulses[c]);
  return report;
}

template <int dim>
IterationReport
GaussSeidel<dim>::iterate(Delassus<dim>             &delassus,
                          const std::vector<double> &target,
                          const bool                 friction,
                          const IterationLimits     &limits,
                          LaneVelocities<dim>       &v)
{
  IterationReport report;
  const auto      finished = [&] {
    report.residual = residual(delassus, target, friction, v);
    MPI_Allreduce(MPI_IN_PLACE, &report.residual, 1, MPI_DOUBLE, MPI_MAX, communicator);
    report.converged = (report.residual <= limits.tolerance);
    return report.converged || report.iterations >= limits.iterations;
  };
  if (finished())
    return report;
  momentum.restart(impulses, v);
  for (;;)
    {
      if (in_blocks || n_ranks(communicator) > 1)
        before = v;
      double largest = sweep(delassus, target, friction, false, v);
      largest        = std::max(largest, sweep(delassus, target, friction, true, v));
      double turn    = 0;
      if (accelerate)
        turn = (in_blocks ? momentum.turn_of_all(delassus, impulses, communicator)
                          : momentum.turn(delassus, impulses));
      delassus.synchronise(v, before, turn);
      MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
      ++report.iterations;
      // The changes of an iteration are a cheap first indication.
      if ((largest <= limits.tolerance || report.iterations >= limits.iterations) && finished())
        return report;
      if (accelerate)
        momentum.advance(turn > 0, impulses, v);
    }
}

template class GaussSeidel<2>;
template class GaussSeidel<3>;
} // namespace coracle::contact
