// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/structure/rigid_rotation.h>

#include <cmath>

namespace coracle
{
namespace
{
using Vector3    = dealii::Tensor<1, 3>;
using Matrix3    = dealii::Tensor<2, 3>;
using Quaternion = std::array<double, 4>;

/// First turn by b, then by a; of unit length again.
Quaternion
product(const Quaternion &a, const Quaternion &b)
{
  Quaternion   r    = {{a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                        a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
                        a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1]}};
  const double norm = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  for (double &component : r)
    component /= norm;
  return r;
}

/// exp of a rotation vector.
Quaternion
rotation_by(const Vector3 &vector)
{
  const double half = 0.5 * vector.norm();
  // sin(half) / |vector|, also for a tiny one.
  const double s = (half > 1e-8 ? 0.5 * std::sin(half) / half : 0.5);
  return {{std::cos(half), s * vector[0], s * vector[1], s * vector[2]}};
}

Matrix3
matrix(const Quaternion &q)
{
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  Matrix3      r;
  r[0][0] = 1 - 2 * (y * y + z * z);
  r[0][1] = 2 * (x * y - w * z);
  r[0][2] = 2 * (x * z + w * y);
  r[1][0] = 2 * (x * y + w * z);
  r[1][1] = 1 - 2 * (x * x + z * z);
  r[1][2] = 2 * (y * z - w * x);
  r[2][0] = 2 * (x * z - w * y);
  r[2][1] = 2 * (y * z + w * x);
  r[2][2] = 1 - 2 * (x * x + y * y);
  return r;
}
} // namespace

RigidRotation::RigidRotation(const dealii::Tensor<2, 3> &inertia,
                             const std::array<bool, 3>  &is_free)
  : body_inertia(inertia), is_free(is_free)
{}

Matrix3
RigidRotation::inertia_at(const Quaternion &q) const
{
  const Matrix3 r = matrix(q);
  return r * body_inertia * dealii::transpose(r);
}

Matrix3
RigidRotation::inverse_inertia_at(const Quaternion &q) const
{
  // Unit rows for the axes that are not free decouple them from the rest.
  Matrix3 m = inertia_at(q);
  for (int i = 0; i < 3; ++i)
    if (!is_free[i])
      for (int j = 0; j < 3; ++j)
        m[i][j] = m[j][i] = (i == j ? 1. : 0.);
  m = dealii::invert(m);
  for (int i = 0; i < 3; ++i)
    if (!is_free[i])
      m[i][i] = 0;
  return m;
}

Vector3
RigidRotation::spin_at(const Quaternion &q) const
{
  return given_spin + inverse_inertia_at(q) * (momentum - inertia_at(q) * given_spin);
}

void
RigidRotation::set_spin(const Vector3 &spin)
{
  prescribe(spin);
  momentum = inertia_at(quaternion) * spin;
}

void
RigidRotation::prescribe(const Vector3 &spin)
{
  for (int i = 0; i < 3; ++i)
    given_spin[i] = is_free[i] ? 0. : spin[i];
}

void
RigidRotation::add_angular_impulse(const Vector3 &impulse)
{
  for (int i = 0; i < 3; ++i)
    if (is_free[i])
      momentum[i] += impulse[i];
}

void
RigidRotation::advance(const double dt)
{
  Vector3 spin = spin_at(quaternion);
  for (int iteration = 0; iteration < 50; ++iteration)
    {
      const Vector3 next   = spin_at(product(rotation_by(0.5 * dt * spin), quaternion));
      const double  change = (next - spin).norm();
      spin                 = next;
      if (change <= 1e-15 * spin.norm())
        break;
    }
  quaternion = product(rotation_by(dt * spin), quaternion);
}

void
RigidRotation::turn(const Vector3 &rotation)
{
  quaternion = product(rotation_by(rotation), quaternion);
}

bool
RigidRotation::turn_back(const std::array<double, 4> &start, const double part)
{
  if (quaternion == start || given_spin.norm_square() > 0)
    return false;
  const Quaternion inverse = {{start[0], -start[1], -start[2], -start[3]}};
  Quaternion       r       = product(quaternion, inverse);
  if (r[0] < 0)
    for (double &component : r)
      component = -component;
  const Vector3 axis({r[1], r[2], r[3]});
  const double  s = axis.norm();
  quaternion      = start;
  if (part > 0 && s > 0)
    turn(part * 2 * std::atan2(s, r[0]) / s * axis);
  return true;
}

Vector3
RigidRotation::spin() const
{
  return spin_at(quaternion);
}

Vector3
RigidRotation::angular_momentum() const
{
  return inertia_at(quaternion) * spin();
}

double
RigidRotation::kinetic_energy() const
{
  const Vector3 now = spin();
  return 0.5 * (now * (inertia_at(quaternion) * now));
}

Matrix3
RigidRotation::inverse_inertia() const
{
  return inverse_inertia_at(quaternion);
}

Vector3
RigidRotation::turned(const Vector3 &arm) const
{
  return matrix(quaternion) * arm;
}
} // namespace coracle
