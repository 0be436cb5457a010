// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/gauss_seidel.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
template <int dim>
GaussSeidel<dim>::GaussSeidel(MPI_Comm communicator, const bool accelerate)
  : communicator(communicator), accelerate(accelerate)
{}

template <int dim>
double
GaussSeidel<dim>::sweep(const Delassus<dim>       &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        const bool                 back,
                        std::vector<Vector>       &impulses,
                        Velocities<dim>           &v) const
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
      const Vector u      = delassus.relative_velocity(row, v);
      const Vector next   = next_impulse<dim>(row, impulses[c], u, target[c], friction);
      const Vector step   = next - impulses[c];
      const double square = step.norm_square();
      if (square == 0)
        continue;
      impulses[c] = next;
      delassus.apply(row, step, v);
      largest = std::max(largest, std::sqrt(square) * row.normal_inverse_mass);
    }
  return largest;
}

template <int dim>
double
GaussSeidel<dim>::residual(const Delassus<dim>       &delassus,
                           const std::vector<double> &target,
                           const bool                 friction,
                           const std::vector<Vector> &impulses,
                           const Velocities<dim>     &v) const
{
  double      result = 0;
  const auto &rows   = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (!rows[c].fixed)
      {
        const Vector u    = delassus.relative_velocity(rows[c], v);
        const Vector next = next_impulse<dim>(rows[c], impulses[c], u, target[c], friction);
        result = std::max(result, (next - impulses[c]).norm() * rows[c].normal_inverse_mass);
      }
  return result;
}

template <int dim>
IterationReport
GaussSeidel<dim>::solve(Delassus<dim>             &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        const IterationLimits     &limits,
                        std::vector<Vector>       &impulses,
                        Velocities<dim>           &v)
{
  const auto &rows = delassus.rows();
  // Velocities with the impulses to start from.
  before        = v;
  double unused = 0;
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (rows[c].fixed)
      impulses[c] = Vector();
    else if (impulses[c].norm_square() > 0)
      delassus.apply(rows[c], impulses[c], v);
  delassus.synchronise(v, before, unused);

  IterationReport report;
  const auto      finished = [&] {
    report.residual = residual(delassus, target, friction, impulses, v);
    MPI_Allreduce(MPI_IN_PLACE, &report.residual, 1, MPI_DOUBLE, MPI_MAX, communicator);
    report.converged = (report.residual <= limits.tolerance);
    return report.converged || report.iterations >= limits.iterations;
  };
  if (finished())
    return report;
  momentum.restart(impulses, v);
  for (;;)
    {
      before         = v;
      double largest = sweep(delassus, target, friction, false, impulses, v);
      largest        = std::max(largest, sweep(delassus, target, friction, true, impulses, v));
      double turn    = (accelerate ? momentum.turn(delassus, impulses) : 0.);
      delassus.synchronise(v, before, turn);
      MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
      ++report.iterations;
      // The changes of an iteration are a cheap first indication.
      if ((largest <= limits.tolerance || report.iterations >= limits.iterations) && finished())
        return report;
      if (accelerate)
        momentum.extrapolate(turn > 0, impulses, v);
    }
}

template class GaussSeidel<2>;
template class GaussSeidel<3>;
} // namespace coracle::contact
