// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/corner_shape.h>
#include <coracle/grid/nodal_field.h>
#include <coracle/grid/pieces.h>
#include <coracle/particles/material_points.h>

namespace coracle
{
/// How velocities go from the grid to particles.
enum class VelocityTransfer
{
  /// v_p += change of the grid's velocity, blended with a fraction of the grid's velocity itself
  /// (PIC).
  flip,
  /// v_p = the grid's velocity, with its gradient carried as affine velocity (Jiang et al. 2015).
  apic
};

/// Choices that hold for one body and all of a run.
struct TransferOptions
{
  ParticleShape    shape        = ParticleShape::linear;
  VelocityTransfer velocity     = VelocityTransfer::flip;
  double           pic_fraction = 0;
  /// Forces from the mean pressure of a cell's particles instead of each one's own.
  bool average_pressure = false;
};

/// What particles give to the grid in one sweep.
enum class Give
{
  mass_and_momentum,
  force,
  everything
};

/**
 * Particles to grid: mass, momentum and internal force of all particles of a
 * body are added to the field's gathered records.
 */
template <int dim>
void particles_to_grid(const Octree<dim>     &octree,
                       MaterialPoints<dim>   &points,
                       const TransferOptions &options,
                       const Give             give,
                       NodalField<dim>       &field);

/**
 * Grid to particles: new velocities, and next positions from the grid's
 * velocity and position corrections. Positions themselves stay, because the
 * second gathering and the strain increments of MUSL use the weights of the
 * step's start. With `remap`, momenta are given back in the same sweep (MUSL,
 * the second particles-to-grid); clear_momentum() must have been called.
 * @return kinetic energy of this rank's particles afterwards [J]
 */
template <int dim>
double grid_to_particles(const Octree<dim>     &octree,
                         const TransferOptions &options,
                         const double           dt,
                         const bool             remap,
                         NodalField<dim>       &field,
                         MaterialPoints<dim>   &points);

/// Is the particle wholly in the cell? Lanes of points; `margin` is 0 or half the particle's size.
template <int dim>
inline Mask8
inside_cell(const Vector<dim, Pack8> &position,
            const dealii::Point<dim> &lower,
            const double              size,
            const Pack8              &margin)
{
  Mask8 inside = (position[0] - margin >= lower[0]) & (position[0] + margin < lower[0] + size);
  for (int d = 1; d < dim; ++d)
    inside &= (position[d] - margin >= lower[d]) & (position[d] + margin < lower[d] + size);
  return inside;
}

/// Component d of what a cut particle gives to a record as momentum, over its mass [m/s].
template <int dim, bool affine>
inline double
entry_velocity(const MaterialPoints<dim>            &points,
               const std::size_t                     row,
               const Vector<dim, double>            &velocity,
               const typename CutPoints<dim>::Entry &entry,
               const int                             d)
{
  double result = entry.value * velocity[d];
  if constexpr (affine)
    for (int e = 0; e < dim; ++e)
      result += points.column(points.layout().affine + dim * d + e)[row] * entry.moment[e];
  return result;
}

/// dim consecutive columns at one pack of rows.
template <int dim>
inline Vector<dim, Pack8>
load_vector(const MaterialPoints<dim> &points, const int column, const std::size_t row)
{
  Vector<dim, Pack8> result;
  for (int d = 0; d < dim; ++d)
    result[d] = load<Pack8>(points.column(column + d) + row);
  return result;
}

template <int dim>
inline Vector<dim, double>
get_vector(const MaterialPoints<dim> &points, const int column, const std::size_t row)
{
  Vector<dim, double> result;
  for (int d = 0; d < dim; ++d)
    result[d] = points.column(column + d)[row];
  return result;
}
} // namespace coracle
