// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exact_sum.h>
#include <coracle/contact/blended.h>
#include <coracle/contact/solver.h>
#include <coracle/contact/stick_slip.h>

#include <algorithm>
#include <numeric>

namespace coracle::contact
{
template <int dim>
Solver<dim>::Solver(const ContactOptions &options, MPI_Comm communicator)
  : options(options)
  , communicator(communicator)
  , in_blocks(communicator)
  , delassus(communicator)
  , gauss_seidel(communicator, options.accelerate, options.reproducible)
{}

template <int dim>
void
Solver<dim>::solve(const std::vector<Contact<dim>>                 &contacts,
                   const std::vector<typename WarmStart<dim>::Key> &keys,
                   const Rows                                      &rows,
                   const std::vector<Unknown<dim>>                 &unknowns,
                   const std::vector<RigidUnknown<dim>>            &rigid,
                   const double                                     dt)
{
  Assert(rows.n_contacts() == contacts.size() && rows.begin.size() == 2 * contacts.size() + 1,
         dealii::ExcMessage("One row per side and contact"));
  statistics            = SolverReport();
  statistics.n_contacts = contacts.size();
  result.impulse.assign(contacts.size(), {});
  result.correction.assign(contacts.size(), {});
  MPI_Allreduce(MPI_IN_PLACE, &statistics.n_contacts, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
  if (statistics.n_contacts == 0)
    {
      warm_start.store(keys, result.impulse);
      return;
    }

  if (options.reproducible)
    {
      in_blocks.reinit(block, rows, unknowns, rigid);
      delassus.reinit(contacts, in_blocks);
    }
  else
    delassus.reinit(contacts, rows, unknowns, rigid);
  velocity = delassus.predicted;
  measure(contacts);
  if (options.law != Law::split)
    solve_near(contacts, dt);
  else
    {
      // Impulses grow with the step.
      if (old_dt > 0)
        {
          result.impulse = (options.reproducible ? warm_start.find_on_all_ranks(keys, communicator)
                                                 : warm_start.find(keys));
          for (auto &impulse : result.impulse)
            impulse *= dt / old_dt;
        }
      solve_split(contacts, dt);
      if (options.position_correction)
        solve_positions(contacts, dt);
    }
  warm_start.store(keys, result.impulse);
  old_dt = dt;
}

template <int dim>
void
Solver<dim>::measure(const std::vector<Contact<dim>> &contacts)
{
  for (std::size_t c = 0; c < contacts.size(); ++c)
    statistics.scale = std::max(statistics.scale,
                                -dot<dim>(delassus.relative_velocity(delassus.rows()[c], velocity),
                                          delassus.rows()[c].normal));
  MPI_Allreduce(MPI_IN_PLACE, &statistics.scale, 1, MPI_DOUBLE, MPI_MAX, communicator);
}

template <int dim>
void
Solver<dim>::measure_result(const std::vector<Contact<dim>> &contacts)
{
  work.clear();
  for (std::size_t c = 0; c < contacts.size(); ++c)
    {
      const auto &row = delassus.rows()[c];
      if (row.fixed)
        continue;
      const auto u = to_tensor<dim>(delassus.relative_velocity(row, velocity));
      if (result.impulse[c].norm_square() > 0)
        work.push_back(0.5 *
                       (result.impulse[c] *
                        (u + to_tensor<dim>(delassus.relative_velocity(row, delassus.predicted)))));
      if (options.law == Law::split || active[c])
        statistics.worst_violation =
          std::max(statistics.worst_violation, target[c] - u * contacts[c].normal);
    }
  MPI_Allreduce(MPI_IN_PLACE, &statistics.worst_violation, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (options.reproducible)
    statistics.work = exact_sum(work, communicator);
  else
    {
      statistics.work = std::accumulate(work.begin(), work.end(), 0.);
      MPI_Allreduce(MPI_IN_PLACE, &statistics.work, 1, MPI_DOUBLE, MPI_SUM, communicator);
    }
}

template <int dim>
void
Solver<dim>::solve_split(const std::vector<Contact<dim>> &contacts, const double dt)
{
  target.resize(contacts.size());
  for (std::size_t c = 0; c < contacts.size(); ++c)
    target[c] = -std::max(0., contacts[c].gap - contacts[c].distance) / dt;
  // Where nothing approaches, no impulse is the answer.
  if (statistics.scale <= 0)
    std::fill(result.impulse.begin(), result.impulse.end(), dealii::Tensor<1, dim>());
  statistics.velocity =
    gauss_seidel.solve(delassus,
                       target,
                       true,
                       {options.tolerance * statistics.scale, options.maximum_iterations},
                       result.impulse,
                       velocity);
  measure_result(contacts);
}

template <int dim>
void
Solver<dim>::solve_positions(const std::vector<Contact<dim>> &contacts, const double dt)
{
  // In terms of a displacement per dt, so that the rows serve as they are; tolerance relative to R.
  double deepest = 0, largest_distance = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c)
    {
      const double u = dot<dim>(delassus.relative_velocity(delassus.rows()[c], velocity),
                                delassus.rows()[c].normal);
      target[c]      = (contacts[c].distance - contacts[c].gap) / dt - u;
      if (!delassus.rows()[c].fixed)
        deepest = std::max(deepest, target[c]);
      largest_distance = std::max(largest_distance, contacts[c].distance);
    }
  double both[2] = {deepest, largest_distance};
  MPI_Allreduce(MPI_IN_PLACE, both, 2, MPI_DOUBLE, MPI_MAX, communicator);
  const double tolerance = options.tolerance * both[1] / dt;
  if (both[0] <= tolerance)
    return;
  delassus.set_zero(displacement_rate);
  statistics.position = gauss_seidel.solve(delassus,
                                           target,
                                           false,
                                           {tolerance, options.position_iterations},
                                           result.correction,
                                           displacement_rate);
  for (auto &correction : result.correction)
    correction *= dt;
  for (const auto &rate : displacement_rate.nodes)
    statistics.largest_correction =
      std::max(statistics.largest_correction, dt * to_tensor<dim>(rate).norm());
  MPI_Allreduce(MPI_IN_PLACE, &statistics.largest_correction, 1, MPI_DOUBLE, MPI_MAX, communicator);
}

template <int dim>
void
Solver<dim>::solve_near(const std::vector<Contact<dim>> &contacts, const double dt)
{
  target.resize(contacts.size());
  active.resize(contacts.size());
  const double blend = (options.law == Law::blended ? options.alpha : 0.);
  for (std::size_t c = 0; c < contacts.size(); ++c)
    {
      active[c] = (contacts[c].gap < contacts[c].distance);
      target[c] = blend * (contacts[c].distance - contacts[c].gap) / dt;
    }
  const double scale = std::max(statistics.scale, 1e-300);
  if (options.law == Law::stick_slip)
    statistics.velocity =
      solve_stick_slip(delassus, active, result.impulse, velocity, communicator);
  else
    statistics.velocity = solve_blended(delassus,
                                        target,
                                        active,
                                        {options.tolerance * scale, options.maximum_iterations},
                                        result.impulse,
                                        velocity,
                                        communicator);
  measure_result(contacts);
}

template <int dim>
Velocities<dim>
Solver<dim>::velocities() const
{
  Assert(!options.reproducible, dealii::ExcMessage("These are copies"));
  Velocities<dim> result{{}, velocity.rigid, velocity.spin};
  for (const auto &node : velocity.nodes)
    result.nodes.push_back(to_tensor<dim>(node));
  return result;
}

template class Solver<2>;
template class Solver<3>;
} // namespace coracle::contact
