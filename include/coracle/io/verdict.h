// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>
#include <coracle/io/report.h>

#include <string>
#include <vector>

namespace coracle
{
/// The value is the exit code of the program; 2 is a mistake in the input.
enum class Outcome
{
  ok      = 0,
  suspect = 1,
  failed  = 3
};

/// What a run is worth, with every reason that speaks against it.
struct Verdict
{
  Outcome                  outcome = Outcome::ok;
  std::vector<std::string> reasons;

  int exit_code() const { return static_cast<int>(outcome); }
  /// "verdict: OK", or "verdict: SUSPECT" and a line for each reason.
  std::string text() const;
};

/// Section `Output/Verdict`.
struct VerdictLimits
{
  double energy_gain       = 0.02; ///< share of the largest energy
  double energy_loss       = 0.10; ///< share of the largest energy
  double unconverged_share = 0.01; ///< of the steps with contact
  /// The run ends where energy is gained or lost beyond this share.
  double energy_stop = 1e300;

  static void          declare(Declaration &verdict_section);
  static VerdictLimits read(const Parameters &verdict_section);
};

/// Throws RunFailure where the energy balance is beyond what a run may go on with, or a number is
/// not finite.
template <int dim>
void check_while_running(const Report<dim> &report, const VerdictLimits &limits);

/**
 * FAILED: penetrations, a ledger that is not closed, a number that is not
 * finite. SUSPECT: energy gained or lost without a booking beyond the limits,
 * too many contact steps that did not converge.
 */
template <int dim>
Verdict judge(const Report<dim> &report, const VerdictLimits &limits);

/// A run that broke off: FAILED with this reason first, then those of judge().
template <int dim>
Verdict judge_broken_run(const std::string   &reason,
                         const Report<dim>   &last_report,
                         const VerdictLimits &limits);
} // namespace coracle
