// SPDX-License-Identifier: GPL-3.0-or-later
// No point passes through a surface in random scenes: sheets and closed bodies that rest, move,
// turn, swing and fly, folds, junctions, slivers, needles, twisted facets, closing plates, points
// on the surface at the start, speeds from 1 to 3000 m/s (benchmarks/contact_trials runs any number
// of them).

#include "trial_run.h"

#include "../tests.h"

template <int dim>
void
run(const unsigned long first, const unsigned long last, const bool any_shape = false)
{
  trial::Outcome sum;
  for (unsigned long seed = first; seed <= last; ++seed)
    {
      trial::Scene<dim> scene(seed, any_shape ? -1 : int(seed % trial::n_shapes), MPI_COMM_WORLD);
      const auto        outcome = scene.run();
      sum.crossings += outcome.crossings;
      sum.contacts += outcome.contacts;
      if (outcome.crossings > 0)
        deallog << "seed " << seed << ": " << outcome.crossings << " crossings" << std::endl;
    }
  deallog << dim << "-D: crossings " << sum.crossings << ", enough contacts "
          << (sum.contacts > 1000 * (last - first)) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  run<2>(1, 8);
  run<3>(1, 2);
  // A point on the edge of a fold of six degrees, on its inner side.
  run<3>(949, 949, true);
}
