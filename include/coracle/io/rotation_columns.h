// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/statistics.h>
#include <coracle/particles/material_points.h>

namespace coracle
{
/// How a body of material points turns as a whole. In 2-D only component 2 is not zero.
struct Rotation
{
  /// About the centre of mass [kg m^2/s].
  dealii::Tensor<1, 3> angular_momentum;
  /// Of the rigid body with the same particles and angular momentum [rad/s]; 0 where the particles
  /// lie on one line.
  dealii::Tensor<1, 3> angular_velocity;
};

/// Over all ranks. Collective.
template <int dim>
Rotation rotation_of(const MaterialPoints<dim>    &points,
                     const dealii::Point<dim>     &centre,
                     const dealii::Tensor<1, dim> &velocity,
                     const MPI_Comm                comm);

/// Columns <body>.angular_momentum and <body>.angular_velocity, in 2-D of z only.
template <int dim>
void add_rotation_columns(Statistics &statistics, const std::string &body);

template <int dim>
void
set_rotation_columns(Statistics &statistics, const std::string &body, const Rotation &rotation);
} // namespace coracle
