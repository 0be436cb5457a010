// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/checkpoint_settings.h>

#include <chrono>

namespace coracle
{
/**
 * What is asked of a run from outside, and by the clock: SIGINT, SIGTERM, a stop
 * file or the limit of wall time stop it after the step; SIGUSR1 and the
 * intervals want a checkpoint. A second SIGINT ends the program at once, because
 * then the first one has given the signal back to the system.
 */
class RunControl
{
public:
  /// Signals are caught from now on. The limit of wall time counts from the start of the program.
  RunControl(const CheckpointSettings &settings,
             const std::string        &output_directory,
             MPI_Comm                  communicator);

  /// The same on all ranks.
  struct Orders
  {
    bool checkpoint = false, stop = false;
    /// Why it stops: "SIGTERM", "the stop file", ...
    std::string reason;
  };

  /// To be asked once after each step. Collective.
  Orders ask(const double time, const std::uint64_t step);

  /// Intervals count from here: the state that a run goes on from. Nothing is due.
  void start_from(const double time, const std::uint64_t step)
  {
    settings.interval.due(time, step);
  }

  /// A checkpoint is done.
  void checkpoint_written(const double seconds);

private:
  using Clock = std::chrono::steady_clock;

  double seconds_since(const Clock::time_point from) const;
  bool   time_is_up();
  bool   remove_stop_file() const;

  CheckpointSettings settings;
  const std::string  stop_file;
  MPI_Comm           comm;
  Clock::time_point  last_step, last_checkpoint;
  double             longest_step = 0, longest_checkpoint = 0;
};
} // namespace coracle
