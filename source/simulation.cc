// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/log.h>
#include <coracle/base/mpi.h>
#include <coracle/io/coupling_output.h>
#include <coracle/io/output_directory.h>
#include <coracle/io/progress.h>
#include <coracle/simulation.h>

#include <csignal>
#include <iomanip>
#include <sstream>

namespace coracle
{
namespace
{
volatile std::sig_atomic_t stop_requested = 0;

// The first request ends the run after the step; the second one ends the program at once.
void
request_stop(const int signal)
{
  stop_requested = 1;
  std::signal(signal, SIG_DFL);
}

std::string
with_unit(const double value, const std::string &unit)
{
  std::ostringstream text;
  text << std::setprecision(4) << value << ' ' << unit;
  return text.str();
}

/// One case: set-up, the run loop, what it says.
template <int dim>
class Simulation
{
public:
  Simulation(const ParameterFile &file, const RunOptions &options, MPI_Comm comm)
    : file(file)
    , root(file.parameters())
    , options(options)
    , comm(comm)
    , end_time(root.quantity("End time"))
    , log(comm)
    , coupling(root, comm)
  {}

  int check()
  {
    Progress progress(log.out(), end_time);
    progress.header("check of " + options.file + ": no mistakes found", facts());
    return 0;
  }

  int run()
  {
    const Parameters     output_section = root.section("Output");
    const OutputSettings settings       = OutputSettings::read(output_section, end_time);
    OutputDirectory      directory(output_section, options.file, comm);
    mpi::agree(
      [&] {
        if (mpi::rank(comm) == 0)
          log.open(directory.file("log.txt"));
      },
      comm);
    directory.write_parameters(file.print());
    CouplingOutput<dim> output(root, settings, directory, coupling);
    Progress            progress(log.out(), end_time);
    progress.header(options.file, facts());

    Report<dim> report;
    Verdict     verdict;
    try
      {
        loop(settings, output, progress, report);
        verdict = judge(report, settings.limits);
      }
    catch (const RunFailure &failure)
      {
        report  = output.make_report(coupling);
        verdict = judge_broken_run(failure.what(), report, settings.limits);
        output.write(coupling);
        output.write_statistics(report, coupling);
      }
    if (stop_requested)
      log.out() << "stopped by a signal at t = " << coupling.time() << " s\n";
    coupling.timed.print(log.out(), comm);
    log.finish();
    progress.summary(report, verdict, directory.path());
    return verdict.exit_code();
  }

private:
  void loop(const OutputSettings &settings,
            CouplingOutput<dim>  &output,
            Progress             &progress,
            Report<dim>          &report)
  {
    Interval write = settings.output, statistics = settings.statistics, line = settings.log;
    for (bool last = false;; last = step_is_last())
      {
        const double        t = coupling.time();
        const std::uint64_t n = coupling.step();
        // Each asks once a step, also where another one is due as well.
        const bool write_now = write.due(t, n), statistics_now = statistics.due(t, n),
                   line_now = line.due(t, n);
        if (write_now || last)
          coupling.timed("output", [&] { output.write(coupling); });
        if (statistics_now || line_now || last)
          coupling.timed("report", [&] {
            report = output.make_report(coupling);
            if (statistics_now || last)
              output.write_statistics(report, coupling);
            if (line_now || last)
              progress.line(report);
            log.report();
          });
        if (last)
          return;
        coupling.advance(end_time);
      }
  }

  bool step_is_last() const
  {
    return mpi::any(stop_requested != 0, comm) || coupling.time() >= end_time * (1 - 1e-14);
  }

  std::vector<std::pair<std::string, std::string>> facts() const
  {
    std::vector<std::pair<std::string, std::string>> result;
    const auto add = [&result](const std::string &name, const std::string &text) {
      result.emplace_back(name, text);
    };
    const auto &octree = coupling.points.octree;
    add("dimension", std::to_string(dim));
    add("ranks", std::to_string(mpi::n_ranks(comm)));
    add("grid",
        std::to_string(mpi::sum<std::uint64_t>(octree.n_owned_leaves(), comm)) +
          " cells, smallest " + with_unit(octree.smallest_cell_size(), "m"));
    for (const auto &body : coupling.points.bodies)
      add("body",
          "'" + body.name() + "', material points: " +
            std::to_string(mpi::sum<std::uint64_t>(body.points.n_particles(), comm)));
    for (const auto &body : coupling.structure.solids)
      add("body",
          "'" + body.name() + "', solid: " + std::to_string(body.mesh().n_global_elements()) +
            " elements, " + std::to_string(body.mesh().n_global_nodes()) + " nodes");
    for (const auto &body : coupling.structure.rigids)
      add("body",
          "'" + body.name() + "', rigid: " + std::to_string(body.mesh().n_global_elements()) +
            (body.mesh().n_sheets() > 0 ? " facets of " + std::to_string(body.mesh().n_sheets()) +
                                            (body.mesh().n_sheets() > 1 ? " sheets" : " sheet")
                                        : " elements") +
            ", mass " + with_unit(body.mass(), "kg"));
    if (coupling.projected.n_particles > 0)
      add("moved out",
          std::to_string(coupling.projected.n_particles) +
            " particles that started too near to a structure, by up to " +
            with_unit(coupling.projected.farthest, "m"));
    const double dt = coupling.choose_time_step();
    add("first step", with_unit(dt, "s"));
    add("estimated steps", std::to_string(static_cast<std::uint64_t>(std::ceil(end_time / dt))));
    add("memory",
        with_unit(mpi::sum<double>(coupling.points.memory_consumption(), comm) / 1e6,
                  "MB for particles and grid"));
    return result;
  }

  const ParameterFile &file;
  const Parameters     root;
  const RunOptions     options;
  MPI_Comm             comm;
  const double         end_time;
  Log                  log;
  Coupling<dim>        coupling;
};

template <int dim>
int
run_case(const ParameterFile &file, const RunOptions &options, MPI_Comm comm)
{
  Simulation<dim> simulation(file, options, comm);
  if (options.check)
    return simulation.check();
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  return simulation.run();
}
} // namespace

void
declare_parameters(Declaration &root)
{
  root.choice("Dimension", "2", {"2", "3"}, "2: plane strain, one metre deep; 3: space.");
  root.quantity("End time", "1", "s", "", "The run ends here.", 0.);
  // Three dimensions declare a superset of what two do.
  Coupling<3>::declare(root);
  Declaration &output = root.section("Output", "What is written, when and where.");
  OutputSettings::declare(output);
  ProbeDescription<3>::declare(root);
}

int
run(const RunOptions &options, MPI_Comm comm)
{
  Declaration root;
  declare_parameters(root);
  ParameterFile file(root);
  file.read(options.file);
  for (const std::string &assignment : options.assignments)
    file.set(assignment);
  return file.parameters().choice("Dimension") == "2" ? run_case<2>(file, options, comm)
                                                      : run_case<3>(file, options, comm);
}
} // namespace coracle
