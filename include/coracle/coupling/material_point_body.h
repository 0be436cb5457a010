// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/particle_stress.h>
#include <coracle/material/library.h>
#include <coracle/particles/material_points.h>

#include <memory>
#include <string>

namespace coracle
{
/// When in a step stresses are updated: with the velocities at its start (USF), at its end (USL),
/// or at its end with velocities gathered again from the particles (MUSL, Sulsky et al. 1995).
enum class StressUpdate
{
  usf,
  usl,
  musl
};

/// Surfaces that material points may meet.
struct MetSurfaces
{
  int n_sheets = 0;
  /// What touches a surface deforms in one half only (Contact/Rigid half).
  bool can_touch = false;
};

/**
 * A body of material points as its section of the parameter file describes it,
 * with its particles on this rank.
 */
template <int dim>
class MaterialPointBody
{
public:
  /// Entries of `Bodies/<name>` where Kind = material points.
  static void declare(Declaration &body);

  /// Generates the particles that lie in this rank's leaves, or none. Collective.
  MaterialPointBody(const Parameters      &body,
                    const MaterialLibrary &materials,
                    const Octree<dim>     &octree,
                    const MetSurfaces     &met,
                    const bool             with_particles = true);

  /// Between steps. Particles saved by other ranks must be handed out then, see redistribute().
  void serialize(Archive &archive);

  const std::string &name() const { return points.name(); }
  /// 0, or the part of its size that a particle reaches out from its centre.
  double margin_of_shape() const { return transfer.shape == ParticleShape::gimp ? 0.5 : 0.; }

  /// Bounds on the next step in these cells, where there was no stress update since they are there.
  void find_rates(const Octree<dim> &octree);

  /// Velocities times exp(-c dt) while damping is on [J lost].
  double damp(const double time, const double dt, MPI_Comm comm);

  MaterialPoints<dim>    points;
  const MaterialVariant &material;
  TransferOptions        transfer;
  VolumeStrain           volume_strain;
  /// Per stable step [1].
  double       volume_smoothing;
  StressUpdate stress_update;
  std::string  field_name;
  unsigned int field = 0;
  /// Contact radius over particle size [1].
  double radius_factor;
  /// Particles along an edge of a cell that adaptivity keeps up [1].
  double particles_across;
  /// Acceleration [m/s^2] besides gravity, or none.
  std::unique_ptr<dealii::Function<dim>> body_force;
  /// Of the last stress update, on this rank.
  StressSweep sweep;
  /// Work of stresses so far, on this rank [J].
  double internal_energy = 0;

private:
  void        generate(const Parameters &body, const Octree<dim> &octree);
  void        set_initial_pressure(const Parameters &body);
  static void declare_method(Declaration &body);

  double damping_rate, damping_end;
};
} // namespace coracle
