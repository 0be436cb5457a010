// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/gauss_seidel.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// A contact whose change in an iteration is no more than this part of the tolerance is at rest.
constexpr double at_rest = 0.1;
/// Iterations of moving contacts between two of all: at least, and of the iterations so far.
constexpr unsigned int fewest_between = 2;
constexpr double       part_between   = 0.5;
/// If more than this part of the contacts moves, all are visited.
constexpr double most_moving = 0.2;
} // namespace

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
  const auto       &order   = active.contacts();
  const std::size_t n       = order.size();
  for (std::size_t k = 0; k < n; ++k)
    {
      const unsigned int c      = order[back ? n - 1 - k : k];
      const auto        &row    = rows[c];
      const auto *const  slide  = (friction && row.has_friction ? &delassus.sliding(c) : nullptr);
      const Lanes<dim>   u      = delassus.relative_velocity(row, v);
      const Lanes<dim>   next   = next_impulse<dim>(row, slide, impulses[c], u, target[c]);
      const Lanes<dim>   step   = next - impulses[c];
      const double       square = dot<dim>(step, step);
      if (square == 0)
        continue;
      impulses[c] = next;
      delassus.apply(row, step, v);
      const double change = square * row.normal_inverse_mass * row.normal_inverse_mass;
      moving[c] |= (change > quiet_square);
      largest = std::max(largest, change);
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
  moving.resize(rows.size());
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
  active.take_all(delassus);
  momentum.restart(impulses, v);
  quiet_square = std::pow(at_rest * limits.tolerance, 2);
  for (unsigned int next_of_all = 1;;)
    {
      const double largest = one_iteration(delassus, target, friction, v);
      ++report.iterations;
      // The changes of an iteration are a cheap first indication.
      if (!active.complete())
        {
          if (largest <= limits.tolerance || report.iterations + 1 >= next_of_all)
            active.take_all(delassus);
        }
      else if ((largest <= limits.tolerance || report.iterations >= limits.iterations) &&
               finished())
        return report;
      else if (few_move(delassus))
        {
          next_of_all = report.iterations + 1 +
                        std::max<unsigned int>(fewest_between, part_between * report.iterations);
          next_of_all = std::min(next_of_all, limits.iterations);
          if (next_of_all > report.iterations + 1)
            leave_out_resting(delassus);
        }
      if (accelerate)
        momentum.advance(turned, active, impulses, v);
    }
}

template <int dim>
double
GaussSeidel<dim>::one_iteration(Delassus<dim>             &delassus,
                                const std::vector<double> &target,
                                const bool                 friction,
                                LaneVelocities<dim>       &v)
{
  delassus.copy_shared(v, active.nodes(), before);
  for (const unsigned int c : active.contacts())
    moving[c] = 0;
  double largest = sweep(delassus, target, friction, false, v);
  largest        = std::max(largest, sweep(delassus, target, friction, true, v));
  double turn    = 0;
  if (accelerate)
    turn = (in_blocks ? momentum.turn_of_all(delassus, active.contacts(), impulses, communicator)
                      : momentum.turn(delassus, active.contacts(), impulses));
  delassus.synchronise(v, before, turn);
  turned = (turn > 0);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return largest;
}

template <int dim>
bool
GaussSeidel<dim>::moves(const Delassus<dim> &delassus, const unsigned int contact) const
{
  const double size = delassus.rows()[contact].normal_inverse_mass;
  return moving[contact] ||
         (accelerate && momentum.direction_square(contact, impulses) * size * size > quiet_square);
}

template <int dim>
bool
GaussSeidel<dim>::few_move(const Delassus<dim> &delassus) const
{
  double counts[2] = {0, static_cast<double>(active.contacts().size())};
  for (const unsigned int c : active.contacts())
    counts[0] += moves(delassus, c);
  MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_DOUBLE, MPI_SUM, communicator);
  return counts[0] <= most_moving * counts[1];
}

template <int dim>
void
GaussSeidel<dim>::leave_out_resting(Delassus<dim> &delassus)
{
  active.leave_out(delassus, [&](const unsigned int c) { return moves(delassus, c); });
  if (accelerate)
    momentum.stop(delassus, active.resting(), impulses, before);
}

template class GaussSeidel<2>;
template class GaussSeidel<3>;
} // namespace coracle::contact
