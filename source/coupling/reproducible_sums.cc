// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/material_point_system.h>

#include <algorithm>
#include <cmath>

namespace coracle
{
namespace
{
/// Largest of the absolute values of columns in one row.
template <int dim>
double
largest_of(const MaterialPoints<dim> &points,
           const std::size_t          row,
           const int                  first,
           const int                  n_columns)
{
  double result = 0;
  for (int k = first; k < first + n_columns; ++k)
    result = std::max(result, std::abs(points.column(k)[row]));
  return result;
}

/// Of the sum that the particles of one leaf can give to a node, component by component.
template <int dim>
typename NodalField<dim>::Bounds
bounds_of(const Octree<dim>            &octree,
          const MaterialPointBody<dim> &body,
          const double                  velocity_on_nodes)
{
  using Layout       = ParticleLayout<dim>;
  const auto &points = body.points;
  const auto &layout = points.layout();
  // Affine velocities: all components, over an arm of two cells; what nodes give is at most
  // 2^dim velocities over a cell.
  constexpr double arm  = 2. * dim;
  const double on_nodes = velocity_on_nodes * (layout.affine < 0 ? 3. : 3. + 2. * (1 << dim) * arm);
  double       most = 0, mass = 0, velocity = 0, volume_per_size = 0, stress = 0, body_force = 0;
  for (const unsigned int leaf : points.occupied_cells())
    {
      const unsigned int begin = points.cell_begin()[leaf], end = points.cell_begin()[leaf + 1];
      most = std::max<double>(most, end - begin);
      for (unsigned int row = begin; row < end; ++row)
        {
          const double m = points.column(Layout::mass)[row];
          double       v = largest_of(points, row, Layout::velocity, dim);
          if (layout.affine >= 0)
            v += arm * octree.size(leaf) * largest_of(points, row, layout.affine, dim * dim);
          mass     = std::max(mass, m);
          velocity = std::max(velocity, v);
          // Pieces of it may be in cells half as large.
          volume_per_size =
            std::max(volume_per_size,
                     2 * m / points.column(Layout::density)[row] / octree.size(leaf));
          stress = std::max(stress, largest_of(points, row, Layout::stress, layout.n_stress));
          if (body.body_force)
            for (int d = 0; d < dim; ++d)
              body_force =
                std::max(body_force, m * std::abs(body.body_force->value(points.position(row), d)));
        }
    }
  // Three components, each with the change that makes a mean pressure of it.
  const double force = volume_per_size * 6. * stress + body_force;
  return {most * mass, most * mass * (velocity + on_nodes), most * force, 1};
}
} // namespace

template <int dim>
void
MaterialPointSystem<dim>::make_reproducible()
{
  reproducible = true;
  for (auto &f : fields)
    f.make_reproducible();
  energy.kinetic = 0;
  for (auto &body : bodies)
    {
      body.points.reproducible = true;
      energy.kinetic += kinetic_energy(body);
    }
  sort();
}

template <int dim>
double
MaterialPointSystem<dim>::on_first_rank(const ExactSum &sum) const
{
  RankSums sums(1, true);
  sums.add(0, sum);
  return sums.share(octree.triangulation.get_communicator())[0];
}

template <int dim>
void
MaterialPointSystem<dim>::bound_sums(const double time)
{
  if (!reproducible)
    return;
  // Leaves around a node and around those that hang on it, and pieces from beyond.
  constexpr double leaves_of_a_node = 1 << (2 * dim + 2);
  int              place            = 0;
  for (auto &f : fields)
    {
      const double velocity =
        mpi::max(f.largest_velocity(), octree.triangulation.get_communicator());
      typename NodalField<dim>::Bounds bounds;
      int                              n_bodies = 0;
      for (auto &body : bodies)
        if (int(body.field) == place)
          {
            if (body.body_force)
              body.body_force->set_time(time);
            const auto own  = bounds_of(octree, body, velocity);
            bounds.mass     = std::max(bounds.mass, own.mass);
            bounds.momentum = std::max(bounds.momentum, own.momentum);
            bounds.force    = std::max(bounds.force, own.force);
            ++n_bodies;
          }
      bounds.number = leaves_of_a_node * std::max(1, n_bodies);
      f.bound(bounds);
      ++place;
    }
}

template void   MaterialPointSystem<2>::make_reproducible();
template void   MaterialPointSystem<3>::make_reproducible();
template double MaterialPointSystem<2>::on_first_rank(const ExactSum &) const;
template double MaterialPointSystem<3>::on_first_rank(const ExactSum &) const;
template void   MaterialPointSystem<2>::bound_sums(const double);
template void   MaterialPointSystem<3>::bound_sums(const double);
} // namespace coracle
