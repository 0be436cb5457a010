// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/structure/element_pack.h>

/**
 * Fully integrated elements, 2^dim Gauss points, with the volume change of all
 * points replaced by the element's mean.
 *
 * Rate form:     L-bar = L + (mean tr L - tr L) I / dim,
 * hyperelastic:  F-bar = (Jbar / J)^(1/dim) F,  Jbar = V / V0.
 *
 * The force is the one that does the stress's work under such motions: with s
 * the mean in-plane (2-D) or mean (3-D) normal stress,
 *
 *   f_I = sum_q w_q ((sigma - s I) . dN_I/dx + s B_I / V),   w_q = det, or det0 Jbar,
 *
 * so that hyperelastic forces are exactly the derivative of the energy.
 */
namespace coracle::internal
{
/// Cube root (3-D) or square root (2-D) of a ratio near 1: Halley's iteration, cubically
/// convergent.
template <int dim>
inline Pack8
root_of_ratio(const Pack8 &a)
{
  if constexpr (dim == 2)
    return sqrt(a);
  Pack8 y = splat<Pack8>(1.);
  for (int i = 0; i < 5; ++i)
    {
      const Pack8 cube = y * y * y;
      y *= (cube + 2. * a) / (2. * cube + a);
    }
  return y;
}

/// Geometry of all points of a pack.
template <int dim>
struct PointGeometry
{
  static constexpr int n = nodes_per_element<dim>;

  /// Adjugate of dx/dxi and its determinant.
  std::array<Matrix<dim, Pack8>, n> adjugate;
  std::array<Pack8, n>              det;
  /// L dt at the middle of the step.
  std::array<Matrix<dim, Pack8>, n> increment;
  /// Mean of tr L dt over the element.
  Pack8 mean_trace;
  /// Smallest determinant.
  Pack8 smallest;

  /// @param modes positions, @param d_modes increments, both scaled for Gauss points
  void compute(const NodalVectors<dim, Pack8> &modes, const NodalVectors<dim, Pack8> &d_modes)
  {
    Pack8 volume{};
    mean_trace = Pack8{};
    unrolled<n>([&](const auto q) {
      const Matrix<dim, Pack8> j = point_gradient<dim, Pack8>(modes, q);
      adjugate[q]                = coracle::adjugate<dim, Pack8>(j);
      det[q]                     = determinant<dim, Pack8>(j);
      const Matrix<dim, Pack8> end =
        product<dim, Pack8>(point_gradient<dim, Pack8>(d_modes, q), adjugate[q]);
      increment[q] = mid_step_increment<dim, Pack8>(scaled<dim>(end, Pack8(1. / det[q])));
      mean_trace += det[q] * trace<dim, Pack8>(increment[q]);
      volume += det[q];
      smallest = (q == 0 ? det[q] : min(smallest, det[q]));
    });
    mean_trace /= volume;
  }
};

/// F-bar at a point and the weight det0 Jbar / det of its stress's work.
template <int dim>
inline Pack8
mean_dilatation(const PointGeometry<dim>       &geometry,
                const NodalVectors<dim, Pack8> &modes,
                const NodalVectors<dim, Pack8> &reference_modes,
                const int                       q,
                const Pack8                    &mean_j,
                Matrix<dim, Pack8>             &f)
{
  const Matrix<dim, Pack8> j0    = point_gradient<dim, Pack8>(reference_modes, q);
  const Pack8              det_0 = determinant<dim, Pack8>(j0);
  f                 = scaled<dim>(product<dim, Pack8>(point_gradient<dim, Pack8>(modes, q),
                                      coracle::adjugate<dim, Pack8>(j0)),
                  Pack8(1. / det_0));
  const Pack8 ratio = mean_j * det_0 / geometry.det[q];
  f                 = scaled<dim>(f, root_of_ratio<dim>(ratio));
  return ratio;
}

template <int dim>
inline void
gather_scaled_modes(const Columns            &nodes,
                    const unsigned int        first,
                    const unsigned int       *connectivity,
                    NodalVectors<dim, Pack8> &modes)
{
  gather<dim>(nodes, first, connectivity, modes);
  for (auto &component : modes)
    {
      to_modes<dim>(component);
      scale_for_gauss_points<dim>(component);
    }
}

/// One step of one pack.
template <int dim, typename Material>
[[gnu::flatten]] inline NodalVectors<dim, Pack8>
full_step(const Material               &material,
          const Columns                &nodes,
          const double                  dt,
          const unsigned int            pack,
          typename Elements<dim>::Data &data,
          Limits                       &limits)
{
  constexpr int n                        = nodes_per_element<dim>;
  using Columns_                         = NodeColumns<dim>;
  using Data                             = typename Elements<dim>::Data;
  const unsigned int *const connectivity = &data.connectivity[pack * n * pack_size];

  NodalVectors<dim, Pack8> x, b, modes, d_modes, reference_modes;
  gather<dim>(nodes, Columns_::position, connectivity, x);
  const Pack8 volume = mean_gradient<dim, Pack8>(x, b);
  modes              = x;
  for (auto &component : modes)
    {
      to_modes<dim>(component);
      scale_for_gauss_points<dim>(component);
    }
  gather_scaled_modes<dim>(nodes, Columns_::increment, connectivity, d_modes);
  if constexpr (Material::needs_deformation_gradient)
    gather_scaled_modes<dim>(nodes, Columns_::reference, connectivity, reference_modes);
  PointGeometry<dim> geometry;
  geometry.compute(modes, d_modes);

  // The most compressed point stands for the whole element.
  const Pack8        inverse_l = inverse_length<dim>(b, Pack8(n * geometry.smallest));
  Motion<dim, Pack8> motion{};
  motion.density     = load<Pack8>(data.columns[Data::mass] + pack * pack_size) / volume;
  motion.length      = element_size<dim>(inverse_l);
  motion.dt          = dt;
  const Pack8 mean_j = volume / load<Pack8>(data.columns[Data::volume] + pack * pack_size);

  NodalVectors<dim, Pack8> force{};
  Pack8                    mean_stress{}, checked{};
  unrolled<n>([&](const auto q) {
    motion.velocity_gradient = geometry.increment[q];
    const Pack8 correction =
      (geometry.mean_trace - trace<dim, Pack8>(geometry.increment[q])) * (1. / dim);
    for (int i = 0; i < dim; ++i)
      motion.velocity_gradient[i][i] += correction;
    motion.velocity_gradient = scaled<dim>(motion.velocity_gradient, splat<Pack8>(1. / dt));
    Pack8 weight             = splat<Pack8>(1.);
    if constexpr (Material::needs_deformation_gradient)
      weight = mean_dilatation<dim>(
        geometry, modes, reference_modes, q, mean_j, motion.deformation_gradient);

    PointState<dim, Material> point;
    point.load(data.columns, data.stress(q), pack);
    material.template update<dim, Pack8>(motion, point.stress, point.history.data());
    point.store(data.columns, data.stress(q), pack);

    Pack8 s = point.stress[0];
    for (int i = 1; i < dim; ++i)
      s += point.stress[i];
    s *= 1. / dim;
    checked += point.stress.trace();
    mean_stress += weight * geometry.det[q] * s;
    for (int i = 0; i < dim; ++i)
      point.stress[i] -= s;
    for (int c = 0; c < point.stress.size; ++c)
      point.stress[c] *= weight;
    add_point_force<dim, Pack8>(product_transposed<dim>(point.stress, geometry.adjugate[q]),
                                q,
                                force);
  });
  limit_step<dim>(material, motion.density, inverse_l, limits);
  limits.is_good &= (geometry.smallest > 0.) & (abs(checked) < 1e300);

  mean_stress /= volume;
  for (int j = 0; j < dim; ++j)
    {
      scale_for_gauss_points<dim>(force[j]);
      from_modes<dim>(force[j]);
      for (int i = 0; i < n; ++i)
        force[j][i] += mean_stress * b[j][i];
    }
  return force;
}
} // namespace coracle::internal
