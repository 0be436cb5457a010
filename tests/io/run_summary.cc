// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics read back bit by bit; probes find the same node on any partition; each verdict has its
// reason and code.
#include <coracle/base/exceptions.h>
#include <coracle/io/output_settings.h>
#include <coracle/io/probes.h>
#include <coracle/io/progress.h>
#include <coracle/io/text.h>

#include <functional>
#include <sstream>

#include "tests.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

std::vector<std::string>
lines_of(const std::string &file_name)
{
  std::vector<std::string> lines;
  std::ifstream            file(file_name);
  for (std::string line; std::getline(file, line);)
    lines.push_back(line);
  return lines;
}

void
test_statistics()
{
  Statistics statistics("round_trip.csv", comm);
  statistics.add_column("time", "s");
  statistics.add_column("step", "");
  statistics.add_column("a, \"b\".mass", "kg");
  const std::vector<double> values = {1. / 3, 12345678901., -4.9406564584124654e-324};
  for (const double factor : {1., -1.})
    {
      statistics.begin_row();
      // Any order, by name.
      statistics.set("a, \"b\".mass", factor * values[2]);
      statistics.set("step", factor * values[1]);
      statistics.set("time", factor * values[0]);
      statistics.end_row();
    }
  MPI_Barrier(comm);
  const auto lines = lines_of("round_trip.csv");
  deallog << "header: " << lines[0] << std::endl;
  bool exact = (lines.size() == 3);
  for (unsigned int row = 1; row < lines.size(); ++row)
    {
      std::istringstream line(lines[row]);
      std::string        text;
      for (const double value : values)
        {
          std::getline(line, text, ',');
          exact = exact && std::strtod(text.c_str(), nullptr) == (row == 1 ? value : -value);
        }
    }
  deallog << "numbers come back exactly: " << exact << std::endl;

  statistics.begin_row();
  statistics.set("time", 0);
  for (const auto &mistake :
       std::vector<std::function<void()>>{[&] { statistics.set("tmie", 0); },
                                          [&] { statistics.set("time", 0); },
                                          [&] { statistics.end_row(); },
                                          [&] { statistics.add_column("late", ""); }})
    try
      {
        mistake();
        deallog << "a programming error was passed over" << std::endl;
      }
    catch (const dealii::ExceptionBase &)
      {
        deallog << "programming error caught" << std::endl;
      }
}

Report<2>
good_report()
{
  Report<2> report;
  report.time                 = 0.015;
  report.step                 = 1200;
  report.dt                   = 1.25e-5;
  report.contacts             = 37;
  report.worst_gap            = -2.5e-5;
  report.contact_steps        = 1000;
  report.particles_created    = 100;
  report.particles_removed    = 4;
  report.particles            = 96;
  report.energies.kinetic     = 90;
  report.energies.contact     = 10;
  report.energy_balance_error = 0.001;
  report.bodies               = {{"wedge", 241, {1, 1.2}, {}, {}}};
  return report;
}

void
test_verdict()
{
  const auto show = [](const std::string &what, const std::function<void(Report<2> &)> &change) {
    Report<2> report = good_report();
    change(report);
    const Verdict verdict = judge(report, VerdictLimits());
    deallog << what << ": exit code " << verdict.exit_code() << ", " << verdict.text() << std::endl;
  };
  show("good", [](auto &) {});
  show("penetration", [](auto &r) { r.penetrations = 2; });
  show("ledger", [](auto &r) { r.particles_removed = 3; });
  show("gain", [](auto &r) { r.energy_balance_error = 0.03; });
  show("loss", [](auto &r) { r.energy_balance_error = -0.2; });
  show("small loss", [](auto &r) { r.energy_balance_error = -0.05; });
  show("unconverged", [](auto &r) { r.unconverged_contact_steps = 11; });
  show("not a number", [](auto &r) { r.bodies[0].velocity[1] = std::nan(""); });
  show("two reasons", [](auto &r) {
    r.unconverged_contact_steps = 11;
    r.penetrations              = 1;
  });
  const Verdict broken = judge_broken_run("the time step collapsed", good_report(), {});
  deallog << "broken: exit code " << broken.exit_code() << ", " << broken.text() << std::endl;

  // Falling freely: what is gained in motion came in as external work.
  EnergyBalance balance;
  EnergyBooks   energies;
  balance.start(energies);
  energies.kinetic = energies.external_work = 8;
  deallog << "free fall balanced: " << (balance.error(energies) == 0);
  energies.kinetic = 9;
  deallog << ", error 1 of 9: " << balance.error(energies) * 9 << std::endl;
}

void
test_progress()
{
  deallog << with_prefix(2.4e-3, "s") << " | " << with_prefix(999.96, "m") << " | "
          << with_prefix(0, "N") << " | " << with_prefix(-3.1e6, "Pa") << " | " << clock_time(42)
          << " | " << clock_time(4210) << " | " << clock_time(-1) << std::endl;
  std::ostringstream text;
  Progress           progress(text, 0.025);
  progress.header("Coracle, water entry", {{"particles", "40,000"}, {"end time", "25 ms"}});
  progress.line(good_report());
  progress.summary(good_report(), judge(good_report(), {}), "output/water_entry");
  std::istringstream lines(text.str());
  for (std::string line; std::getline(lines, line);)
    if (line.find("(h:mm:ss)") == std::string::npos)
      deallog << line << std::endl;

  Interval    interval(0.1, 4);
  std::string due;
  for (unsigned int step = 0; step < 10; ++step)
    due += (interval.due(0.03 * step, step) ? '1' : '0');
  deallog << "due each 4 steps and each 0.1 s of steps of 0.03 s: " << due << std::endl;
}

// Nine nodes on a circle around the probe's place, dealt out to ranks in turn, plus the particles.
void
test_probes()
{
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(comm);
  const unsigned int n    = dealii::Utilities::MPI::n_mpi_processes(comm);

  ParameterFile file([] {
    static Declaration root;
    ProbeDescription<2>::declare(root);
    OutputSettings::declare(root.section("Output", "Results"));
    return std::ref(root);
  }());
  file.read_text("subsection Probes\n"
                 "  subsection tip\n    set Body = obstacle\n    set Position = 1, 2\n  end\n"
                 "  subsection gauge\n    set Kind = point\n    set Body = water\n"
                 "    set Position = 0, 0\n    set Radius = 0.5\n  end\n"
                 "end\n");
  const Parameters root = file.parameters();
  const auto       probes =
    ProbeDescription<2>::read(root.section("Probes"), {"obstacle"}, {"water"}, {});
  const bool  first_is_tip = (probes[0].name == "tip");
  const auto &tip          = probes[first_is_tip ? 0 : 1];
  const auto &gauge        = probes[first_is_tip ? 1 : 0];

  std::vector<dealii::Point<2>> reference, current, velocity;
  std::vector<std::uint64_t>    keys;
  for (unsigned int i = 0; i < 9; ++i)
    if (n == 1 || rank == 2 * (i % 2))
      {
        const double angle = 2 * M_PI * i / 9 + 0.1;
        reference.emplace_back(1 + 0.3 * std::cos(angle), 2 + 0.3 * std::sin(angle));
        current.push_back(reference.back() + dealii::Tensor<1, 2>({0.5 + i, -0.25}));
        velocity.emplace_back(10. * i, 1.);
        keys.push_back(100 - 7 * i);
      }
  NodeView nodes;
  nodes.n_nodes   = reference.size();
  nodes.reference = vector_field("reference", "m", reference);
  nodes.current   = vector_field("current", "m", current);
  nodes.velocity  = vector_field("velocity", "m/s", velocity);
  nodes.keys      = keys.data();
  const BodyPointProbe<2> probe(tip, nodes, comm);
  deallog << "probe node " << probe.key() << " at a distance of " << probe.distance() << std::endl;

  // Two particles inside the radius, of 1 and 3 kg, on different ranks; one outside.
  std::vector<dealii::Point<2>> positions, velocities;
  std::vector<double>           mass, pressure;
  const auto add = [&](const unsigned int owner, const double x, const double m, const double p) {
    if (rank != owner % n)
      return;
    positions.emplace_back(x, 0);
    velocities.emplace_back(p, 2);
    mass.push_back(m);
    pressure.push_back(p);
  };
  add(0, 0.5, 1, 100);
  add(2, -0.25, 3, 200);
  add(0, 0.51, 1000, 1e6);
  ParticleView particles;
  particles.n_particles = positions.size();
  particles.position    = vector_field("position", "m", positions);
  particles.velocity    = vector_field("velocity", "m/s", velocities);
  particles.mass        = mass.data();
  particles.pressure    = pressure.data();
  const PointProbe<2> samples(gauge, comm);

  Statistics statistics("probes.csv", comm);
  BodyPointProbe<2>::add_columns(tip, statistics);
  PointProbe<2>::add_columns(gauge, statistics);
  for (const std::size_t n_particles : {particles.n_particles, std::size_t(0)})
    {
      particles.n_particles = n_particles;
      statistics.begin_row();
      probe.set_columns(nodes, statistics);
      samples.set_columns(particles, statistics);
      statistics.end_row();
    }
  MPI_Barrier(comm);
  for (const std::string &line : lines_of("probes.csv"))
    deallog << line << std::endl;

  for (const std::string bad : {"Body = water",
                                "Kind = point\nset Body = obstacle",
                                "Body = obstacle",
                                "Kind = surface\nset Body = water",
                                "Kind = point\nset Body = water\nset Position = 1, 1"})
    {
      file.read_text("subsection Probes\nsubsection tip\nset " + bad + "\nend\nend\n");
      try
        {
          ProbeDescription<2>::read(file.parameters().section("Probes"),
                                    {"obstacle"},
                                    {"water"},
                                    {"oil"});
          deallog << "a wrong probe was passed over" << std::endl;
        }
      catch (const UserError &error)
        {
          deallog << error.title << "; " << error.found << "; " << error.cure << std::endl;
        }
    }
  const OutputSettings settings = OutputSettings::read(root.section("Output"), 1.);
  deallog << "defaults: hdf5 " << settings.particles.hdf5 << ", vtu " << settings.particles.vtu
          << ", octree " << settings.octree << ", gain " << settings.limits.energy_gain
          << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test_statistics();
  test_verdict();
  test_progress();
  test_probes();
}
