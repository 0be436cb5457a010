// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>

namespace coracle
{
/// Corners of a facet oriented as mesh/structure_mesh.h says [m].
template <int dim>
using FacetCorners = std::array<dealii::Point<dim>, (dim == 2 ? 2 : 4)>;

/// Outward area vectors of the nodes, integral of N_I n dA [m^(dim-1)]; exact for warped facets.
template <int dim>
inline std::array<dealii::Tensor<1, dim>, (dim == 2 ? 2 : 4)>
nodal_areas(const FacetCorners<dim> &x)
{
  std::array<dealii::Tensor<1, dim>, (dim == 2 ? 2 : 4)> areas;
  if constexpr (dim == 2)
    for (auto &area : areas)
      {
        area[0] = 0.5 * (x[1][1] - x[0][1]);
        area[1] = -0.5 * (x[1][0] - x[0][0]);
      }
  else
    {
      constexpr double g    = 0.57735026918962576451;
      constexpr double xi[] = {-1, 1, 1, -1}, eta[] = {-1, -1, 1, 1};
      for (int q = 0; q < 4; ++q)
        {
          dealii::Tensor<1, 3> t_xi, t_eta;
          for (int n = 0; n < 4; ++n)
            {
              t_xi += 0.25 * xi[n] * (1 + eta[n] * g * eta[q]) * x[n];
              t_eta += 0.25 * eta[n] * (1 + xi[n] * g * xi[q]) * x[n];
            }
          const dealii::Tensor<1, 3> normal = dealii::cross_product_3d(t_xi, t_eta);
          for (int n = 0; n < 4; ++n)
            areas[n] += 0.25 * (1 + xi[n] * g * xi[q]) * (1 + eta[n] * g * eta[q]) * normal;
        }
    }
  return areas;
}
} // namespace coracle
