// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/report.h>
#include <coracle/io/verdict.h>

#include <chrono>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace coracle
{
/**
 * What a run shows: a header of what it is about to do, a line per reporting
 * interval, a summary. Writes to one stream, which on ranks other than 0 should
 * swallow everything.
 */
class Progress
{
public:
  /// @param end_time [s], for the time left
  Progress(std::ostream &out, const double end_time);

  /// Pairs like ("particles", "40,000 in 'water'"), one a line, under a title.
  void header(const std::string                                      &title,
              const std::vector<std::pair<std::string, std::string>> &facts);

  /// Step, time, dt, contacts, worst gap, energy error, particle-steps per second, time left.
  template <int dim>
  void line(const Report<dim> &report);

  /// Totals, where the results are, the verdict.
  template <int dim>
  void summary(const Report<dim> &report, const Verdict &verdict, const std::string &directory);

private:
  using Clock = std::chrono::steady_clock;

  double seconds_left(const double time) const;

  std::ostream     &out;
  double            end_time;
  Clock::time_point start, last_line;
  double            start_time = 0, last_particle_steps = 0;
  unsigned int      n_lines = 0;
};
} // namespace coracle
