// SPDX-License-Identifier: GPL-3.0-or-later
// Random trials of contact: scenes drawn from seeds, on as many ranks as mpirun gives.
//   mpirun -n 3 contact_trials --seeds 1:1000 [--shape 4] [--dim 2] [--verbose]
//   mpirun -n 3 contact_trials --nodes --seeds 1:1000 [--dim 2] [--verbose] [--without-check]
// --nodes: structures that fly into each other, else material points and surfaces.
// Prints each scene in which a point went through, and a table; exit code 1 if there was any.
#include <deal.II/base/mpi.h>

#include <iomanip>
#include <iostream>
#include <map>

#include "../tests/contact/node_trials.h"
#include "../tests/contact/trial_run.h"

namespace
{
struct Choice
{
  unsigned long first = 1, last = 100;
  int           shape = -1, dim = 0;
  bool          verbose = false, nodes = false, check = true;
};

Choice
read(const int argc, char **argv)
{
  Choice choice;
  for (int i = 1; i < argc; ++i)
    {
      const std::string name = argv[i], value = (i + 1 < argc ? argv[i + 1] : "");
      if (name == "--seeds")
        {
          const auto colon = value.find(':');
          choice.first     = std::stoul(value);
          choice.last =
            (colon == std::string::npos ? choice.first : std::stoul(value.substr(colon + 1)));
        }
      else if (name == "--shape")
        choice.shape = std::stoi(value);
      else if (name == "--dim")
        choice.dim = std::stoi(value);
      else if (name == "--verbose")
        choice.verbose = true;
      else if (name == "--nodes")
        choice.nodes = true;
      else if (name == "--without-check")
        choice.check = false;
    }
  return choice;
}

using Table = std::map<std::string, std::pair<unsigned, trial::Outcome>>;

void
report(const unsigned long   seed,
       const std::string    &name,
       const std::string    &description,
       const trial::Outcome &outcome,
       const bool            verbose,
       Table                &table)
{
  auto &row = table[name];
  ++row.first;
  row.second.points += outcome.points;
  row.second.steps += outcome.steps;
  row.second.contacts += outcome.contacts;
  row.second.crossings += outcome.crossings;
  row.second.unconverged += outcome.unconverged;
  row.second.resolved += outcome.resolved;
  row.second.failed += outcome.failed;
  const bool first = (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);
  if (first && (outcome.crossings > 0 || verbose))
    std::cout << "seed " << seed << ": crossings " << outcome.crossings << ", resolved "
              << outcome.resolved << ", failed " << outcome.failed << ", unconverged "
              << outcome.unconverged << "; " << description << std::endl;
}

template <int dim>
void
run(const unsigned long seed, const Choice &choice, Table &table)
{
  const std::string prefix = std::to_string(dim) + "-D ";
  if (choice.nodes)
    {
      trial::NodeScene<dim> scene(seed, choice.check, MPI_COMM_WORLD);
      const auto            outcome = scene.run();
      report(seed, prefix + "structures", scene.description(), outcome, choice.verbose, table);
      return;
    }
  trial::Scene<dim> scene(seed, choice.shape, MPI_COMM_WORLD);
  scene.verbose      = choice.verbose;
  const auto outcome = scene.run();
  report(seed, prefix + scene.name, scene.description(), outcome, choice.verbose, table);
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Choice                             choice = read(argc, argv);
  Table                                    table;
  for (unsigned long seed = choice.first; seed <= choice.last; ++seed)
    {
      const bool plane = (choice.dim == 2 || (choice.dim == 0 && seed % 2 == 0));
      if (plane)
        run<2>(seed, choice, table);
      else
        run<3>(seed, choice, table);
    }
  unsigned long all = 0;
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    {
      std::cout << "scenes              runs    steps   contacts  resolved    failed unconverged "
                   "crossings\n";
      for (const auto &[name, row] : table)
        std::cout << std::left << std::setw(16) << name << std::right << std::setw(8) << row.first
                  << std::setw(9) << row.second.steps << std::setw(11) << row.second.contacts
                  << std::setw(10) << row.second.resolved << std::setw(10) << row.second.failed
                  << std::setw(12) << row.second.unconverged << std::setw(10)
                  << row.second.crossings << '\n';
    }
  for (const auto &entry : table)
    all += entry.second.second.crossings;
  return all > 0;
}
