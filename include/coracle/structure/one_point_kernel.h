// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/material/rotation.h>
#include <coracle/structure/element_pack.h>

/**
 * One-point elements: the mean gradient of the element carries the stress, and
 * the modes it does not see are held by springs (Flanagan & Belytschko 1981).
 *
 * A mode m has the amplitude q_j = Gamma_m . u_j - sum_i du_j/dx_i Gamma_m . x_i,
 * which no linear field excites, and the spring force Q_j = k q_j. With f = B A + Gamma^T Q,
 * A = sigma - sum_m Q (Gamma_m . x)^T / V, neither q nor the force needs the nodal
 * vectors gamma_m of that paper.
 *
 * k = kappa mu sum B^2 / (V n), n = 12 (2-D), 31 (3-D), mu the shear modulus: for a square or
 * cube kappa = 1 is the stiffness that full integration with F-bar has, and bends a square as a
 * beam of Poisson ratio 0 bends.
 */
namespace coracle::internal
{
template <int dim>
using HourglassForces = std::array<std::array<Pack8, n_hourglass_modes<dim>>, dim>;

template <int dim>
inline Pack8
hourglass_stiffness(const double modulus, const NodalVectors<dim, Pack8> &b, const Pack8 &volume)
{
  const Pack8 l = inverse_length<dim>(b, volume);
  // sum B^2 / V = 4 / 2^dim V / L^2
  return (modulus * 4. / nodes_per_element<dim> / (dim == 2 ? 12. : 31.)) * volume * l * l;
}

/// q_jm of a field with modes u and gradient g, in an element with modes x.
template <int dim>
inline HourglassForces<dim>
hourglass_amplitudes(const NodalVectors<dim, Pack8> &u,
                     const Matrix<dim, Pack8>       &g,
                     const NodalVectors<dim, Pack8> &x)
{
  HourglassForces<dim> q;
  for (int m = 0; m < n_hourglass_modes<dim>; ++m)
    for (int j = 0; j < dim; ++j)
      {
        q[j][m] = u[j][hourglass_mode<dim>(m)];
        for (int i = 0; i < dim; ++i)
          q[j][m] -= g[j][i] * x[i][hourglass_mode<dim>(m)];
      }
  return q;
}

/// Nodal forces of the stress a (per volume, any matrix) and of the hourglass springs.
template <int dim>
inline NodalVectors<dim, Pack8>
one_point_force(Matrix<dim, Pack8>              a,
                const HourglassForces<dim>     &spring,
                const NodalVectors<dim, Pack8> &x_modes,
                const NodalVectors<dim, Pack8> &b,
                const Pack8                    &inverse_volume)
{
  NodalVectors<dim, Pack8> force;
  for (int j = 0; j < dim; ++j)
    {
      force[j] = {};
      for (int m = 0; m < n_hourglass_modes<dim>; ++m)
        {
          const int mode = hourglass_mode<dim>(m);
          force[j][mode] = spring[j][m];
          for (int i = 0; i < dim; ++i)
            a[j][i] -= spring[j][m] * x_modes[i][mode] * inverse_volume;
        }
      from_modes<dim>(force[j]);
      for (int n = 0; n < nodes_per_element<dim>; ++n)
        for (int i = 0; i < dim; ++i)
          force[j][n] += a[j][i] * b[i][n];
    }
  return force;
}

template <int dim>
inline NodalVectors<dim, Pack8>
modes_of(NodalVectors<dim, Pack8> x)
{
  for (auto &component : x)
    to_modes<dim>(component);
  return x;
}

/// Springs of a rate material: turned with the material, lengthened by the step.
template <int dim>
inline void
stretch_springs(const Matrix<dim, Pack8>   &increment,
                const HourglassForces<dim> &q,
                const Pack8                &stiffness,
                const unsigned int          pack,
                Columns                    &columns,
                HourglassForces<dim>       &spring)
{
  using Data                       = typename Elements<dim>::Data;
  constexpr int            n_modes = n_hourglass_modes<dim>;
  const Matrix<dim, Pack8> turn    = incremental_rotation<dim, Pack8>(increment, 1.);
  const unsigned int       row     = pack * pack_size;
  Pack8                    energy  = load<Pack8>(columns[Data::energy] + row);
  for (int m = 0; m < n_modes; ++m)
    {
      std::array<Pack8, dim> old;
      for (int j = 0; j < dim; ++j)
        old[j] = load<Pack8>(columns[Data::hourglass + j * n_modes + m] + row);
      for (int j = 0; j < dim; ++j)
        {
          Pack8 turned = turn[j][0] * old[0];
          for (int i = 1; i < dim; ++i)
            turned += turn[j][i] * old[i];
          spring[j][m] = turned + stiffness * q[j][m];
          energy += 0.5 * (turned + spring[j][m]) * q[j][m];
          store(columns[Data::hourglass + j * n_modes + m] + row, spring[j][m]);
        }
    }
  store(columns[Data::energy] + row, energy);
}

/// One step of one pack, for materials in rate form: all in the current configuration.
template <int dim, typename Material>
[[gnu::flatten]] inline NodalVectors<dim, Pack8>
one_point_rate(const Material               &material,
               const Columns                &nodes,
               const double                  dt,
               const unsigned int            pack,
               typename Elements<dim>::Data &data,
               Limits                       &limits)
{
  using Columns_ = NodeColumns<dim>;
  using Data     = typename Elements<dim>::Data;
  const unsigned int *const connectivity =
    &data.connectivity[pack * nodes_per_element<dim> * pack_size];
  NodalVectors<dim, Pack8> x, dx, b;
  gather<dim>(nodes, Columns_::position, connectivity, x);
  gather<dim>(nodes, Columns_::increment, connectivity, dx);
  const Pack8 volume = mean_gradient<dim, Pack8>(x, b), inverse_volume = 1. / volume;

  const Matrix<dim, Pack8> end = scaled<dim>(contract_nodes<dim, Pack8>(dx, b), inverse_volume);
  const Matrix<dim, Pack8> increment = mid_step_increment<dim, Pack8>(end);
  const Pack8              inverse_l = inverse_length<dim>(b, volume);

  Motion<dim, Pack8> motion{};
  motion.velocity_gradient = scaled<dim>(increment, splat<Pack8>(1. / dt));
  motion.density = load<Pack8>(data.columns[Data::mass] + pack * pack_size) * inverse_volume;
  motion.length  = element_size<dim>(inverse_l);
  motion.dt      = dt;
  PointState<dim, Material> point;
  point.load(data.columns, data.stress(0), pack);
  material.template update<dim, Pack8>(motion, point.stress, point.history.data());
  point.store(data.columns, data.stress(0), pack);
  limit_step<dim>(material, motion.density, inverse_l, limits);
  limits.is_good &= (volume > 0.) & (abs(point.stress.trace()) < 1e300);

  const NodalVectors<dim, Pack8> x_modes = modes_of<dim>(x), dx_modes = modes_of<dim>(dx);
  NodalVectors<dim, Pack8>       mid_modes = x_modes;
  for (int j = 0; j < dim; ++j)
    for (int m = 0; m < nodes_per_element<dim>; ++m)
      mid_modes[j][m] -= 0.5 * dx_modes[j][m];
  HourglassForces<dim> spring;
  stretch_springs<dim>(increment,
                       hourglass_amplitudes<dim>(dx_modes, increment, mid_modes),
                       hourglass_stiffness<dim>(data.hourglass_modulus, b, volume),
                       pack,
                       data.columns,
                       spring);

  Matrix<dim, Pack8> stress;
  for (int j = 0; j < dim; ++j)
    for (int i = 0; i < dim; ++i)
      stress[j][i] = point.stress(j, i);
  return one_point_force<dim>(stress, spring, x_modes, b, inverse_volume);
}

/**
 * One step of one pack, for hyperelastic materials: all in the reference
 * configuration, so that forces are exactly the derivative of the energy
 * V0 Psi(mean F) + sum k/2 q^2.
 */
template <int dim, typename Material>
[[gnu::flatten]] inline NodalVectors<dim, Pack8>
one_point_hyperelastic(const Material               &material,
                       const Columns                &nodes,
                       const double                  dt,
                       const unsigned int            pack,
                       typename Elements<dim>::Data &data,
                       Limits                       &limits)
{
  using Columns_ = NodeColumns<dim>;
  using Data     = typename Elements<dim>::Data;
  const unsigned int *const connectivity =
    &data.connectivity[pack * nodes_per_element<dim> * pack_size];
  NodalVectors<dim, Pack8> x0, x, dx, b0, b;
  gather<dim>(nodes, Columns_::reference, connectivity, x0);
  gather<dim>(nodes, Columns_::position, connectivity, x);
  gather<dim>(nodes, Columns_::increment, connectivity, dx);
  const Pack8 volume_0 = mean_gradient<dim, Pack8>(x0, b0), inverse_volume_0 = 1. / volume_0,
              volume = mean_gradient<dim, Pack8>(x, b), inverse_l = inverse_length<dim>(b, volume);

  Motion<dim, Pack8>       motion{};
  const Matrix<dim, Pack8> f = scaled<dim>(contract_nodes<dim, Pack8>(x, b0), inverse_volume_0);
  const Matrix<dim, Pack8> cofactor = adjugate<dim, Pack8>(f);
  const Pack8              j        = determinant<dim, Pack8>(f);
  const Matrix<dim, Pack8> end =
    product<dim, Pack8>(scaled<dim>(contract_nodes<dim, Pack8>(dx, b0), inverse_volume_0 / j),
                        cofactor);
  motion.velocity_gradient =
    scaled<dim>(mid_step_increment<dim, Pack8>(end), splat<Pack8>(1. / dt));
  motion.deformation_gradient = f;
  motion.density = load<Pack8>(data.columns[Data::mass] + pack * pack_size) * inverse_volume_0 / j;
  motion.length  = element_size<dim>(inverse_l);
  motion.dt      = dt;
  PointState<dim, Material> point;
  point.load(data.columns, data.stress(0), pack);
  material.template update<dim, Pack8>(motion, point.stress, point.history.data());
  point.store(data.columns, data.stress(0), pack);
  limit_step<dim>(material, motion.density, inverse_l, limits);
  limits.is_good &= (volume > 0.) & (j > 0.) & (abs(point.stress.trace()) < 1e300);

  const NodalVectors<dim, Pack8> x0_modes = modes_of<dim>(x0);
  const Pack8          stiffness = hourglass_stiffness<dim>(data.hourglass_modulus, b0, volume_0);
  HourglassForces<dim> spring    = hourglass_amplitudes<dim>(modes_of<dim>(x), f, x0_modes);
  Pack8                energy{};
  for (auto &component : spring)
    for (Pack8 &q : component)
      {
        energy += 0.5 * stiffness * q * q;
        q *= stiffness;
      }
  store(data.columns[Data::energy] + pack * pack_size, energy);
  // First Piola-Kirchhoff stress J sigma F^-T.
  return one_point_force<dim>(
    product_transposed<dim>(point.stress, cofactor), spring, x0_modes, b0, inverse_volume_0);
}

template <int dim, typename Material>
inline NodalVectors<dim, Pack8>
one_point_step(const Material               &material,
               const Columns                &nodes,
               const double                  dt,
               const unsigned int            pack,
               typename Elements<dim>::Data &data,
               Limits                       &limits)
{
  if constexpr (Material::needs_deformation_gradient)
    return one_point_hyperelastic<dim>(material, nodes, dt, pack, data, limits);
  else
    return one_point_rate<dim>(material, nodes, dt, pack, data, limits);
}
} // namespace coracle::internal
