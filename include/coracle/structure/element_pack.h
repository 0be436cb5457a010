// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/structure/element_geometry.h>
#include <coracle/structure/elements.h>

#include <limits>
#include <utility>

/**
 * What both element kernels share: moving data between columns and packs, and
 * the stable step.
 */
namespace coracle::internal
{
/// Call f(0), f(1), ... with compile-time numbers, so that signs and indices fold away.
template <typename F, int... i>
inline void
unrolled(const F &f, std::integer_sequence<int, i...>)
{
  (f(std::integral_constant<int, i>()), ...);
}

template <int n, typename F>
inline void
unrolled(const F &f)
{
  unrolled(f, std::make_integer_sequence<int, n>());
}

/// dim components at the nodes of a pack, from `nodes` ordered [node][lane].
template <int dim>
inline void
gather(const Columns            &columns,
       const unsigned int        first,
       const unsigned int       *nodes,
       NodalVectors<dim, Pack8> &result)
{
  for (int d = 0; d < dim; ++d)
    {
      const double *const c = columns[first + d];
      for (int n = 0; n < nodes_per_element<dim>; ++n)
        {
          // Built in registers; storing lanes to memory and loading them as a pack would stall.
          const unsigned int *const i = nodes + n * pack_size;
          result[d][n] =
            Pack8{c[i[0]], c[i[1]], c[i[2]], c[i[3]], c[i[4]], c[i[5]], c[i[6]], c[i[7]]};
        }
    }
}

/// Subtract a pack's forces from the columns; lanes share nodes, so one lane after the other.
template <int dim>
inline void
scatter_minus(const NodalVectors<dim, Pack8> &force,
              const unsigned int              n_lanes,
              const unsigned int             *nodes,
              const unsigned int              first,
              Columns                        &columns)
{
  for (int d = 0; d < dim; ++d)
    {
      double *const column = columns[first + d];
      for (int n = 0; n < nodes_per_element<dim>; ++n)
        for (unsigned int l = 0; l < n_lanes; ++l)
          column[nodes[n * pack_size + l]] -= force[d][n][l];
    }
}

/// Stress and history of one point of a pack.
template <int dim, typename Material>
struct PointState
{
  Symmetric<dim, Pack8>                                                  stress;
  std::array<Pack8, (Material::n_history > 0 ? Material::n_history : 1)> history;

  void load(const Columns &columns, const unsigned int first, const unsigned int pack)
  {
    for (int c = 0; c < stress.size; ++c)
      stress[c] = coracle::load<Pack8>(columns[first + c] + pack * pack_size);
    for (int h = 0; h < Material::n_history; ++h)
      history[h] = coracle::load<Pack8>(columns[first + stress.size + h] + pack * pack_size);
  }

  void store(Columns &columns, const unsigned int first, const unsigned int pack) const
  {
    for (int c = 0; c < stress.size; ++c)
      coracle::store(columns[first + c] + pack * pack_size, stress[c]);
    for (int h = 0; h < Material::n_history; ++h)
      coracle::store(columns[first + stress.size + h] + pack * pack_size, history[h]);
  }
};

/// Worst of the elements so far, lane by lane.
struct Limits
{
  /// 1 / stable step [1/s].
  Pack8 rate{};
  /// Whether all elements are the right way out and their stresses numbers.
  Mask8 is_good = ~Mask8{};
};

/**
 * sqrt(2^dim sum B^2) / (2 V) [1/m]: with the sound speed, half the highest frequency that an
 * element of that mean gradient and volume with lumped mass can have (the trace bounds the
 * eigenvalue, as in Flanagan & Belytschko (1981), section 5, for any Poisson ratio).
 */
template <int dim>
inline Pack8
inverse_length(const NodalVectors<dim, Pack8> &b, const Pack8 &volume)
{
  Pack8 squares{};
  for (int d = 0; d < dim; ++d)
    for (int n = 0; n < nodes_per_element<dim>; ++n)
      squares += b[d][n] * b[d][n];
  return sqrt(Pack8((0.25 * nodes_per_element<dim>)*squares)) / volume;
}

/// Raise the limits by c / L, and for momentum that diffuses by 2 dim diffusivity / h^2.
template <int dim, typename Material>
inline void
limit_step(const Material &material,
           const Pack8    &density,
           const Pack8    &inverse_length,
           Limits         &limits)
{
  Pack8 rate = material.sound_speed(density) * inverse_length;
  if (material.diffusivity() > 0)
    rate += (2. * material.diffusivity()) * inverse_length * inverse_length;
  limits.rate = max(limits.rate, rate);
}

/// Size of an element for bulk viscosity: the side of a cube or square [m].
template <int dim>
inline Pack8
element_size(const Pack8 &inverse_length)
{
  constexpr double root = (dim == 2 ? 1.41421356237309504880 : 1.73205080756887729353);
  return root / inverse_length;
}

/// a scaled by a factor, entry by entry.
template <int dim>
inline Matrix<dim, Pack8>
scaled(const Matrix<dim, Pack8> &a, const Pack8 &factor)
{
  Matrix<dim, Pack8> r;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      r[i][j] = a[i][j] * factor;
  return r;
}

/// s b^T with a symmetric s: r_jb = sum_i s_ji b_bi.
template <int dim>
inline Matrix<dim, Pack8>
product_transposed(const Symmetric<dim, Pack8> &s, const Matrix<dim, Pack8> &b)
{
  Matrix<dim, Pack8> r;
  for (int j = 0; j < dim; ++j)
    for (int k = 0; k < dim; ++k)
      {
        r[j][k] = s(j, 0) * b[k][0];
        for (int i = 1; i < dim; ++i)
          r[j][k] += s(j, i) * b[k][i];
      }
  return r;
}
} // namespace coracle::internal
