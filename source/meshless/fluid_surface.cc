// SPDX-License-Identifier: GPL-3.0-or-later
// The fluid's free surface: areas, and what they add to the pressure's system.
#include <coracle/meshless/fluid.h>

namespace coracle::meshless
{
// On the halfway elements.
template <int dim>
typename Fluid<dim>::Vector
Fluid<dim>::facet_area(const typename Tessellation<dim>::Facet &facet) const
{
  std::array<Vector, dim> x;
  for (unsigned int i = 0; i < dim; ++i)
    x[i] = points.position[facet[i]] + scratch[facet[i]];
  if constexpr (dim == 2)
    return cross_product_2d(x[1] - x[0]);
  else
    return 0.5 * cross_product_3d(x[1] - x[0], x[2] - x[0]);
}

// a_i, a share of each facet beside it: the derivative of the volume by the point's place.
template <int dim>
void
Fluid<dim>::find_surface_areas()
{
  surface_area.assign(points.size(), Vector());
  for (const auto &facet : surface_facets)
    {
      const Vector area = facet_area(facet);
      for (const unsigned int node : facet)
        surface_area[node] += area / dim;
    }
  halo.sum_to_owners(surface_area);
  fitting_flow = 0;
  if (dim == 3)
    fit_surface_areas();
  find_wall_areas();
  halo.update(surface_area);
}

/**
 * In space a face of more than three nodes is no sum of triangles, and with the triangles' areas
 * the pressure would push a block of fluid that moves as a whole. So areas are those that the
 * elements' functions have there; what flows through the triangles besides keeps the volume, as
 * part of the swelling. Walls have their part along their own normals only.
 */
template <int dim>
void
Fluid<dim>::fit_surface_areas()
{
  std::vector<Vector> whole(points.size());
  moved_rules.for_each_of(surface_elements,
                          mesh,
                          [&](const unsigned int *nodes,
                              const unsigned int  n,
                              const double        weight,
                              const double *,
                              const Vector *grad) {
                            for (unsigned int i = 0; i < n; ++i)
                              whole[nodes[i]] += weight * grad[i];
                          });
  halo.sum_to_owners(whole);
  for (std::size_t i = 0; i < n_cloud; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      if (free_surface[i] && !is_sliding(i) && !(walls[i] >> (2 * d) & 3))
        {
          fitting_flow += (surface_area[i][d] - whole[i][d]) * moving[i][d];
          surface_area[i][d] = whole[i][d];
        }
}

/**
 * At the free surface, the pressure is such that the elements there keep their volume too, and
 * acts on the surface: with E u = (a_i . u_i), B becomes B - E in both equations, and
 * S - E M^-1 B^T - B M^-1 E^T + E M^-1 E^T takes the place of S. The last term is in the matrix.
 */
template <int dim>
void
Fluid<dim>::add_surface_terms(double *result, const double *p)
{
  surface_pressure.assign(p, p + points.n_own);
  halo.update(surface_pressure);
  gradient.assign(points.size(), Vector());
  moved_rules.for_each_of(surface_elements,
                          mesh,
                          [&](const unsigned int *nodes,
                              const unsigned int  n,
                              const double        weight,
                              const double       *value,
                              const Vector       *grad) {
                            Vector slope;
                            for (unsigned int i = 0; i < n; ++i)
                              slope += surface_pressure[nodes[i]] * grad[i];
                            for (unsigned int i = 0; i < n; ++i)
                              gradient[nodes[i]] += (weight * value[i]) * slope;
                          });
  halo.sum_to_owners(gradient);
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      pushed[i] = Vector();
      if (no_pressure[i] || !free_surface[i])
        continue;
      result[i] -= surface_area[i] * gradient[i] / moved_mass[i];
      pushed[i] = surface_pressure[i] / moved_mass[i] * surface_area[i];
    }
  halo.update(pushed);
  driven.assign(points.size(), 0.);
  moved_rules.for_each_of(surface_elements,
                          mesh,
                          [&](const unsigned int *nodes,
                              const unsigned int  n,
                              const double        weight,
                              const double       *value,
                              const Vector       *grad) {
                            Vector flow;
                            for (unsigned int i = 0; i < n; ++i)
                              flow += value[i] * pushed[nodes[i]];
                            for (unsigned int i = 0; i < n; ++i)
                              driven[nodes[i]] += weight * (grad[i] * flow);
                          });
  halo.sum_to_owners(driven);
  for (std::size_t i = 0; i < points.n_own; ++i)
    if (!no_pressure[i])
      result[i] -= driven[i];
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
