// SPDX-License-Identifier: GPL-3.0-or-later
// What a contact costs, on one core, processor time.
//   contact_step [most contacts]
// prints the cost of each part of a step as a run goes on (contact_layer.h), for a thousand
// contacts up to a million, and memory.
//   contact_step --benchmark_filter=local
// runs single parts on two layers of particles that strike a wavy surface of n x n facets, 100 x
// 100 by default, four contacts a facet: search anew (global and local), local search with
// candidates that are kept, rows, solve, audit; and nearest points alone.
#include <benchmark/benchmark.h>

#include <deal.II/base/mpi.h>

#include "contact_layer.h"

#include <iomanip>
#include <iostream>
#include <random>

namespace
{
using namespace coracle::contact;

constexpr double size = 0.02;
constexpr double dt   = 1e-4;

double
height(const double x, const double y)
{
  return 0.1 * size * std::sin(9 * x) * std::cos(7 * y);
}

/// Everything that a step of contact needs: surface, points, and grid nodes as unknowns.
struct Scene
{
  const unsigned int                 n_facets;
  Surface<3>                         surface;
  std::array<std::vector<double>, 3> position, velocity;
  std::vector<PointSet<3>>           sets{1};
  std::vector<Unknown<3>>            unknowns;
  ContactSystem<3>                   contacts{ContactOptions(), MPI_COMM_SELF};

  explicit Scene(const unsigned int n_facets = 100) : n_facets(n_facets)
  {
    surface.bodies.resize(1);
    for (unsigned int j = 0; j <= n_facets; ++j)
      for (unsigned int i = 0; i <= n_facets; ++i)
        {
          SurfaceNode<3> node;
          node.position = dealii::Point<3>(i * size, j * size, height(i * size, j * size));
          node.key      = surface.nodes.size();
          for (unsigned int d = 0; d < 3; ++d)
            node.inverse_mass[d] = 1. / (7800 * 0.002 * size * size);
          surface.nodes.push_back(node);
        }
    for (unsigned int j = 0; j < n_facets; ++j)
      for (unsigned int i = 0; i < n_facets; ++i)
        {
          const unsigned int k = j * (n_facets + 1) + i;
          surface.facets.push_back(
            {{{k, k + 1, k + n_facets + 2, k + n_facets + 1}}, 0, surface.facets.size()});
        }
    add_points();
    contacts.find(surface, sets, dt);
    rows();
  }

  void add_points()
  {
    std::mt19937                     generator(1);
    std::uniform_real_distribution<> uniform(-0.05, 0.05);
    sets[0].constant_radius = 0.25 * size;
    for (unsigned int j = 0; j < n_facets; ++j)
      for (unsigned int i = 0; i < n_facets; ++i)
        {
          sets[0].group_begin.push_back(position[0].size());
          for (unsigned int k = 0; k < 8; ++k)
            {
              const double x = size * (i + 0.25 + 0.5 * (k & 1) + uniform(generator)),
                           y = size * (j + 0.25 + 0.5 * ((k >> 1) & 1) + uniform(generator)),
                           z = size * (0.245 + 0.5 * (k >> 2));
              position[0].push_back(x);
              position[1].push_back(y);
              position[2].push_back(z + height(x, y));
              velocity[0].push_back(0.);
              velocity[1].push_back(0.);
              velocity[2].push_back(-6.);
            }
        }
    sets[0].group_begin.push_back(position[0].size());
    sets[0].n_points = position[0].size();
    for (unsigned int d = 0; d < 3; ++d)
      {
        sets[0].position[d] = position[d].data();
        sets[0].velocity[d] = velocity[d].data();
      }
    for (unsigned int i = 0; i < 3 * (n_facets + 1) * (n_facets + 1); ++i)
      {
        Unknown<3> node;
        for (unsigned int d = 0; d < 3; ++d)
          node.inverse_mass[d] = 1. / (1000 * size * size * size);
        node.velocity[2] = -6 + 10 * uniform(generator);
        node.key         = 1000000 + i;
        unknowns.push_back(node);
      }
  }

  void rows()
  {
    contacts.build_rows(
      [this](const unsigned int, const unsigned int p, std::vector<Rows::Entry> &entries) {
        double       w[3];
        unsigned int cell[3];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double x = position[d][p] / size + (d == 2 ? 0.5 : 0.);
            cell[d]        = std::max(0., x);
            w[d]           = x - cell[d];
          }
        for (unsigned int k = 0; k < 8; ++k)
          entries.push_back(
            {((cell[2] + (k >> 2)) * (n_facets + 1) + cell[1] + ((k >> 1) & 1)) * (n_facets + 1) +
               cell[0] + (k & 1),
             (k & 1 ? w[0] : 1 - w[0]) * (k & 2 ? w[1] : 1 - w[1]) * (k & 4 ? w[2] : 1 - w[2])});
      },
      [this](const unsigned int i) { return unknowns[i]; });
  }

  void report(benchmark::State &state) const
  {
    state.counters["contacts"] = contacts.contacts().size();
    state.counters["time/contact"] =
      benchmark::Counter(double(state.iterations()) * contacts.contacts().size(),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  }
};

void
search_anew(benchmark::State &state)
{
  Scene scene;
  for (auto _ : state)
    {
      scene.contacts.points_renumbered();
      scene.contacts.find(scene.surface, scene.sets, dt);
    }
  scene.report(state);
}

void
local_search(benchmark::State &state)
{
  Scene scene;
  for (auto _ : state)
    {
      scene.contacts.find(scene.surface, scene.sets, 1e-9 * dt);
      benchmark::DoNotOptimize(scene.contacts.contacts().data());
    }
  state.counters["pairs"] = scene.contacts.report().n_candidates;
  scene.report(state);
}

void
rows(benchmark::State &state)
{
  Scene scene;
  for (auto _ : state)
    scene.rows();
  scene.report(state);
}

/// From scratch each time: the worst case, as at the moment of impact.
void
solve_impact(benchmark::State &state)
{
  Scene scene(state.range(1));
  for (auto _ : state)
    {
      ContactOptions options;
      options.tolerance           = std::pow(10., -double(state.range(0)));
      options.maximum_iterations  = 10000;
      options.position_correction = false;
      Solver<3>                               solver(options, MPI_COMM_SELF);
      std::vector<typename WarmStart<3>::Key> keys(scene.contacts.contacts().size());
      solver.solve(scene.contacts.contacts(),
                   keys,
                   scene.contacts.row_builder().rows(),
                   scene.contacts.row_builder().unknowns(),
                   {},
                   dt);
      state.counters["iterations"] = solver.report().velocity.iterations;
      state.counters["converged"]  = solver.report().velocity.converged;
    }
  scene.report(state);
}

/// The next step, when the impulses are about those of the last one.
void
solve_warm(benchmark::State &state)
{
  Scene scene;
  scene.contacts.solve({}, dt);
  for (auto _ : state)
    scene.contacts.solve({}, dt);
  state.counters["iterations"] = scene.contacts.report().solver.velocity.iterations;
  scene.report(state);
}

void
audit(benchmark::State &state)
{
  Scene scene;
  for (auto _ : state)
    scene.contacts.audit(scene.surface, scene.sets);
  scene.report(state);
}

/// Random points around random facets, warped by this many hundredths of their size.
void
nearest_points(benchmark::State &state)
{
  std::mt19937                                                              generator(1);
  std::uniform_real_distribution<>                                          uniform(-1, 1);
  std::vector<std::pair<dealii::Point<3>, std::array<dealii::Point<3>, 4>>> pairs(10000);
  const auto                                                                random = [&] {
    return dealii::Point<3>(uniform(generator), uniform(generator), uniform(generator));
  };
  for (auto &pair : pairs)
    {
      pair.first  = random();
      pair.second = {{dealii::Point<3>(-.5, -.5, 0),
                      dealii::Point<3>(.5, -.5, 0),
                      dealii::Point<3>(.5, .5, 0),
                      dealii::Point<3>(-.5, .5, 0)}};
      for (auto &vertex : pair.second)
        vertex += 0.01 * state.range(0) * random();
    }
  NearestPointBatch   batch;
  std::vector<double> squares(pairs.size());
  for (auto _ : state)
    {
      batch.find(
        pairs.size(),
        [&](const std::size_t i) { return relative_corners(pairs[i].first, pairs[i].second); },
        [&](const std::size_t i, const double, const double, const double square) {
          squares[i] = square;
        });
      benchmark::DoNotOptimize(squares.data());
    }
  state.counters["time/pair"] =
    benchmark::Counter(double(state.iterations()) * pairs.size(),
                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK(search_anew)->Unit(benchmark::kMillisecond);
BENCHMARK(local_search)->Unit(benchmark::kMillisecond);
BENCHMARK(rows)->Unit(benchmark::kMillisecond);
BENCHMARK(solve_impact)
  ->ArgNames({"digits", "n"})
  ->ArgsProduct({{3, 4, 6}, {16, 50, 158}})
  ->Args({4, 500})
  ->Unit(benchmark::kMillisecond);
BENCHMARK(solve_warm)->Unit(benchmark::kMillisecond);
BENCHMARK(audit)->Unit(benchmark::kMillisecond);
BENCHMARK(nearest_points)->Arg(0)->Arg(5)->Arg(30)->Arg(100)->Unit(benchmark::kMillisecond);
/// Resident memory of this process [bytes].
double
memory_now()
{
  dealii::Utilities::System::MemoryStats stats;
  dealii::Utilities::System::get_memory_stats(stats);
  return 1024. * stats.VmRSS;
}

void
print_header()
{
  std::cout << "Nanoseconds a contact and step; search: candidates kept / looked for anew every\n"
               "tenth step; iterations: mean / most; bytes a contact.\n\n"
            << std::setw(9) << "contacts" << std::setw(11) << "cand./cont." << std::setw(8)
            << "search" << std::setw(8) << "anew" << std::setw(8) << "rows" << std::setw(8)
            << "solve" << std::setw(8) << "check" << std::setw(8) << "audit" << std::setw(8)
            << "all" << std::setw(8) << "iter." << std::setw(6) << "most" << std::setw(9)
            << "unconv." << std::setw(8) << "bytes" << std::setw(9) << "through\n";
}

/// A line of the table.
void
contact_in_a_run(const unsigned int n_cells, const double friction, const unsigned int n_steps)
{
  coracle::benchmarks::ContactLayer layer({n_cells, friction});
  const double                      before = memory_now();
  // Until the layer lies on the plate.
  for (unsigned int k = 0; k < (n_cells < 300 ? 30 : 20); ++k)
    layer.step();
  layer.reset();
  for (unsigned int k = 0; k < n_steps; ++k)
    layer.step();
  const auto  &t      = layer.times;
  const auto   each   = [](const double time, const double n) { return 1e9 * time / n; };
  const double kept   = t.contacts - t.contacts_anew;
  const double all    = t.search + t.search_anew + t.rows + t.solve + t.check + t.audit;
  const auto  &report = layer.contacts.report();
  std::cout << std::setw(9) << std::lround(t.contacts / n_steps) << std::fixed
            << std::setprecision(1) << std::setw(11) << t.candidates / t.contacts
            << std::setprecision(0) << std::setw(8) << each(t.search, kept) << std::setw(8)
            << each(t.search_anew, t.contacts_anew) << std::setw(8) << each(t.rows, t.contacts)
            << std::setw(8) << each(t.solve, t.contacts) << std::setw(8)
            << each(t.check, t.contacts) << std::setw(8) << each(t.audit, t.contacts)
            << std::setw(8) << each(all, t.contacts) << std::setw(8) << t.iterations / n_steps
            << std::setw(6) << t.most_iterations << std::setw(9) << t.not_converged << std::setw(8)
            << (memory_now() - before) * n_steps / t.contacts << std::setw(8)
            << report.n_penetrations << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc <= 2 && (argc == 1 || argv[1][0] != '-'))
    {
      const double most = (argc == 2 ? std::stod(argv[1]) : 1e6);
      for (const double friction : {0., 0.2})
        {
          std::cout << "\nFriction " << std::defaultfloat << friction << ". ";
          print_header();
          for (const unsigned int n_cells : {16, 50, 158, 500})
            if (4. * n_cells * n_cells <= (friction == 0 ? most : std::min(most, 1e5)))
              contact_in_a_run(n_cells, friction, n_cells < 100 ? 60 : n_cells < 300 ? 40 : 10);
        }
      return 0;
    }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
