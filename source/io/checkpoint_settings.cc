// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/checkpoint_settings.h>

namespace coracle
{
void
CheckpointSettings::declare(Declaration &section)
{
  section.quantity(
    "Interval", "0 s", "s", "", "Simulated time between two checkpoints; 0: not by time", 0);
  section.integer("Interval in steps", 0, "Steps between two checkpoints; 0: not by steps");
  section.quantity("Interval in wall time",
                   "0 s",
                   "s",
                   "",
                   "Time on the clock between two checkpoints; 0: not by the clock",
                   0);
  section.quantity(
    "Wall time limit",
    "0 s",
    "s",
    "",
    "The run writes a checkpoint and stops before it has taken so long on the clock, "
    "with time left for the writing; 0: no limit",
    0);
  section.integer("Number kept", 2, "Checkpoints that are kept, the newest", 1);
  section.text("Stop file",
               "stop",
               "If a file of this name appears in the output folder, the run writes a checkpoint, "
               "removes the file and stops; empty: none");
}

CheckpointSettings
CheckpointSettings::read(const Parameters &section)
{
  const double time = section.quantity("Interval"),
               wall = section.quantity("Interval in wall time");
  const int steps   = section.integer("Interval in steps");
  return {Interval(time, steps),
          wall,
          section.quantity("Wall time limit"),
          static_cast<unsigned int>(section.integer("Number kept")),
          section.text("Stop file"),
          time > 0 || steps > 0 || wall > 0};
}
} // namespace coracle
