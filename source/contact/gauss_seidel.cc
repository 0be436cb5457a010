// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/gauss_seidel.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// Sweeps that settle which contacts are closed before the face solver goes on from there.
constexpr unsigned int sweeps_per_face = 2;
} // namespace

template <int dim>
GaussSeidel<dim>::GaussSeidel(MPI_Comm communicator, const bool accelerate)
  : communicator(communicator), accelerate(accelerate), face_solver(communicator)
{}

template <int dim>
typename GaussSeidel<dim>::Size
GaussSeidel<dim>::sweep(const Delassus<dim>       &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        std::vector<Vector>       &impulses,
                        Velocities<dim>           &v)
{
  Size        result;
  const auto &rows = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      const auto &row = rows[c];
      step[c]         = Vector();
      if (row.fixed)
        continue;
      const Vector u      = delassus.relative_velocity(row, v);
      const Vector next   = next_impulse<dim>(row, impulses[c], u, target[c], friction);
      step[c]             = next - impulses[c];
      impulses[c]         = next;
      const double square = step[c].norm_square();
      if (square == 0)
        continue;
      delassus.apply(row, step[c], v);
      result.square += square * row.normal_inverse_mass;
      result.largest = std::max(result.largest, std::sqrt(square) * row.normal_inverse_mass);
    }
  return result;
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
  step.resize(rows.size());
  if (accelerate)
    face_solver.reinit(delassus, v);

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
  for (;;)
    {
      before    = v;
      Size size = sweep(delassus, target, friction, impulses, v);
      delassus.synchronise(v, before, size.square);
      MPI_Allreduce(MPI_IN_PLACE, &size.largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
      ++report.iterations;
      // The changes of a sweep are a cheap first indication.
      if ((size.largest <= limits.tolerance || report.iterations >= limits.iterations) &&
          finished())
        return report;
      if (accelerate && report.iterations % sweeps_per_face == 0)
        report.face_steps += face_solver.improve(delassus, target, friction, impulses, v);
    }
}

template class GaussSeidel<2>;
template class GaussSeidel<3>;
} // namespace coracle::contact
