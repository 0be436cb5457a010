// SPDX-License-Identifier: GPL-3.0-or-later
// Structures that fly into each other, and are moved on by ways that contact has not foreseen, lose
// no node through a facet, on any number of ranks; without the continuous check they lose many.

#include "node_trials.h"

#include "../tests.h"

template <int dim>
void
run(const unsigned long last)
{
  std::array<trial::Outcome, 2> sum;
  for (unsigned long seed = 1; seed <= last; ++seed)
    for (unsigned int check = 0; check < 2; ++check)
      {
        trial::NodeScene<dim> scene(seed, check, MPI_COMM_WORLD);
        const auto            outcome = scene.run();
        sum[check].crossings += outcome.crossings;
        sum[check].resolved += outcome.resolved;
        sum[check].failed += outcome.failed;
        if (check && outcome.crossings > 0)
          deallog << "seed " << seed << ": " << outcome.crossings << " crossings" << std::endl;
      }
  deallog << dim << "-D: crossings without the check " << (sum[0].crossings > last) << ", with it "
          << sum[1].crossings << ", ends changed " << (sum[1].resolved > last) << ", failed "
          << sum[1].failed << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog << std::boolalpha;
  run<2>(4);
  run<3>(1);
}
