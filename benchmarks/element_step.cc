// SPDX-License-Identifier: GPL-3.0-or-later
// Nanoseconds an element-step: one whole step of the structure (forces, velocities, positions,
// stresses) of hexahedra in a vibrating block, on one core.
//   element_step --benchmark_filter=one_point
#include <benchmark/benchmark.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>

#include <coracle/structure/solid_body.h>

#include <memory>

namespace
{
using namespace coracle;

/// A block of n^3 hexahedra, a little distorted by its motion.
std::unique_ptr<SolidBody<3>>
block(const std::string &integration, const std::string &model, const int n)
{
  Declaration declaration;
  MaterialLibrary::declare(declaration);
  SolidBody<3>::declare(declaration.named_sections("Bodies", "body", "All bodies"));
  ParameterFile file(declaration);
  file.read_text("subsection Materials\n subsection solid\n set Model = " + model +
                 "\n end\nend\nsubsection Bodies\n subsection block\n"
                 "  set Material = solid\n  set Integration = " +
                 integration + "\n  subsection Mesh\n   set Subdivisions = " + std::to_string(n) +
                 "\n  end\n  subsection Loads\n   subsection stretching\n"
                 "    set Type = acceleration\n    set Acceleration = 1e6*(x-0.5); 1e6*x*y; z\n"
                 "   end\n  end\n end\nend\n");
  const Parameters root = file.parameters();
  return std::make_unique<SolidBody<3>>(root.section("Bodies").section("block"),
                                        MaterialLibrary(root),
                                        dealii::Tensor<1, 3>(),
                                        MPI_COMM_WORLD);
}

void
whole_step(benchmark::State &state, const std::string &integration, const std::string &model)
{
  const auto   body = block(integration, model, state.range(0));
  const double dt   = 0.5 * body->stable_time_step();
  body->assemble_forces(0.);
  for (auto _ : state)
    {
      body->predict_velocities(dt);
      body->move(dt);
      body->update_stress(dt);
    }
  state.counters["elements"] = body->mesh().n_elements();
  state.counters["time/element-step"] =
    benchmark::Counter(double(state.iterations()) * body->mesh().n_elements(),
                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(whole_step, one_point_linear_elastic, "one point", "linear elastic")
  ->Arg(20)
  ->Arg(60)
  ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_step, full_linear_elastic, "full", "linear elastic")
  ->Arg(20)
  ->Arg(60)
  ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_step, one_point_neo_hookean, "one point", "neo-Hookean")
  ->Arg(20)
  ->Arg(60)
  ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_step, full_neo_hookean, "full", "neo-Hookean")
  ->Arg(20)
  ->Arg(60)
  ->Unit(benchmark::kMillisecond);
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
