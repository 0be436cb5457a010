// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/gauss_seidel.h>
#include <coracle/contact/options.h>
#include <coracle/contact/warm_start.h>

namespace coracle::contact
{
/// How the contacts of a step came out; the same on all ranks.
struct SolverReport
{
  unsigned long   n_contacts = 0;
  IterationReport velocity, position;
  /// Greatest predicted approach speed, to which the residual is relative [m/s].
  double scale = 0;
  /// Greatest amount by which a contact is still too fast after the solve [m/s].
  double worst_violation = 0;
  /// Work of the contacts in this step [J]: sum of P . (u_before + u_after) / 2, which is the
  /// change of the kinetic energy of all unknowns plus what prescribed motion takes up.
  double work = 0;
  /// Greatest displacement by the position solve [m].
  double largest_correction = 0;

  void serialize(Archive &archive)
  {
    archive.same("n_contacts", n_contacts);
    archive.same("scale", scale);
    archive.same("worst_violation", worst_violation);
    archive.same("work", work);
    archive.same("largest_correction", largest_correction);
    {
      const Archive::Section section(archive, "velocity");
      velocity.serialize(archive);
    }
    const Archive::Section section(archive, "position");
    position.serialize(archive);
  }
};

/**
 * Impulses of all contacts of a step, on all ranks together.
 *
 * Law `split`: at velocity level u_n >= -(g - R)/dt while the gap g is wider
 * than R, and u_n >= 0 from there on, so that no point gets nearer than R within
 * the step and nothing is thrown out; Coulomb friction on the same impulses.
 * What depth there is (curved paths, faces that turn) is removed by a second
 * solve with the same rows, g + dt u_n + c_n >= R, whose result moves positions
 * only.
 *
 * Law `blended`: Song, Liu & Zhang (2020), Eqs. 62-65, see solve_blended().
 * Law `stick/slip`: Chen et al. (2015), Eqs. 48-52, see solve_stick_slip().
 */
template <int dim>
class Solver
{
public:
  Solver(const ContactOptions &options, MPI_Comm communicator);

  /**
   * Collective, also for ranks without contacts.
   * @param keys identity of each contact from step to step
   */
  void solve(const std::vector<Contact<dim>>                 &contacts,
             const std::vector<typename WarmStart<dim>::Key> &keys,
             const Rows                                      &rows,
             const std::vector<Unknown<dim>>                 &unknowns,
             const std::vector<RigidUnknown<dim>>            &rigid,
             const double                                     dt);

  /// Before solve(), for results that do not depend on the ranks: the block of each contact.
  void set_blocks(const std::vector<std::uint64_t> &block_of_contact) { block = block_of_contact; }
  BlockRows<dim> &blocks() { return in_blocks; }

  const Impulses<dim> &impulses() const { return result; }
  const SolverReport  &report() const { return statistics; }

  /// What the impulses make of the predicted velocities.
  Velocities<dim> velocities() const;

  /// The next solve starts from nothing.
  void forget_impulses() { warm_start.store({}, {}); }

  /// What one step hands to the next.
  void serialize(Archive &archive)
  {
    warm_start.serialize(archive);
    archive.same("old_dt", old_dt);
  }

private:
  void solve_split(const std::vector<Contact<dim>> &contacts, const double dt);
  void solve_positions(const std::vector<Contact<dim>> &contacts, const double dt);
  /// The published laws, that act on contacts nearer than R only.
  void solve_near(const std::vector<Contact<dim>> &contacts, const double dt);
  void measure(const std::vector<Contact<dim>> &contacts);
  /// What the solve has left and done: worst violation of the targets, and work.
  void measure_result(const std::vector<Contact<dim>> &contacts);

  ContactOptions             options;
  MPI_Comm                   communicator;
  BlockRows<dim>             in_blocks;
  std::vector<std::uint64_t> block;
  Delassus<dim>              delassus;
  GaussSeidel<dim>           gauss_seidel;
  WarmStart<dim>             warm_start;
  LaneVelocities<dim>        velocity, displacement_rate;
  std::vector<double>        target, work;
  std::vector<bool>          active;
  Impulses<dim>              result;
  SolverReport               statistics;
  double                     old_dt = 0;
};
} // namespace coracle::contact
