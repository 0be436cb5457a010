// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/active_contacts.h>

namespace coracle::contact
{
/**
 * Accelerates GaussSeidel: each iteration starts from where the last two were
 * heading, P + theta (P - P_last), and from the velocities that belong to it.
 * theta grows towards 1 as in Nesterov's method (Y. Nesterov, Soviet Math.
 * Doklady 27 (1983) 372-376); it starts again from 0 when the iteration turns
 * back on the direction of travel (B. O'Donoghue, E. Candes, Found. Comput.
 * Math. 15 (2015) 715-732), which also keeps friction, that has no potential,
 * from running away.
 *
 * Particles that share grid nodes make nearly dependent rows; on such problems
 * it needs the square root of the iterations of plain sweeps, and unlike
 * conjugate gradients it need not know which contacts are closed.
 *
 * What momentum leaves behind where contacts open and close dies out slowly,
 * because it is carried on; the rest is solved long before. So from time to time
 * it rests: a tenth of the iterations so far are made without it, which may end
 * the iteration, and then it goes on with the direction it had.
 */
template <int dim>
class Momentum
{
public:
  /// At the start of a solve.
  void restart(const std::vector<Lanes<dim>> &impulses, const LaneVelocities<dim> &v);

  /// (start - P) . (P - P_last) of these contacts [J]: positive when the iteration that began at
  /// `start` has turned back.
  double turn(const Delassus<dim>             &delassus,
              const std::vector<unsigned int> &contacts,
              const std::vector<Lanes<dim>>   &impulses) const;
  /// The same of all ranks' contacts, in an exact sum. Collective.
  double turn_of_all(const Delassus<dim>             &delassus,
                     const std::vector<unsigned int> &contacts,
                     const std::vector<Lanes<dim>>   &impulses,
                     MPI_Comm                         communicator) const;

  /// Square of P - P_last of a contact [N^2 s^2].
  double direction_square(const unsigned int contact, const std::vector<Lanes<dim>> &impulses) const
  {
    const Lanes<dim> d = direction(contact, impulses);
    return dot<dim>(d, d);
  }

  /**
   * Collective. Between iteration and advance(): these contacts lose their
   * momentum, and so do the velocities that it has changed.
   * @param before room for shared velocities
   */
  void stop(Delassus<dim>                   &delassus,
            const std::vector<unsigned int> &contacts,
            const std::vector<Lanes<dim>>   &impulses,
            LaneVelocities<dim>             &before);

  /**
   * After an iteration: impulses and velocities of what is active move on to where
   * the next one starts.
   * @param turned turn() > 0 in the sum over all ranks
   */
  void advance(const bool                 turned,
               const ActiveContacts<dim> &active,
               std::vector<Lanes<dim>>   &impulses,
               LaneVelocities<dim>       &v);

private:
  void extrapolate(const bool                 turned,
                   const ActiveContacts<dim> &active,
                   std::vector<Lanes<dim>>   &impulses,
                   LaneVelocities<dim>       &v);
  /// P - P_last.
  Lanes<dim> direction(const unsigned int contact, const std::vector<Lanes<dim>> &impulses) const
  {
    return resting() ? -last[contact] : impulses[contact] - last[contact];
  }
  bool resting() const { return iteration < rest_end; }
  /// During a rest `last` is kept relative to the present: -1 makes it so, +1 undoes it.
  void make_relative(const double                   sign,
                     const std::vector<Lanes<dim>> &impulses,
                     const LaneVelocities<dim>     &v);

  /// Iterations since the start, at which of them the next rest begins, and where it ends.
  unsigned int            iteration = 0, rest_begin = 0, rest_end = 0;
  double                  t = 1;
  std::vector<Lanes<dim>> last, start;
  LaneVelocities<dim>     last_velocity;
};
} // namespace coracle::contact
