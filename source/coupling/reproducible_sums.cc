// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Largest of what makes bounds: particles in a leaf, and of them and of nodes component by
/// component. The bounds themselves are products of maxima over all ranks: those of one rank's
/// maxima would depend on who has what.
struct Maxima
{
  double in_leaf = 0, mass = 0, velocity = 0, volume_per_size = 0, stress = 0, body_force = 0,
         velocity_on_nodes = 0;
};

/// Affine velocities act over an arm of two cells.
template <int dim>
constexpr double arm = 2. * dim;

template <int dim>
void
take(const Octree<dim> &octree, const MaterialPointBody<dim> &body, Maxima &maxima)
{
  using Layout       = ParticleLayout<dim>;
  const auto &points = body.points;
  const auto &layout = points.layout();
  for (const unsigned int leaf : points.occupied_cells())
    {
      const unsigned int begin = points.cell_begin()[leaf], end = points.cell_begin()[leaf + 1];
      maxima.in_leaf = std::max<double>(maxima.in_leaf, end - begin);
      for (unsigned int row = begin; row < end; ++row)
        {
          const double m = points.column(Layout::mass)[row];
          double       v = largest_of(points, row, Layout::velocity, dim);
          if (layout.affine >= 0)
            v += arm<dim> * octree.size(leaf) * largest_of(points, row, layout.affine, dim * dim);
          // Pieces of it may be in cells half as large.
          const double size = 0.5 * octree.size(leaf);
          maxima.mass       = std::max(maxima.mass, m);
          maxima.velocity   = std::max(maxima.velocity, v);
          maxima.volume_per_size =
            std::max(maxima.volume_per_size, m / points.column(Layout::density)[row] / size);
          maxima.stress =
            std::max(maxima.stress, largest_of(points, row, Layout::stress, layout.n_stress));
          for (int d = 0; d < dim && body.body_force; ++d)
            maxima.body_force =
              std::max(maxima.body_force,
                       m * std::abs(body.body_force->value(points.position(row), d)));
        }
    }
}

/// Of the sum that the particles of one leaf can give to a node, component by component.
template <int dim>
typename NodalField<dim>::Bounds
bounds_of(const Maxima &of_all_ranks)
{
  const Maxima &m = of_all_ranks;
  // Old velocity, its change, and the node's own with gradients of 2^dim velocities over a cell.
  const double velocity = m.velocity + (3. + 2. * (1 << dim) * arm<dim>)*m.velocity_on_nodes;
  // Three components, each with the change that makes a mean pressure of it.
  const double force = 6. * m.volume_per_size * m.stress + m.body_force;
  return {m.in_leaf * m.mass, m.in_leaf * m.mass * velocity, m.in_leaf * force, 1};
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
MaterialPointSystem<dim>::bound_sums(const double time, const bool after_nodes_moved)
{
  if (!reproducible)
    return;
  // Leaves around a node and around those that hang on it, and pieces from beyond.
  constexpr double leaves_of_a_node = 1 << (2 * dim + 2);
  unsigned int     place            = 0;
  for (auto &f : fields)
    {
      Maxima maxima;
      int    n_bodies = 0;
      for (auto &body : bodies)
        if (body.field == place)
          {
            if (body.body_force)
              body.body_force->set_time(time);
            take(octree, body, maxima);
            ++n_bodies;
          }
      if (after_nodes_moved)
        maxima.velocity_on_nodes = f.largest_velocity();
      MPI_Allreduce(MPI_IN_PLACE,
                    &maxima,
                    sizeof(Maxima) / sizeof(double),
                    MPI_DOUBLE,
                    MPI_MAX,
                    octree.triangulation.get_communicator());
      auto bounds   = bounds_of<dim>(maxima);
      bounds.number = leaves_of_a_node * std::max(1, n_bodies);
      f.bound(bounds);
      ++place;
    }
}

template void   MaterialPointSystem<2>::make_reproducible();
template void   MaterialPointSystem<3>::make_reproducible();
template double MaterialPointSystem<2>::on_first_rank(const ExactSum &) const;
template double MaterialPointSystem<3>::on_first_rank(const ExactSum &) const;
template void   MaterialPointSystem<2>::bound_sums(const double, const bool);
template void   MaterialPointSystem<3>::bound_sums(const double, const bool);
} // namespace coracle
