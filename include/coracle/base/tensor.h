// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/pack.h>

#include <array>

/**
 * The few tensor operations of the hot loops, for doubles and for packs alike.
 * Everywhere else dealii::Tensor is used.
 */
namespace coracle
{
/// A vector of dim components of type T.
template <int dim, typename T>
using Vector = std::array<T, dim>;

/// A full tensor, rows first: m[i][j]. A velocity gradient has L[i][j] = dv_i/dx_j.
template <int dim, typename T>
using Matrix = std::array<std::array<T, dim>, dim>;

/**
 * A symmetric tensor in three-dimensional space. Plane strain (dim = 2) keeps
 * its out-of-plane normal component, so that pressure and invariants are right:
 *   dim = 2: xx, yy, zz, xy        dim = 3: xx, yy, zz, xy, yz, xz
 * Shear entries are tensor components (half the engineering shear strain).
 */
template <int dim, typename T>
struct Symmetric
{
  static constexpr int size = (dim == 2 ? 4 : 6);

  std::array<T, size> s{};

  T       &operator[](const int i) { return s[i]; }
  const T &operator[](const int i) const { return s[i]; }

  /// Index of component (i, j) with i, j < dim.
  static constexpr int index(const int i, const int j)
  {
    return i == j ? i : (i + j == 1 ? 3 : (i + j == 3 ? 4 : 5));
  }

  T       &operator()(const int i, const int j) { return s[index(i, j)]; }
  const T &operator()(const int i, const int j) const { return s[index(i, j)]; }

  T trace() const { return s[0] + s[1] + s[2]; }
};

template <int dim, typename T>
inline T
trace(const Matrix<dim, T> &a)
{
  T result = a[0][0];
  for (int i = 1; i < dim; ++i)
    result += a[i][i];
  return result;
}

template <int dim, typename T>
inline T
determinant(const Matrix<dim, T> &a)
{
  if constexpr (dim == 2)
    return a[0][0] * a[1][1] - a[0][1] * a[1][0];
  else
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/// Inverse times determinant; the caller has the determinant already.
template <int dim, typename T>
inline Matrix<dim, T>
adjugate(const Matrix<dim, T> &a)
{
  Matrix<dim, T> r;
  if constexpr (dim == 2)
    {
      r[0] = {{a[1][1], -a[0][1]}};
      r[1] = {{-a[1][0], a[0][0]}};
    }
  else
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        {
          const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
          r[j][i] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
  return r;
}

template <int dim, typename T>
inline Matrix<dim, T>
product(const Matrix<dim, T> &a, const Matrix<dim, T> &b)
{
  Matrix<dim, T> r;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      {
        r[i][j] = a[i][0] * b[0][j];
        for (int k = 1; k < dim; ++k)
          r[i][j] += a[i][k] * b[k][j];
      }
  return r;
}

template <int dim, typename T>
inline Matrix<dim, T>
identity()
{
  Matrix<dim, T> r{};
  for (int i = 0; i < dim; ++i)
    r[i][i] = splat<T>(1.);
  return r;
}

/// Symmetric part; plane strain has no out-of-plane rate.
template <int dim, typename T>
inline Symmetric<dim, T>
symmetric_part(const Matrix<dim, T> &a)
{
  Symmetric<dim, T> r;
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j)
      r(i, j) = 0.5 * (a[i][j] + a[j][i]);
  return r;
}
} // namespace coracle
