// SPDX-License-Identifier: GPL-3.0-or-later
// The whole particle step (3-D, water, linear shape functions, FLIP-MUSL, 8 particles a cell)
// beside the bare kernel of bare_kernel.h, with and without hanging nodes, and deal.II's particle
// handler doing the same locating and sorting. Whole-run figures: mpirun -n N particle_step [cells
// per metre] [steps]
#include <deal.II/base/mpi.h>

#include <deal.II/fe/mapping_q1.h>

#include <deal.II/particles/particle_handler.h>

#include <coracle/base/mpi.h>
#include <coracle/coupling/coupling.h>

#include "bare_kernel.h"

#include <iomanip>
#include <iostream>
#include <sstream>

namespace coracle::benchmarks
{
constexpr double sound_speed = 20;

double
now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string
case_text(const unsigned int n, const bool hanging_nodes)
{
  std::ostringstream prm;
  // Some air above, a whole number of coarse cells.
  const double height = 1. + 2. * ((n / 4 + 1) / 2) / n;
  prm << "subsection Grid\n  set Upper corner = 1, 1, " << height
      << "\n  set Lower corner = 0, 0, 0\n"
      << "  set Cell size = " << (hanging_nodes ? 2. : 1.) / n << "\n";
  // Half of the water in fine cells of 8 particles, half in coarse ones of 64, hanging nodes
  // between.
  if (hanging_nodes)
    prm << "  subsection Refinement\n    subsection half\n      set Lower corner = 0, 0, 0\n"
        << "      set Upper corner = 0.5, 1, 1\n      set Level = 1\n    end\n  end\n";
  prm
    << "end\nsubsection Materials\n  subsection water\n    set Model = weakly compressible\n"
    << "    set Sound speed = " << sound_speed << "\n  end\nend\n"
    << "subsection Bodies\n  subsection water\n    set Material = water\n    set Shape = box\n"
    << "    set Lower corner = 0, 0, 0\n    set Upper corner = 1, 1, 1\n    set Particle spacing = "
    << 0.5 / n << "\n  end\nend\n";
  return prm.str();
}

struct Figures
{
  double gather = 0, predict = 0, move = 0, stress = 0, locate = 0, ledger = 0, bytes = 0,
         n_particles = 0;
  double total() const { return gather + predict + move + stress + locate + ledger; }
};

Figures
whole_step(const unsigned int n, const unsigned int n_steps, const bool hanging_nodes)
{
  Declaration root;
  Coupling<3>::declare(root);
  ParameterFile file(root);
  file.read_text(case_text(n, hanging_nodes));
  const Parameters      parameters = file.parameters();
  const MaterialLibrary materials(parameters);
  dealii::Tensor<1, 3>  gravity;
  gravity[2] = -9.81;
  MaterialPointSystem<3> points(parameters, materials, gravity, {}, MPI_COMM_WORLD);

  const double dt = 0.3 / n / sound_speed;
  Figures      seconds;
  double       time = 0;
  for (unsigned int s = 0; s < n_steps + 10; ++s)
    {
      if (s == 10)
        seconds = Figures();
      double     last  = now();
      const auto timed = [&last](double &sum) {
        const double t = now();
        sum += t - last;
        last = t;
      };
      points.gather(time, dt);
      timed(seconds.gather);
      points.predict(dt);
      timed(seconds.predict);
      points.move(dt);
      timed(seconds.move);
      points.update_stresses(time, dt);
      timed(seconds.stress);
      points.locate(time);
      timed(seconds.locate);
      points.ledger_error();
      timed(seconds.ledger);
      time += dt;
    }
  seconds.n_particles = mpi::sum<double>(points.n_particles(), MPI_COMM_WORLD);
  const double per    = 1e9 / seconds.n_particles / n_steps;
  for (double *const figure : {&seconds.gather,
                               &seconds.predict,
                               &seconds.move,
                               &seconds.stress,
                               &seconds.locate,
                               &seconds.ledger})
    *figure = mpi::max(*figure * per, MPI_COMM_WORLD);
  seconds.bytes =
    mpi::sum<double>(points.memory_consumption(), MPI_COMM_WORLD) / seconds.n_particles;
  return seconds;
}

/// deal.II's handler: move a third of a cell a tenth of the particles' way, find cells, sort.
double
dealii_locate_and_sort(const unsigned int n)
{
  dealii::parallel::distributed::Triangulation<3> triangulation(MPI_COMM_WORLD);
  dealii::GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                    {n, n, n + n / 4},
                                                    {0, 0, 0},
                                                    {1, 1, 1.25});
  const dealii::MappingQ1<3>            mapping;
  dealii::Particles::ParticleHandler<3> particles(triangulation, mapping);
  std::vector<dealii::Point<3>>         reference;
  for (unsigned int p = 0; p < 8; ++p)
    reference.emplace_back(0.25 + 0.5 * (p & 1), 0.25 + 0.5 * (p >> 1 & 1), 0.25 + 0.5 * (p >> 2));
  dealii::types::particle_index id = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->center()[2] < 1)
      for (const auto &xi : reference)
        particles.insert_particle(mapping.transform_unit_to_real_cell(cell, xi), xi, id++, cell);
  particles.update_cached_numbers();
  constexpr unsigned int n_steps = 5;
  double                 seconds = 0;
  for (unsigned int s = 0; s < n_steps; ++s)
    {
      for (auto &particle : particles)
        {
          auto x = particle.get_location();
          x[0] += (x[0] < 0.5 ? 0.03 : -0.03) / n;
          particle.set_location(x);
        }
      const double start = now();
      particles.sort_particles_into_subdomains_and_cells();
      seconds += now() - start;
    }
  return seconds * 1e9 / n_steps / particles.n_global_particles();
}

void
print(const std::string &name, const Figures &f)
{
  std::cout << std::left << std::setw(28) << name << std::right << std::fixed
            << std::setprecision(1) << std::setw(8) << f.total() << " ns   gather " << f.gather
            << ", predict " << f.predict << ", move " << f.move << ", stress " << f.stress
            << ", locate and sort " << f.locate << ", ledger " << f.ledger << ";  "
            << std::setprecision(0) << f.bytes << " bytes a particle" << std::endl;
}
} // namespace coracle::benchmarks

int
main(int argc, char **argv)
{
  using namespace coracle;
  using namespace coracle::benchmarks;
  dealii::Utilities::MPI::MPI_InitFinalize session(argc, argv, 1);
  const unsigned int                       n       = argc > 1 ? std::atoi(argv[1]) : 50;
  const unsigned int                       n_steps = argc > 2 ? std::atoi(argv[2]) : 50;
  const bool                               prints  = mpi::rank(MPI_COMM_WORLD) == 0;

  const double  bare    = mpi::n_ranks(MPI_COMM_WORLD) == 1 ? BareKernel(n).run(n_steps) : 0;
  const Figures uniform = whole_step(n, n_steps, false), hanging = whole_step(n, n_steps, true);
  const double  theirs = dealii_locate_and_sort(n);
  if (!prints)
    return 0;
  std::cout << uniform.n_particles << " particles, " << mpi::n_ranks(MPI_COMM_WORLD)
            << " rank(s), per particle-step:\n";
  if (bare > 0)
    std::cout << std::left << std::setw(28) << "bare kernel" << std::right << std::fixed
              << std::setprecision(1) << std::setw(8) << bare << " ns\n";
  print("whole step", uniform);
  print("whole step, hanging nodes", hanging);
  std::cout << std::setprecision(2);
  if (bare > 0)
    std::cout << "whole step / bare kernel            " << uniform.total() / bare << "\n";
  std::cout << "hanging nodes / none                " << hanging.total() / uniform.total() << "\n"
            << "particle steps per second           " << 1e3 / uniform.total() << " M\n"
            << "ParticleHandler's sort / locate     " << theirs / uniform.locate << "   (" << theirs
            << " ns)\n";
}
