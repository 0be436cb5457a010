// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <coracle/base/parameters.h>

#include <set>
#include <string>

namespace coracle
{
/**
 * The folder a run writes to:
 *
 *   parameters.prm  log.txt  statistics.csv  NAME.xdmf  NAME.pvd  data/
 *
 * Files to open lie at the top, the heavy ones they refer to in data/. Rank 0
 * creates it; results of an earlier run in the same folder are written over.
 *
 * A folder that can't be created or written is a UserError, the same on all
 * ranks, before the first step.
 */
class OutputDirectory
{
public:
  /// `Output/Directory`, or output/NAME for a case file NAME.prm if that is not set. Collective.
  /// @param goes_on what an earlier run left stays
  OutputDirectory(const Parameters  &output_section,
                  const std::string &case_file,
                  MPI_Comm           communicator,
                  const bool         goes_on = false);

  /// The folder's name as above.
  static std::string choose(const Parameters &output_section, const std::string &case_file);

  /// A given folder. Collective.
  OutputDirectory(const std::string &path, MPI_Comm communicator);

  const std::string &path() const { return directory; }
  MPI_Comm           communicator() const { return comm; }

  /// Full name of a file at the top.
  std::string file(const std::string &name) const { return directory + "/" + name; }

  /**
   * The file name part for a time series of this name; a second series that
   * would write the same files (a body called "octree", or bodies "a/b" and
   * "a_b") is a UserError. Removes what an earlier run left of it, unless
   * this run goes on from that. Collective.
   */
  std::string claim(const std::string &series_name);

  /// `parameters.prm`: the case as used, the same text on all ranks. Collective; RunFailure if it
  /// fails.
  void write_parameters(const std::string &text) const;

private:
  /// Empty, or why the folder can't be used; the same on all ranks.
  std::string create() const;

  std::string           directory;
  MPI_Comm              comm;
  const bool            goes_on = false;
  std::set<std::string> claimed;
};
} // namespace coracle
