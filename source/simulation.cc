// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/log.h>
#include <coracle/base/mpi.h>
#include <coracle/io/checkpoint.h>
#include <coracle/io/output_directory.h>
#include <coracle/io/progress.h>
#include <coracle/io/run_control.h>
#include <coracle/io/same_case.h>
#include <coracle/simulation.h>

#include <iomanip>
#include <memory>
#include <sstream>

namespace coracle
{
namespace
{
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
    , directory_path(OutputDirectory::choose(root.section("Output"), options.file))
    , checkpoints(directory_path, comm)
    , from(options.restart ? find_checkpoint() : std::optional<CheckpointFolder::Saved>())
    , saved(from ? std::make_unique<SavedState>(*from, comm) : nullptr)
    , coupling(root, comm, saved ? &saved->archive : nullptr)
  {}

  int check()
  {
    if (from)
      load_checkpoint<dim>(*saved, coupling, nullptr);
    Progress progress(log.out(), end_time);
    progress.header("check of " + options.file + ": no mistakes found", facts());
    return 0;
  }

  int run()
  {
    const Parameters         output_section = root.section("Output");
    const OutputSettings     settings       = OutputSettings::read(output_section, end_time);
    const CheckpointSettings saving         = CheckpointSettings::read(root.section("Checkpoint"));
    OutputDirectory          directory(output_section, options.file, comm, bool(from));
    mpi::agree(
      [&] {
        if (mpi::rank(comm) == 0)
          log.open(directory.file("log.txt"), bool(from));
      },
      comm);
    if (!from && checkpoints.set_aside())
      log.out() << "checkpoints of an earlier run are now in " << checkpoints.path() << ".old\n\n";
    directory.write_parameters(file.print());
    CouplingOutput<dim> output(root, settings, directory, coupling);
    if (from)
      load_checkpoint(*saved, coupling, &output);
    saved.reset();
    Progress progress(log.out(), end_time);
    progress.header(options.file, facts());
    RunControl control(saving, directory.path(), comm);
    Loop       loop{settings, saving, output, progress, control};
    Verdict    verdict;
    try
      {
        run_loop(loop);
        verdict = judge(loop.report, settings.limits);
      }
    catch (const RunFailure &failure)
      {
        loop.report = output.make_report(coupling);
        verdict     = judge_broken_run(failure.what(), loop.report, settings.limits);
        output.write(coupling);
        output.write_statistics(loop.report, coupling);
      }
    if (!loop.stopped_by.empty())
      say_stopped(loop, verdict);
    coupling.timed.print(log.out(), comm);
    log.finish();
    progress.summary(loop.report, verdict, directory.path());
    return verdict.exit_code();
  }

private:
  /// What the run loop works with, and what has become of it.
  struct Loop
  {
    const OutputSettings     &settings;
    const CheckpointSettings &saving;
    CouplingOutput<dim>      &output;
    Progress                 &progress;
    RunControl               &control;
    Report<dim>               report         = {};
    std::int64_t              step_of_report = -1, step_of_line = -1;
    std::string               stopped_by = "", not_saved = "";
  };

  /// Which of the things that are told of a moment.
  struct Wanted
  {
    bool fields, row, line;
  };

  /// The newest checkpoint that is whole, of this case. What is wrong with others is said.
  std::optional<CheckpointFolder::Saved> find_checkpoint()
  {
    std::vector<std::string> complaints;
    const auto               found = checkpoints.newest_good(complaints);
    std::string              all;
    for (const std::string &complaint : complaints)
      all += complaint + "\n";
    if (!found)
      throw UserError(
        "there is no checkpoint to go on from",
        "command line, --restart",
        complaints.empty() ? "no checkpoint in " + checkpoints.path()
                           : all.substr(0, all.find_last_not_of("\n ") + 1),
        "see that Output/Directory is that of the run to be continued, or run the case "
        "from its start, without --restart");
    if (found->facts.dimension != dim)
      throw root.error("Dimension",
                       "this is not the case that is to be continued",
                       found->path + " has dimension " + std::to_string(found->facts.dimension),
                       "take the parameter file that it was run with");
    for (const std::string &complaint : complaints)
      log.out() << "warning: " << complaint << "\n         the next older one is looked at\n";
    ParameterFile then = file.empty_copy();
    then.read(parameters_of(*found));
    const auto changes = check_same_case(root, then.parameters());
    log.out() << "going on from " << found->path << ", step " << found->facts.step
              << ", t = " << with_unit(found->facts.time, "s") << ", written by "
              << found->facts.n_ranks << (found->facts.n_ranks == 1 ? " rank\n" : " ranks\n");
    for (const std::string &change : changes)
      log.out() << "  changed     " << change << '\n';
    log.out() << std::endl;
    return found;
  }

  void run_loop(Loop &loop)
  {
    Interval write = loop.settings.output, statistics = loop.settings.statistics,
             line = loop.settings.log;
    loop.control.start_from(coupling.time(), coupling.step());
    for (bool told_before = bool(from);; told_before = false)
      {
        const double        t = coupling.time();
        const std::uint64_t n = coupling.step();
        // Each asks once a step, also where another one is due as well, and where all was told
        // before the checkpoint that the run goes on from.
        const Wanted due{write.due(t, n), statistics.due(t, n), line.due(t, n)};
        if (!told_before)
          tell(loop, due);
        const auto orders = loop.control.ask(t, n);
        const bool ended  = t >= end_time * (1 - 1e-14);
        if ((orders.checkpoint || (ended && loop.saving.by_itself)) && !told_before)
          save(loop, orders.stop);
        if (orders.stop || ended)
          {
            // Not of the state that is saved: a run that goes on has these where they are due.
            tell(loop, {true, true, true});
            if (!ended)
              loop.stopped_by = orders.reason;
            return;
          }
        coupling.advance(end_time);
      }
  }

  /// What is wanted and has not been told of this moment.
  void tell(Loop &loop, const Wanted &wanted)
  {
    const auto n    = static_cast<std::int64_t>(coupling.step());
    const bool row  = wanted.row && loop.output.step_of_row() != n;
    const bool line = wanted.line && loop.step_of_line != n;
    if (wanted.fields && loop.output.step_of_files() != n)
      coupling.timed("output", [&] { loop.output.write(coupling); });
    if (row || line)
      coupling.timed("report", [&] {
        // A report ends the time over which forces are means: one for a moment.
        if (loop.step_of_report != n)
          {
            loop.report         = loop.output.make_report(coupling);
            loop.step_of_report = n;
            check_while_running(loop.report, loop.settings.limits);
          }
        if (row)
          loop.output.write_statistics(loop.report, coupling);
        if (line)
          {
            loop.progress.line(loop.report);
            loop.step_of_line = n;
          }
        log.report();
      });
  }

  /// A run does not end because its state cannot be saved, but says so.
  void save(Loop &loop, const bool stopping)
  {
    const auto begin = std::chrono::steady_clock::now();
    try
      {
        coupling.timed("checkpoint", [&] {
          write_checkpoint(checkpoints, file.print(), coupling, loop.output, loop.saving.n_kept);
        });
      }
    catch (const RunFailure &failure)
      {
        if (stopping)
          loop.not_saved = failure.details;
        else if (mpi::rank(comm) == 0)
          log.warning("a checkpoint could not be written",
                      "step " + std::to_string(coupling.step()) + ": " + failure.details);
      }
    loop.control.checkpoint_written(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }

  void say_stopped(const Loop &loop, Verdict &verdict)
  {
    log.out() << "\nstopped by " << loop.stopped_by << " at t = " << with_unit(coupling.time(), "s")
              << ", before the end time\n";
    if (loop.not_saved.empty())
      {
        const unsigned int n = mpi::n_ranks(comm);
        log.out() << "go on with: " << (n > 1 ? "mpirun -q -n " + std::to_string(n) + " " : "")
                  << "coracle " << options.file << " --restart";
        for (const std::string &assignment : options.assignments)
          log.out() << " --set \"" << assignment << '"';
        log.out() << '\n';
      }
    else
      {
        verdict.outcome = Outcome::failed;
        verdict.reasons.push_back("the state could not be saved: " + loop.not_saved);
      }
    log.out() << std::endl;
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
    for (const auto &body : coupling.fluids.bodies)
      {
        const auto summary = body.summary();
        add("body",
            "'" + body.name() + "', meshless fluid: " + std::to_string(summary.n_points) +
              " points, " + std::to_string(summary.n_elements) + " elements, volume " +
              with_unit(summary.volume, dim == 2 ? "m^2" : "m^3"));
      }
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
  const std::string    directory_path;
  CheckpointFolder     checkpoints;
  /// What the run goes on from.
  const std::optional<CheckpointFolder::Saved> from;
  /// Open until it is loaded.
  std::unique_ptr<SavedState> saved;
  Coupling<dim>               coupling;
};

template <int dim>
int
run_case(const ParameterFile &file, const RunOptions &options, MPI_Comm comm)
{
  Simulation<dim> simulation(file, options, comm);
  if (options.check)
    return simulation.check();
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
  CheckpointSettings::declare(root.section(
    "Checkpoint",
    "When the whole state is saved, so that --restart goes on from there. Besides, "
    "SIGTERM, SIGINT (Ctrl-C) and the stop file save it and stop the run, SIGUSR1 saves "
    "it and lets the run go on."));
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
