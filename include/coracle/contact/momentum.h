// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/delassus.h>

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
 */
template <int dim>
class Momentum
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// At the start of a solve.
  void restart(const std::vector<Vector> &impulses, const Velocities<dim> &v);

  /// (start - P) . (P - P_last) of this rank's contacts [J]: positive when the iteration that
  /// began at `start` has turned back.
  double turn(const Delassus<dim> &delassus, const std::vector<Vector> &impulses) const;

  /**
   * Impulses and velocities move on to where the next iteration starts.
   * @param turned turn() > 0 in the sum over all ranks
   */
  void extrapolate(const bool turned, std::vector<Vector> &impulses, Velocities<dim> &v);

private:
  double              t = 1;
  std::vector<Vector> last, start;
  Velocities<dim>     last_velocity;
};
} // namespace coracle::contact
