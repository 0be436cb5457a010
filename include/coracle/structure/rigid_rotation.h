// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/tensor.h>

#include <coracle/base/archive.h>

#include <array>

namespace coracle
{
/**
 * Rotation of a rigid body about its centre, in three dimensions (2-D bodies
 * have the z axis only). The state is the orientation and, for the axes that
 * are free, the angular momentum; the spin about the others is given.
 *
 * With S the free axes (global x, y, z), omega_S = (I_SS)^-1 (L_S - (I omega')_S),
 * where omega' is the given spin and I the inertia in the current frame.
 *
 * The angular momentum is kept exactly while no moment acts. The step is the
 * symmetric one of second order that turns by the spin at its middle, found by
 * iteration; energy then oscillates and does not drift.
 *
 * Source: Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), VII.5,
 * with the implicit midpoint rule on the rotation group.
 */
class RigidRotation
{
public:
  using Vector3 = dealii::Tensor<1, 3>;

  RigidRotation() = default;
  /// @param inertia about the centre, unturned [kg m^2]; @param is_free global axes
  RigidRotation(const dealii::Tensor<2, 3> &inertia, const std::array<bool, 3> &is_free);

  /// Spin of all axes [rad/s].
  void set_spin(const Vector3 &spin);
  /// Given spin of the axes that are not free; entries of free ones are ignored.
  void prescribe(const Vector3 &spin);
  /// Angular impulse [N m s]; what supports take is left out.
  void add_angular_impulse(const Vector3 &impulse);
  /// Turn by what the spin gives in a time [s].
  void advance(const double dt);
  /// Turn by a rotation vector [rad].
  void turn(const Vector3 &rotation);
  /// Keeps a part of the turn since an orientation [1], unless a given spin has a share in it;
  /// returns whether there was any.
  bool turn_back(const std::array<double, 4> &start, const double part);

  Vector3 spin() const;
  /// I omega [kg m^2/s].
  Vector3              angular_momentum() const;
  double               kinetic_energy() const;
  dealii::Tensor<2, 3> inverse_inertia() const;
  /// An arm of the unturned body, turned.
  Vector3 turned(const Vector3 &arm) const;
  /// w, x, y, z of the unit quaternion.
  const std::array<double, 4> &orientation() const { return quaternion; }

  void serialize(Archive &archive)
  {
    archive.same("orientation", quaternion);
    archive.same("angular_momentum", momentum);
    archive.same("given_spin", given_spin);
  }

private:
  using Quaternion = std::array<double, 4>;
  using Matrix3    = dealii::Tensor<2, 3>;

  Matrix3 inertia_at(const Quaternion &q) const;
  /// (I_SS)^-1, zero elsewhere.
  Matrix3 inverse_inertia_at(const Quaternion &q) const;
  Vector3 spin_at(const Quaternion &q) const;

  Matrix3             body_inertia;
  std::array<bool, 3> is_free{};
  Quaternion          quaternion{{1, 0, 0, 0}};
  /// Of the free axes; and the given spin of the others.
  Vector3 momentum, given_spin;
};
} // namespace coracle
