// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/transfer.h>
#include <coracle/material/library.h>

namespace coracle
{
/// Cure for the volumetric noise (and locking) of multilinear cells.
enum class VolumeStrain
{
  /// Each particle follows the divergence at its own place.
  particle,
  /// All particles of a body in a cell share their volume-weighted mean divergence.
  cell_mean
};

/// What a sweep over a body's particles on this rank has found.
struct StressSweep
{
  /// Stress power times step, with the mean of old and new stress [J].
  double work = 0;
  /// The same, exact, if the options ask for it.
  ExactSum exact_work;
  /// Kinetic energy of the particles [J].
  double kinetic = 0;
  /// Largest (wave speed + particle speed) / cell size [1/s]; its inverse bounds the step.
  double rate = 0;
  /// Largest diffusivity / cell size^2 [1/s].
  double diffusion_rate = 0;
  /// Row of a particle whose state is no longer a number or whose volume has vanished, or -1.
  long bad_row = -1;
};

/// Choices that hold for one sweep over a body.
struct StressOptions
{
  ParticleShape shape         = ParticleShape::linear;
  VolumeStrain  volume_strain = VolumeStrain::cell_mean;
  /// Share of the way that specific volumes go to their cell's mean in this step [1]; only with
  /// cell_mean.
  double volume_smoothing = 0;
  /// [s]
  double dt = 0;
  /// Is an exact sum of work wanted?
  bool exact_work = false;
};

/**
 * Strain increments from a grid velocity and the material's answer, for all
 * particles of a body at their positions at the start of the step.
 *
 * @param velocity records whose entries velocity_place... are the nodal velocity [m/s]
 */
template <int dim>
StressSweep update_particle_stress(const Octree<dim>     &octree,
                                   const NodeRecords     &velocity,
                                   const unsigned int     velocity_place,
                                   const MaterialVariant &material,
                                   const StressOptions   &options,
                                   MaterialPoints<dim>   &points);

/// Stress (pressure) of particles that have just been made, from their density, at rest.
template <int dim>
void initialise_particle_stress(const MaterialVariant &material, MaterialPoints<dim> &points);
} // namespace coracle
