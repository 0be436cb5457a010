// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/tensor.h>

/**
 * Geometry of 4-node quadrilaterals and 8-node hexahedra for packs of elements.
 *
 * Nodes are numbered as deal.II does, bit b of a node's number telling its side
 * in direction b. A nodal field is handled by its modes instead of its values:
 *
 *   x(xi) = 2^-dim sum_m X_m prod_{b in m} xi_b,    X_m = sum_I Gamma_mI x_I,
 *
 * where bit b of m tells whether xi_b is a factor and Gamma_mI = +-1. Modes 1, 2, 4
 * are the linear ones, those with several bits the hourglass modes; the change
 * of basis is a butterfly of additions (a Walsh-Hadamard transform).
 */
namespace coracle
{
template <int dim>
constexpr int nodes_per_element = 1 << dim;

template <int dim>
constexpr int n_hourglass_modes = (dim == 2 ? 1 : 4);

/// Modes that vanish with every linear field.
template <int dim>
constexpr int
hourglass_mode(const int i)
{
  constexpr int modes[] = {3, 5, 6, 7};
  return modes[i];
}

template <int dim, typename T>
using NodalValues = std::array<T, nodes_per_element<dim>>;

/// One component of a nodal field, node by node; the lanes are elements.
template <int dim, typename T>
using NodalVectors = std::array<NodalValues<dim, T>, dim>;

/// Values to modes, in place.
template <int dim, typename T>
inline void
to_modes(NodalValues<dim, T> &x)
{
  for (int bit = 1; bit < nodes_per_element<dim>; bit *= 2)
    for (int i = 0; i < nodes_per_element<dim>; ++i)
      if ((i & bit) == 0)
        {
          const T low = x[i], high = x[i | bit];
          x[i]       = high + low;
          x[i | bit] = high - low;
        }
}

/// The transposed change of basis: f_I = sum_m Gamma_mI f_m, in place.
template <int dim, typename T>
inline void
from_modes(NodalValues<dim, T> &f)
{
  for (int bit = 1; bit < nodes_per_element<dim>; bit *= 2)
    for (int i = 0; i < nodes_per_element<dim>; ++i)
      if ((i & bit) == 0)
        {
          const T even = f[i], odd = f[i | bit];
          f[i]       = even - odd;
          f[i | bit] = even + odd;
        }
}

namespace internal
{
/// dV/dx_I of a hexahedron from its other two coordinates.
/// Flanagan & Belytschko, Int. J. Numer. Meth. Engng 17 (1981), Eq. 79, for any node by symmetry.
template <typename T>
inline void
volume_gradient(const NodalValues<3, T> &y, const NodalValues<3, T> &z, NodalValues<3, T> &b)
{
  for (int i = 0; i < 8; ++i)
    {
      const int    e1 = i ^ 1, e2 = i ^ 2, e3 = i ^ 4;
      const int    f12 = i ^ 3, f13 = i ^ 5, f23 = i ^ 6;
      const bool   odd  = ((i ^ (i >> 1) ^ (i >> 2)) & 1) != 0;
      const double sign = (odd ? -1. : 1.) / 12.;
      b[i] = sign * (y[e1] * ((z[f13] - z[f12]) - (z[e2] - z[e3])) + y[f12] * (z[e1] - z[e2]) +
                     y[e2] * ((z[f12] - z[f23]) - (z[e3] - z[e1])) +
                     y[e3] * ((z[f23] - z[f13]) - (z[e1] - z[e2])) + y[f13] * (z[e3] - z[e1]) +
                     y[f23] * (z[e2] - z[e3]));
    }
}
} // namespace internal

/**
 * B_iI = dV/dx_iI = integral of dN_I/dx_i over the element [m^(dim-1)], exact also for warped
 * hexahedra, and the volume V [m^dim] (area times 1 m in 2-D).
 *
 * Source: Flanagan & Belytschko (1981), Eqs. 12-17 and 79.
 */
template <int dim, typename T>
inline T
mean_gradient(const NodalVectors<dim, T> &x, NodalVectors<dim, T> &b)
{
  if constexpr (dim == 2)
    for (int i = 0; i < 2; ++i)
      {
        const T sign_1 = (i == 0 ? 0.5 : -0.5) * (x[1 - i][2] - x[1 - i][1]),
                sign_2 = (i == 0 ? 0.5 : -0.5) * (x[1 - i][3] - x[1 - i][0]);
        b[i]           = {{-sign_1, sign_2, -sign_2, sign_1}};
      }
  else
    for (int i = 0; i < 3; ++i)
      internal::volume_gradient(x[(i + 1) % 3], x[(i + 2) % 3], b[i]);

  T volume = x[0][0] * b[0][0];
  for (int n = 1; n < nodes_per_element<dim>; ++n)
    volume += x[0][n] * b[0][n];
  return volume;
}

/// sum_I a_jI b_iI, for example of displacement increments and mean_gradient: V du_j/dx_i.
template <int dim, typename T>
inline Matrix<dim, T>
contract_nodes(const NodalVectors<dim, T> &a, const NodalVectors<dim, T> &b)
{
  Matrix<dim, T> r;
  for (int j = 0; j < dim; ++j)
    for (int i = 0; i < dim; ++i)
      {
        r[j][i] = a[j][0] * b[i][0];
        for (int n = 1; n < nodes_per_element<dim>; ++n)
          r[j][i] += a[j][n] * b[i][n];
      }
  return r;
}

/// Sign of the factor prod_{b' in m without b} xi_b' at Gauss point q (bits as for nodes).
constexpr double
gauss_sign(const int m, const int b, const int q)
{
  const int rest = m & ~(1 << b) & ~q;
  return ((rest ^ (rest >> 1) ^ (rest >> 2)) & 1) != 0 ? -1. : 1.;
}

/// Modes times 2^-dim 3^(-(bits - 1) / 2), so that point_gradient needs additions only.
template <int dim, typename T>
inline void
scale_for_gauss_points(NodalValues<dim, T> &modes)
{
  constexpr double scale = 1. / nodes_per_element<dim>, g = 0.57735026918962576451;
  for (int m = 1; m < nodes_per_element<dim>; ++m)
    {
      const int bits = (m & 1) + ((m >> 1) & 1) + (m >> 2);
      modes[m] *= scale * (bits == 1 ? 1. : (bits == 2 ? g : g * g));
    }
}

/// dx_j/dxi_b at a point of the 2^dim Gauss rule (weights 1), from scaled modes.
template <int dim, typename T>
inline Matrix<dim, T>
point_gradient(const NodalVectors<dim, T> &scaled_modes, const int q)
{
  Matrix<dim, T> r{};
  for (int j = 0; j < dim; ++j)
    for (int b = 0; b < dim; ++b)
      for (int m = 1; m < nodes_per_element<dim>; ++m)
        if ((m >> b) & 1)
          r[j][b] += gauss_sign(m, b, q) * scaled_modes[j][m];
  return r;
}

/// The transposed of point_gradient: adds p_jb dN_m/dxi_b to the forces on the scaled modes.
template <int dim, typename T>
inline void
add_point_force(const Matrix<dim, T> &p, const int q, NodalVectors<dim, T> &modal_force)
{
  for (int j = 0; j < dim; ++j)
    for (int b = 0; b < dim; ++b)
      for (int m = 1; m < nodes_per_element<dim>; ++m)
        if ((m >> b) & 1)
          modal_force[j][m] += gauss_sign(m, b, q) * p[j][b];
}

/// Gradient with respect to the positions at the middle of the step, L dt [1], from that to those
/// at its end: the step's displacement is linear in time.
template <int dim, typename T>
inline Matrix<dim, T>
mid_step_increment(const Matrix<dim, T> &end_increment)
{
  Matrix<dim, T> half = identity<dim, T>();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      half[i][j] -= 0.5 * end_increment[i][j];
  const T        scale = 1. / determinant<dim, T>(half);
  Matrix<dim, T> r     = product<dim, T>(end_increment, adjugate<dim, T>(half));
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      r[i][j] *= scale;
  return r;
}
} // namespace coracle
