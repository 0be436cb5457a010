// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <coracle/base/archive.h>
#include <coracle/io/statistics.h>

#include <cstdint>
#include <string>
#include <vector>

namespace coracle
{
/**
 * The energy books [J] (plane strain: per metre of depth). The first four are
 * what is there now, the next four what has left mechanics so far, external
 * work what came in so far through gravity, loads, prescribed motion and
 * particles that left; their balance
 *
 *   B = kinetic + internal + strain + hourglass
 *     + damping + contact + transfer + boundary - external work
 *
 * stays what it was at the start if every kind is booked.
 */
struct EnergyBooks
{
  double kinetic   = 0; ///< particles, elements and rigid bodies
  double internal  = 0; ///< stress work done on particles, and what merging took of their motion
  double strain    = 0; ///< stress work done on elements so far
  double hourglass = 0; ///< work against hourglass stiffness
  double damping   = 0; ///< taken out by damping so far
  double contact   = 0; ///< taken out by contact (impact, friction) so far
  double transfer  = 0; ///< taken out by particle-grid transfer so far
  double boundary  = 0; ///< taken out at the faces of the box so far
  double external_work = 0; ///< gravity, loads, prescribed motion, particles that left

  double balance() const
  {
    return kinetic + internal + strain + hourglass + damping + contact + transfer + boundary -
           external_work;
  }
  /// What the balance is compared with.
  double magnitude() const;
};

/// The relative error of the energy balance since the start; positive when energy appeared.
class EnergyBalance
{
public:
  void start(const EnergyBooks &initial);
  /// (B - B(0)) / largest magnitude so far; 0 while nothing moves.
  double error(const EnergyBooks &now);

  void serialize(Archive &archive)
  {
    archive.same("initial_balance", initial_balance);
    archive.same("scale", scale);
  }

private:
  double initial_balance = 0, scale = 0;
};

/// One body at one time.
template <int dim>
struct BodyReport
{
  std::string            name;
  double                 mass = 0; ///< [kg]
  dealii::Point<dim>     centre;   ///< of mass [m]
  dealii::Tensor<1, dim> velocity; ///< of the centre [m/s]
  /// By contact on this body: momentum received since the last row over the time since then [N].
  dealii::Tensor<1, dim> contact_force;
};

/**
 * Everything the run loop tells at one time, already summed over ranks: the
 * source of the statistics row, the progress line and the verdict.
 */
template <int dim>
struct Report
{
  double        time         = 0; ///< [s]
  std::uint64_t step         = 0;
  double        dt           = 0; ///< last step [s]
  std::uint64_t penetrations = 0; ///< crossings found by the audit so far
  std::uint64_t contacts     = 0; ///< in the last step
  /// Smallest gap - contact distance over the contacts of the steps since the last row; 0 if none
  /// [m].
  std::uint64_t resolved_in_time = 0; ///< ends of paths changed by the continuous check so far
  double        worst_gap        = 0;
  std::uint64_t contact_steps = 0, unconverged_contact_steps = 0; ///< so far
  std::uint64_t particles         = 0;                            ///< present
  std::uint64_t particles_created = 0, particles_removed = 0, particles_converted = 0;
  std::uint64_t particles_split = 0, particles_merged = 0; ///< more and fewer by that
  std::uint64_t cells     = 0;                             ///< of the octree
  std::uint64_t elements  = 0;                             ///< and facets of sheets, of structures
  double        imbalance = 1; ///< work of the busiest rank over the mean
  /// Particle-steps done so far, for the rate shown.
  double                       particle_steps = 0;
  EnergyBooks                  energies;
  double                       energy_balance_error = 0;
  dealii::Tensor<1, dim>       momentum; ///< of everything [kg m/s]
  std::vector<BodyReport<dim>> bodies;

  /// created + split - removed - converted - merged - present; 0 when the ledger is closed.
  std::int64_t ledger_error() const
  {
    return std::int64_t(particles_created + particles_split) - std::int64_t(particles_removed) -
           std::int64_t(particles_converted) - std::int64_t(particles_merged) -
           std::int64_t(particles);
  }
};

/// Columns of every run, in the order doc/output.md lists them. `bodies` as Report::bodies will
/// have them.
template <int dim>
void add_standard_columns(Statistics &statistics, const std::vector<std::string> &bodies);

/// The values of these columns; call between begin_row() and end_row().
template <int dim>
void set_standard_columns(Statistics &statistics, const Report<dim> &report);
} // namespace coracle
