// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/io/verdict.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace coracle
{
namespace
{
std::string
percent(const double share)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g %%", 100 * share);
  return text;
}

template <int dim>
bool
is_finite(const Report<dim> &report)
{
  double sum = report.time + report.dt + report.worst_gap + report.energies.balance() +
               report.energy_balance_error + report.momentum.norm();
  for (const BodyReport<dim> &body : report.bodies)
    sum += body.mass + body.centre.norm() + body.velocity.norm() + body.contact_force.norm();
  return std::isfinite(sum);
}
} // namespace

std::string
Verdict::text() const
{
  std::string text = std::string("verdict: ") + (outcome == Outcome::ok        ? "OK"
                                                 : outcome == Outcome::suspect ? "SUSPECT"
                                                                               : "FAILED");
  for (const std::string &reason : reasons)
    text += "\n  - " + reason;
  return text;
}

void
VerdictLimits::declare(Declaration &verdict_section)
{
  verdict_section.quantity("Energy gain limit",
                           "0.02",
                           "1",
                           "",
                           "A run is SUSPECT when energy appears that no booking explains, by more "
                           "than this share of the largest energy so far",
                           0);
  verdict_section.quantity("Energy loss limit",
                           "0.1",
                           "1",
                           "",
                           "A run is SUSPECT when energy disappears that no booking explains, by "
                           "more than this share of the largest energy so far",
                           0);
  verdict_section.quantity(
    "Energy error that ends the run",
    "1e300",
    "1",
    "",
    "A run ends with FAILED where energy appears or disappears, and no booking "
    "explains it, by more than this share of the largest energy so far; looked "
    "at in each row of statistics.csv and each progress line",
    0);
  verdict_section.quantity(
    "Unconverged contact limit",
    "0.01",
    "1",
    "",
    "A run is SUSPECT when the contact solver stopped short of its tolerance "
    "in more than this share of the steps with contact",
    0,
    1);
}

VerdictLimits
VerdictLimits::read(const Parameters &verdict_section)
{
  VerdictLimits limits;
  limits.energy_gain       = verdict_section.quantity("Energy gain limit");
  limits.energy_loss       = verdict_section.quantity("Energy loss limit");
  limits.energy_stop       = verdict_section.quantity("Energy error that ends the run");
  limits.unconverged_share = verdict_section.quantity("Unconverged contact limit");
  return limits;
}

template <int dim>
void
check_while_running(const Report<dim> &report, const VerdictLimits &limits)
{
  const std::string when =
    "t = " + std::to_string(report.time) + " s, step " + std::to_string(report.step);
  if (!is_finite(report))
    throw RunFailure("a reported number is not finite",
                     when,
                     "see statistics.csv for which, and look at what happens before");
  if (std::abs(report.energy_balance_error) > limits.energy_stop)
    throw RunFailure("the energy balance is lost",
                     percent(report.energy_balance_error) + " of the largest energy at " + when +
                       " (limit " + percent(limits.energy_stop) + ")",
                     "lower Time/Safety factor, or look at what gains or takes energy in "
                     "statistics.csv");
}

template <int dim>
Verdict
judge(const Report<dim> &report, const VerdictLimits &limits)
{
  Verdict    verdict;
  const auto blame = [&](const Outcome outcome, const std::string &reason) {
    verdict.outcome = std::max(verdict.outcome, outcome);
    verdict.reasons.push_back(reason);
  };

  if (report.penetrations > 0)
    blame(Outcome::failed,
          std::to_string(report.penetrations) + " times a particle passed through a surface");
  if (report.ledger_error() != 0)
    blame(Outcome::failed,
          "the particle ledger is not closed: " + std::to_string(report.particles_created) +
            " created, " + std::to_string(report.particles_split) + " by splitting, " +
            std::to_string(report.particles_merged) + " merged away, " +
            std::to_string(report.particles_removed) + " removed, " +
            std::to_string(report.particles_converted) + " converted, but " +
            std::to_string(report.particles) + " present");
  if (!is_finite(report))
    blame(Outcome::failed, "a reported number is not finite");

  if (report.energy_balance_error > limits.energy_gain)
    blame(Outcome::suspect,
          "energy appeared from nowhere: " + percent(report.energy_balance_error) +
            " of the largest energy (limit " + percent(limits.energy_gain) + ")");
  if (report.energy_balance_error < -limits.energy_loss)
    blame(Outcome::suspect,
          "energy got lost: " + percent(-report.energy_balance_error) +
            " of the largest energy (limit " + percent(limits.energy_loss) + ")");
  if (report.unconverged_contact_steps > limits.unconverged_share * report.contact_steps)
    blame(Outcome::suspect,
          "the contact solver did not converge in " +
            std::to_string(report.unconverged_contact_steps) + " of " +
            std::to_string(report.contact_steps) + " steps with contact");
  return verdict;
}

template <int dim>
Verdict
judge_broken_run(const std::string   &reason,
                 const Report<dim>   &last_report,
                 const VerdictLimits &limits)
{
  Verdict verdict = judge(last_report, limits);
  verdict.outcome = Outcome::failed;
  verdict.reasons.insert(verdict.reasons.begin(), reason);
  return verdict;
}

template void    check_while_running(const Report<2> &, const VerdictLimits &);
template void    check_while_running(const Report<3> &, const VerdictLimits &);
template Verdict judge(const Report<2> &, const VerdictLimits &);
template Verdict judge(const Report<3> &, const VerdictLimits &);
template Verdict judge_broken_run(const std::string &, const Report<2> &, const VerdictLimits &);
template Verdict judge_broken_run(const std::string &, const Report<3> &, const VerdictLimits &);
} // namespace coracle
