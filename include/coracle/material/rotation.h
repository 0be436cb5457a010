// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/tensor.h>

namespace coracle
{
/**
 * Rotation of a step from the spin increment, Cayley's formula
 *
 *   R = (I - W/2)^-1 (I + W/2),     W = dt skew(L)   [1]
 *
 * in closed form: with A = W/2 and a its axial vector R = I + 2/(1 + a.a) (A + A A).
 * R is a rotation to round-off for any W. If L dt is the gradient of the
 * step's displacement with respect to the mid-step positions, then a rigid
 * rotation by any angle below 180 degrees is found exactly (W/2 = tan(angle/2)).
 *
 * Source: Hughes & Winget, Int. J. Numer. Meth. Engng 15 (1980) 1862.
 */
template <int dim, typename T>
inline Matrix<dim, T>
incremental_rotation(const Matrix<dim, T> &velocity_gradient, const double dt)
{
  Matrix<dim, T> a;
  T              a_a = T{};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      {
        a[i][j] = (0.25 * dt) * (velocity_gradient[i][j] - velocity_gradient[j][i]);
        a_a += 0.5 * a[i][j] * a[i][j];
      }
  const T              factor = 2. / (1. + a_a);
  const Matrix<dim, T> aa     = product<dim, T>(a, a);
  Matrix<dim, T>       r      = identity<dim, T>();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      r[i][j] += factor * (a[i][j] + aa[i][j]);
  return r;
}

/// R s R^T; in plane strain the out-of-plane component stays.
template <int dim, typename T>
inline Symmetric<dim, T>
rotated(const Symmetric<dim, T> &s, const Matrix<dim, T> &r)
{
  Matrix<dim, T> rs;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      {
        rs[i][j] = r[i][0] * s(0, j);
        for (int k = 1; k < dim; ++k)
          rs[i][j] += r[i][k] * s(k, j);
      }
  Symmetric<dim, T> result = s;
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j)
      {
        result(i, j) = rs[i][0] * r[j][0];
        for (int k = 1; k < dim; ++k)
          result(i, j) += rs[i][k] * r[j][k];
      }
  return result;
}

/**
 * The mid-step velocity gradient from one taken with respect to the positions
 * at the start of the step: L_mid = L (I + dt/2 L)^-1. Exact for any step in
 * which the velocity is constant in time.
 */
template <int dim, typename T>
inline Matrix<dim, T>
mid_step_gradient(const Matrix<dim, T> &start_gradient, const double dt)
{
  Matrix<dim, T> half = identity<dim, T>();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      half[i][j] += (0.5 * dt) * start_gradient[i][j];
  const T        scale  = 1. / determinant<dim, T>(half);
  Matrix<dim, T> result = product<dim, T>(start_gradient, adjugate<dim, T>(half));
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      result[i][j] *= scale;
  return result;
}
} // namespace coracle
