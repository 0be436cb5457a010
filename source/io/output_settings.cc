// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/output_settings.h>

#include <cmath>

namespace coracle
{
namespace
{
/// `name` is "Interval" or "... interval".
void
declare_interval(Declaration &section, const std::string &name, const std::string &what)
{
  section.quantity(name,
                   "0 s",
                   "s",
                   "",
                   "Simulated time between " + what +
                     " if neither this nor the interval in steps is set",
                   0);
  section.integer(name + " in steps", 0, "Steps between them; 0: not by steps");
}

Interval
read_interval(const Parameters &section, const std::string &name, const double default_time)
{
  const double time  = section.quantity(name);
  const int    steps = section.integer(name + " in steps");
  return {time == 0 && steps == 0 ? default_time : time, static_cast<unsigned int>(steps)};
}
} // namespace

Interval::Interval(const double time, const unsigned int steps)
  : every_time(time), every_steps(steps)
{}

bool
Interval::due(const double time, const std::uint64_t step)
{
  bool due = (step == 0) || (every_steps > 0 && step % every_steps == 0);
  if (every_time > 0)
    {
      // A step that ends just short of a multiple counts as being there.
      const auto periods = static_cast<std::uint64_t>(std::floor(time / every_time * (1 + 1e-12)));
      due                = due || periods > periods_done;
      periods_done       = periods;
    }
  return due;
}

void
OutputSettings::declare(Declaration &output_section)
{
  output_section.text("Directory",
                      "",
                      "Folder of the results, created if it does not exist; empty: output/NAME "
                      "for the case NAME.prm, where the program runs");
  declare_interval(output_section,
                   "Interval",
                   "two outputs of particles and meshes; 1/50 of the end time");
  declare_interval(output_section,
                   "Statistics interval",
                   "two rows of statistics.csv; 1/1000 of the end time");
  declare_interval(output_section, "Log interval", "two progress lines; 1/40 of the end time");
  output_section.choice(
    "Particle format",
    "hdf5",
    {"hdf5", "vtu", "both", "none"},
    "hdf5: one file a time, listed by NAME.xdmf; vtu: one file a time and rank, "
    "listed by NAME.pvd");
  output_section.choice("Precision",
                        "single",
                        {"single", "double"},
                        "Of the numbers in particle and mesh files; statistics.csv and checkpoints "
                        "are always in double precision");
  output_section.flag("Structures", true, "Write structures and rigid bodies (NAME.pvd)");
  output_section.flag("Octree", false, "Write the background grid (octree.pvd)");
  VerdictLimits::declare(
    output_section.section("Verdict", "When a run is called suspect at its end"));
}

OutputSettings
OutputSettings::read(const Parameters &output_section, const double end_time)
{
  const std::string format = output_section.choice("Particle format");
  ParticleFormat    particles;
  particles.hdf5             = (format == "hdf5" || format == "both");
  particles.vtu              = (format == "vtu" || format == "both");
  particles.single_precision = (output_section.choice("Precision") == "single");
  return {particles,
          output_section.flag("Structures"),
          output_section.flag("Octree"),
          read_interval(output_section, "Interval", end_time / 50),
          read_interval(output_section, "Statistics interval", end_time / 1000),
          read_interval(output_section, "Log interval", end_time / 40),
          VerdictLimits::read(output_section.section("Verdict"))};
}
} // namespace coracle
