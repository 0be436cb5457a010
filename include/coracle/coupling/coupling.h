// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/timer.h>
#include <coracle/coupling/adaptivity.h>
#include <coracle/coupling/meshless_system.h>

namespace coracle
{
/// Section `Time`, and what holds for the whole case.
template <int dim>
struct CouplingOptions
{
  double                 safety_factor, largest_step, smallest_share;
  bool                   split_fields;
  dealii::Tensor<1, dim> gravity;
  /// Results are the same on any number of ranks, bit by bit.
  bool reproducible;

  static void            declare(Declaration &root);
  static CouplingOptions read(const Parameters &root);
};

/**
 * The coupled problem and its step. This is the one place that knows the order
 * in which things happen.
 */
template <int dim>
class Coupling
{
public:
  /// All sections that every case has. Collective; throws UserError.
  static void declare(Declaration &root);
  /// @param saved_octree of a state that is loaded next (see Octree); null: the start of the case
  Coupling(const Parameters &root, MPI_Comm comm, Archive *saved_octree = nullptr);

  /// The whole state between steps but for the octree's leaves. Collective.
  void serialize(Archive &archive);

  /// One step; no longer than up to `end_time`. Collective; throws RunFailure.
  void advance(const double end_time);

  double        time() const { return current_time; }
  double        last_step() const { return current_dt; }
  std::uint64_t step() const { return n_steps; }

  /// Estimate before the first step, for --check.
  double choose_time_step() const;

  const CouplingOptions<dim> options;
  MaterialLibrary            materials;
  StructureSystem<dim>       structure;
  MaterialPointSystem<dim>   points;
  MeshlessSystem<dim>        fluids;
  ContactCoupling<dim>       contacts;
  Adaptivity<dim>            adaptivity;
  TimingTable                timed;
  /// At the start.
  typename ContactCoupling<dim>::Projected projected;

  double        particle_steps = 0;
  std::uint64_t contact_steps = 0, unconverged_contact_steps = 0;
  /// Smallest g - R of all contacts since the last report [m]; the report resets it.
  double worst_gap = 0;

private:
  /// Of the structure, for the points.
  MetSurfaces met_surfaces(const Parameters &root) const;
  void        share_out();
  /// Shape functions of particles at surfaces, for this step.
  void cut_points();
  /// A step far below the first one is a RunFailure that says what asks for it.
  void check_time_step(const double dt);
  /// Who asks for the step. Collective.
  std::string describe_limit() const;
  /// What went wrong on any rank, and the particle ledger: the same exception on all ranks.
  void check_state() const;
  void count_work();

  MPI_Comm      comm;
  double        current_time = 0, current_dt = 0, first_dt = 0;
  std::uint64_t n_steps = 0;
};
} // namespace coracle
