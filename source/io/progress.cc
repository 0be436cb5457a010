// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/progress.h>
#include <coracle/io/text.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

namespace coracle
{
namespace
{
const char *const heading = "      step       time         dt  contacts   worst gap    energy "
                            "error  particle-steps/s    left\n";

/// The headings again after so many lines, so that they are on the screen.
constexpr unsigned int lines_per_heading = 25;

double
seconds_between(const std::chrono::steady_clock::time_point from,
                const std::chrono::steady_clock::time_point to)
{
  return std::chrono::duration<double>(to - from).count();
}
} // namespace

Progress::Progress(std::ostream &out, const double end_time)
  : out(out), end_time(end_time), start(Clock::now()), last_line(start)
{}

void
Progress::header(const std::string                                      &title,
                 const std::vector<std::pair<std::string, std::string>> &facts)
{
  std::size_t width = 0;
  for (const auto &fact : facts)
    width = std::max(width, fact.first.size());
  out << title << '\n';
  for (const auto &[what, value] : facts)
    out << "  " << what << std::string(width - what.size() + 2, ' ') << value << '\n';
  out << std::endl;
}

template <int dim>
void
Progress::line(const Report<dim> &report)
{
  const auto now = Clock::now();
  if (n_lines == 0)
    {
      // What came before the first line is set-up, or an earlier run that this one goes on from.
      start               = now;
      start_time          = report.time;
      last_particle_steps = report.particle_steps;
    }
  if (n_lines++ % lines_per_heading == 0)
    out << heading;

  const double passed = seconds_between(last_line, now);
  const double rate   = passed > 0 ? (report.particle_steps - last_particle_steps) / passed : 0.;
  last_line           = now;
  last_particle_steps = report.particle_steps;

  std::array<char, 160> text;
  std::snprintf(text.data(),
                text.size(),
                "%10llu %10s %10s %9llu %11s %14.3g %% %17s %7s",
                static_cast<unsigned long long>(report.step),
                with_prefix(report.time, "s").c_str(),
                with_prefix(report.dt, "s").c_str(),
                static_cast<unsigned long long>(report.contacts),
                report.contacts > 0 ? with_prefix(report.worst_gap, "m").c_str() : "-",
                100 * report.energy_balance_error,
                with_prefix(rate, "").c_str(),
                clock_time(seconds_left(report.time)).c_str());
  out << text.data() << std::endl;
}

double
Progress::seconds_left(const double time) const
{
  if (time >= end_time)
    return 0;
  const double progress = (time - start_time) / (end_time - start_time);
  return progress > 0 ? seconds_between(start, last_line) * (1 - progress) / progress
                      : std::numeric_limits<double>::quiet_NaN();
}

template <int dim>
void
Progress::summary(const Report<dim> &report, const Verdict &verdict, const std::string &directory)
{
  out << '\n'
      << report.step << " steps to " << with_prefix(report.time, "s") << " in "
      << clock_time(seconds_between(start, Clock::now())) << " (h:mm:ss)\n"
      << "  particles     " << report.particles << " present, " << report.particles_removed
      << " left through open faces\n"
      << "  penetrations  " << report.penetrations << '\n'
      << "  results       " << directory << '\n'
      << verdict.text() << std::endl;
}

template void Progress::line(const Report<2> &);
template void Progress::line(const Report<3> &);
template void Progress::summary(const Report<2> &, const Verdict &, const std::string &);
template void Progress::summary(const Report<3> &, const Verdict &, const std::string &);
} // namespace coracle
