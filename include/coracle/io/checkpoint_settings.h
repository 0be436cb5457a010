// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/output_settings.h>

namespace coracle
{
/// Section `Checkpoint`: when the state is saved, and what makes a run stop early.
struct CheckpointSettings
{
  /// Of steps and simulated time.
  Interval interval;
  /// Wall time between checkpoints, and of the whole run; 0: no limit [s].
  double wall_interval, wall_limit;
  /// Checkpoints that are kept.
  unsigned int n_kept;
  /// In the output folder.
  std::string stop_file;

  /// Are checkpoints written without being asked for? Then one is written at the end, too.
  bool by_itself;

  static void               declare(Declaration &checkpoint_section);
  static CheckpointSettings read(const Parameters &checkpoint_section);
};
} // namespace coracle
