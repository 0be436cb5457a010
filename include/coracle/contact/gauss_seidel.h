// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/contact/momentum.h>
#include <coracle/contact/single_contact.h>

namespace coracle::contact
{
/// When an iteration ends.
struct IterationLimits
{
  /// Residual, as a velocity [m/s].
  double       tolerance;
  unsigned int iterations;
};

/// How an iteration ended.
struct IterationReport
{
  unsigned int iterations = 0;
  /// Largest complementarity residual, as a velocity [m/s].
  double residual  = 0;
  bool   converged = true;

  void serialize(Archive &archive)
  {
    archive.same("iterations", iterations);
    archive.same("residual", residual);
    archive.same("converged", converged);
  }
};

/**
 * Solves, for all contacts together,
 *   u_n - target >= 0,  P_n >= 0,  P_n (u_n - target) = 0      (no penetration, no adhesion)
 *   |P_t| <= mu P_n, u_t = 0 or P_t opposite to u_t             (Coulomb)
 * with u = J (v + M^-1 J^T P), by projected Gauss-Seidel on accumulated impulses
 * P: an increment may be negative, the sum may not.
 *
 * An iteration is a sweep over the contacts there and one back, so that errors
 * decay without oscillating, and Momentum can accelerate it. Where few contacts
 * still move, iterations of these alone come between those of all
 * (ActiveContacts). The last thing before the end is always an iteration of all,
 * so that P is admissible.
 */
template <int dim>
class GaussSeidel
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// @param in_blocks contacts come in blocks (BlockRows), and results do not depend on the ranks
  explicit GaussSeidel(MPI_Comm   communicator,
                       const bool accelerate = true,
                       const bool in_blocks  = false);

  /**
   * Collective.
   * @param target    least normal velocity per contact [m/s]
   * @param friction  false: normal impulses only
   * @param impulses  start value in, solution out [N s]
   * @param v         velocities without P in, with P out
   */
  IterationReport solve(Delassus<dim>             &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        const IterationLimits     &limits,
                        std::vector<Vector>       &impulses,
                        LaneVelocities<dim>       &v);

private:
  IterationReport iterate(Delassus<dim>             &delassus,
                          const std::vector<double> &target,
                          const bool                 friction,
                          const IterationLimits     &limits,
                          LaneVelocities<dim>       &v);

  /// One pass over the contacts in either direction; the largest change as a velocity [m/s].
  double sweep(const Delassus<dim>       &delassus,
               const std::vector<double> &target,
               const bool                 friction,
               const bool                 back,
               LaneVelocities<dim>       &v);

  /// Largest violation of the conditions above with everything held fixed, on this rank [m/s].
  double residual(const Delassus<dim>       &delassus,
                  const std::vector<double> &target,
                  const bool                 friction,
                  const LaneVelocities<dim> &v) const;

  /// Of the active contacts; the largest change as a velocity [m/s], of all ranks.
  double one_iteration(Delassus<dim>             &delassus,
                       const std::vector<double> &target,
                       const bool                 friction,
                       LaneVelocities<dim>       &v);

  /// Does an active contact's impulse still change, or will momentum change it?
  bool moves(const Delassus<dim> &delassus, const unsigned int contact) const;
  bool few_move(const Delassus<dim> &delassus) const;
  void leave_out_resting(Delassus<dim> &delassus);

  MPI_Comm            communicator;
  bool                accelerate, in_blocks, turned = false;
  Momentum<dim>       momentum;
  ActiveContacts<dim> active;
  LaneVelocities<dim> before;
  /// Of each active contact: did its impulse change in this iteration?
  std::vector<char> moving;
  double            quiet_square = 0;
  /// Accumulated impulses P.
  std::vector<Lanes<dim>> impulses;
};
} // namespace coracle::contact
