// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/delassus.h>

namespace coracle::contact
{
/**
 * Accelerates the sweeps of GaussSeidel. Particles that share grid nodes make
 * nearly dependent rows on which sweeps creep; but sweeps soon find out which
 * contacts are closed and which stick. On that face of the problem (normal
 * impulses of closed contacts, friction impulses of sticking ones) the problem
 * is linear, and preconditioned conjugate gradients solve it quickly. The
 * result is projected back to what is admissible and taken only if it lowers
 *   sum P . (u + u_free) / 2 - P_n target,
 * whose minimum the solution is (without friction exactly); else a shorter way
 * in the same direction is tried. Sweeps and face solves alternate as in
 * Silcowitz-Hansen, Niebe & Erleben, Projected Gauss-Seidel subspace
 * minimization method for interactive rigid body dynamics (2010).
 */
template <int dim>
class FaceSolver
{
public:
  using Vector = dealii::Tensor<1, dim>;

  explicit FaceSolver(MPI_Comm communicator);

  /// Collective. At the start of a solve: the velocities without impulses.
  void reinit(const Delassus<dim> &delassus, const Velocities<dim> &free);

  /// Collective. Improves impulses and velocities; returns the number of conjugate gradient steps.
  unsigned int improve(Delassus<dim>             &delassus,
                       const std::vector<double> &target,
                       const bool                 friction,
                       std::vector<Vector>       &impulses,
                       Velocities<dim>           &v);

private:
  /// What of a contact's impulse may change.
  enum class Free : unsigned char
  {
    nothing,
    normal,
    all
  };

  void   find_face(const Delassus<dim>       &delassus,
                   const bool                 friction,
                   const std::vector<Vector> &impulses);
  Vector restrict_to_face(const std::size_t c, const Vector &normal, const Vector &a) const;
  /// way = solution on the face minus present impulses.
  unsigned int conjugate_gradients(Delassus<dim>             &delassus,
                                   const std::vector<double> &target,
                                   const Velocities<dim>     &v);
  /// Velocities of impulses: M^-1 J^T of the argument, over all ranks.
  void
  respond(Delassus<dim> &delassus, const std::vector<Vector> &impulses, Velocities<dim> &result);
  double energy(const Delassus<dim>       &delassus,
                const std::vector<double> &target,
                const std::vector<Vector> &impulses,
                const Velocities<dim>     &v) const;
  double sum(double a) const;

  MPI_Comm            communicator;
  unsigned int        n_steps = 8;
  std::vector<Vector> free_velocity;
  std::vector<Free>   face;
  std::vector<Vector> way, direction, remainder, trial, change;
  Velocities<dim>     zero, response, moved;
};
} // namespace coracle::contact
