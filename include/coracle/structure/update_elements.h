// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/structure/full_kernel.h>
#include <coracle/structure/one_point_kernel.h>

namespace coracle::internal
{
/// A material whose stress stays as it is: for forces of a stress that is known.
template <typename Material>
struct HeldStress
{
  static constexpr bool needs_deformation_gradient = Material::needs_deformation_gradient;
  static constexpr int  n_history                  = Material::n_history;
  const Material       &material;

  double diffusivity() const { return material.diffusivity(); }
  template <typename T>
  T sound_speed(const T &density) const
  {
    return material.sound_speed(density);
  }
  template <int dim, typename T>
  void update(const Motion<dim, T> &, Symmetric<dim, T> &, T *) const
  {}
};

/// All packs of a body with one material; the loops of the structure are here.
template <int dim, typename Material>
void
update_elements(const Material               &material,
                const bool                    full_integration,
                Columns                      &nodes,
                const double                  dt,
                typename Elements<dim>::Data &data,
                Limits                       &limits)
{
  constexpr unsigned int stride = nodes_per_element<dim> * pack_size;
  const auto             loop   = [&](const auto &step) {
    for (unsigned int pack = 0; pack < data.n_packs; ++pack)
      {
        const NodalVectors<dim, Pack8> force = step(pack);
        const unsigned int             n_lanes =
          std::min<unsigned int>(pack_size, data.n_elements - pack * pack_size);
        if (data.apart)
          for (int d = 0; d < dim; ++d)
            for (int n = 0; n < nodes_per_element<dim>; ++n)
              store(&data.forces[(pack * dim + d) * stride + n * pack_size], force[d][n]);
        else
          scatter_minus<dim>(
            force, n_lanes, &data.connectivity[pack * stride], NodeColumns<dim>::internal, nodes);
      }
  };
  if (full_integration)
    loop([&](const unsigned int pack) {
      return full_step<dim>(material, nodes, dt, pack, data, limits);
    });
  else
    loop([&](const unsigned int pack) {
      return one_point_step<dim>(material, nodes, dt, pack, data, limits);
    });
}
} // namespace coracle::internal
