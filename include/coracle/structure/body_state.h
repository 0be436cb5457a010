// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <coracle/base/archive.h>

namespace coracle
{
/**
 * Energies of a body [J] (per metre of depth in 2-D), all at the half step its
 * velocities live at, so that to round-off
 *
 *   kinetic - initial kinetic = external_work + contact_work - damping - strain - hourglass.
 */
struct Energies
{
  double kinetic = 0;
  /// Work done on the material: stored, and what plasticity or viscosity took; and what
  /// refinement of the mesh took of the kinetic energy.
  double strain = 0;
  /// Work done on the springs of one-point elements.
  double hourglass = 0;
  /// Taken by mass-proportional damping.
  double damping = 0;
  /// Work of contact impulses on the body.
  double contact_work = 0;
  /// Work of gravity, loads, and of the supports of prescribed motion.
  double external_work = 0;

  /// Of one rank's share.
  void serialize(Archive &archive)
  {
    archive.share("kinetic", kinetic);
    archive.share("strain", strain);
    archive.share("hourglass", hourglass);
    archive.share("damping", damping);
    archive.share("contact_work", contact_work);
    archive.share("external_work", external_work);
  }
};

/// One body as a whole.
template <int dim>
struct BodySummary
{
  /// [kg], of one metre of depth in 2-D
  double mass = 0;
  /// [m]
  dealii::Point<dim> centre;
  /// Of the centre [m/s].
  dealii::Tensor<1, dim> velocity;
  /// Mean over the last step, on the body [N].
  dealii::Tensor<1, dim> contact_force;
  /// Of the contact force about the centre [N m]; in 2-D component 2.
  dealii::Tensor<1, 3> contact_moment;
  /// Angular velocity of a rigid body [rad/s]; in 2-D component 2.
  dealii::Tensor<1, 3> spin;
};

/// a x b in 3-D, its z component as (0, 0, c) in 2-D.
template <int dim>
inline dealii::Tensor<1, 3>
moment_of(const dealii::Tensor<1, dim> &arm, const dealii::Tensor<1, dim> &force)
{
  dealii::Tensor<1, 3> moment;
  if constexpr (dim == 2)
    moment[2] = arm[0] * force[1] - arm[1] * force[0];
  else
    moment = dealii::cross_product_3d(arm, force);
  return moment;
}

/// spin x arm.
template <int dim>
inline dealii::Tensor<1, dim>
velocity_from_spin(const dealii::Tensor<1, 3> &spin, const dealii::Tensor<1, dim> &arm)
{
  dealii::Tensor<1, dim> velocity;
  if constexpr (dim == 2)
    {
      velocity[0] = -spin[2] * arm[1];
      velocity[1] = spin[2] * arm[0];
    }
  else
    velocity = dealii::cross_product_3d(spin, arm);
  return velocity;
}
} // namespace coracle
