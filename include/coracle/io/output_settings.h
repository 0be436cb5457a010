// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>
#include <coracle/io/particle_output.h>
#include <coracle/io/verdict.h>

#include <cstdint>

namespace coracle
{
/**
 * When something is due: each `time` seconds of simulated time, each `steps`
 * steps, or both. A time that is 0 and steps that are 0 mean never.
 */
class Interval
{
public:
  Interval(const double time, const unsigned int steps);

  /// Is it due after this step? Asks once per step; the start (step 0) is always due.
  bool due(const double time, const std::uint64_t step);

private:
  double        every_time;
  unsigned int  every_steps;
  std::uint64_t periods_done = 0;
};

/// Section `Output` as read.
struct OutputSettings
{
  ParticleFormat particles;
  bool           structures = true, octree = false;
  Interval       output, statistics, log;
  VerdictLimits  limits;

  static void declare(Declaration &output_section);
  /// Intervals that are not set follow from the end time [s].
  static OutputSettings read(const Parameters &output_section, const double end_time);
};
} // namespace coracle
