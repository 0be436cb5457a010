// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/single_contact.h>

namespace coracle::contact
{
/**
 * Accelerates the sweeps of GaussSeidel. Particles that share grid nodes make
 * nearly dependent rows on which sweeps creep; but sweeps soon find out which
 * contacts are closed and which stick. On that face of the problem (normal
 * impulses of closed contacts, friction impulses of sticking ones) the problem
 * is linear, and preconditioned conjugate gradients solve it quickly.
 *
 * Where a step would leave what is admissible, each contact is cut to it, and a
 * projected gradient step of fixed length completes the new face: projected
 * conjugate gradients with the expansion of Dostal & Schoeberl, Minimizing
 * quadratic functions subject to bound constraints with the rate of convergence
 * and finite termination (2005). Sweeps in between close contacts again and
 * treat sliding ones.
 */
template <int dim>
class FaceSolver
{
public:
  using Vector = dealii::Tensor<1, dim>;

  explicit FaceSolver(MPI_Comm communicator);

  /// Collective. At the start of a solve.
  void reinit(const Delassus<dim> &delassus);

  /**
   * Collective. Improves impulses and velocities; returns the number of steps.
   * @param goal residual on the face at which to stop [m/s]
   */
  unsigned int improve(Delassus<dim>             &delassus,
                       const std::vector<double> &target,
                       const bool                 friction,
                       const double               goal,
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

  /// The residual on the face as remainder and first direction.
  void start_face(const Delassus<dim>       &delassus,
                  const std::vector<double> &target,
                  const bool                 friction,
                  const std::vector<Vector> &impulses,
                  const Velocities<dim>     &v);

  /// M^-1 J^T of impulses, over all ranks, as `response`.
  void respond(Delassus<dim> &delassus, const std::vector<Vector> &impulses);

  /// Conjugate gradient step; false if it had to be cut to what is admissible, which ends the face.
  bool   take_step(Delassus<dim>       &delassus,
                   const bool           friction,
                   std::vector<Vector> &impulses,
                   Velocities<dim>     &v);
  double admissible_length(const Delassus<dim>       &delassus,
                           const bool                 friction,
                           const std::vector<Vector> &impulses) const;

  /// Projected gradient step of all contacts.
  void expand(Delassus<dim>             &delassus,
              const std::vector<double> &target,
              const bool                 friction,
              std::vector<Vector>       &impulses,
              Velocities<dim>           &v);

  MPI_Comm            communicator;
  std::vector<Free>   face;
  std::vector<Vector> direction, remainder, change;
  Velocities<dim>     zero, response;
  /// Square of the residual in the preconditioner's norm [J], and its largest entry [m/s].
  double rho = 0, largest = 0;
  /// Largest eigenvalue of the preconditioned problem seen so far.
  double stiffness = 1;
  /// Steps of one run on a face; more while faces last.
  unsigned int n_steps = 4;
};
} // namespace coracle::contact
