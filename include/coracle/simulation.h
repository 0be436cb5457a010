// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <coracle/base/parameters.h>

#include <string>
#include <vector>

namespace coracle
{
/// What the command line asks for.
struct RunOptions
{
  std::string              file;
  std::vector<std::string> assignments;
  /// Read everything, build everything, print sizes and estimates, run nothing.
  bool check = false;
  /// Go on from the newest checkpoint.
  bool restart = false;
};

/// Every section of a parameter file, from all rooms.
void declare_parameters(Declaration &root);

/**
 * Set up and run a case. Collective.
 * @return exit code: 0 OK, 1 SUSPECT, 3 FAILED; user mistakes are thrown as UserError
 */
int run(const RunOptions &options, MPI_Comm communicator);
} // namespace coracle
