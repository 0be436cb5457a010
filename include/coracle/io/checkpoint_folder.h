// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace coracle
{
/**
 * The folder `checkpoints` of a run. Each checkpoint is a folder step_NNNNNNNNNN
 * that appears by being renamed when all its files are on the disk, so that at
 * any instant those that are there are whole. Its manifest.json says who wrote
 * it, when, and the size and CRC-32 of each file; the manifest has a CRC-32 too.
 */
class CheckpointFolder
{
public:
  /// Version of what is in a checkpoint; others are not read.
  static constexpr int format_version = 2;

  CheckpointFolder(const std::string &output_directory, MPI_Comm communicator);

  const std::string &path() const { return folder; }

  /// What a checkpoint is a checkpoint of.
  struct Facts
  {
    int           dimension = 0;
    unsigned int  n_ranks   = 0;
    std::uint64_t step      = 0;
    double        time      = 0;
  };

  /**
   * Collective. An empty folder to write files to; then commit() makes it a checkpoint, in the
   * place of one of the same step, and removes all but the newest n_kept; or abandon() removes it.
   * Both throw RunFailure on all ranks.
   */
  std::string begin(const std::uint64_t step);
  /// @param files that this rank wrote, names inside the folder
  void commit(const Facts &facts, const std::vector<std::string> &files, const unsigned int n_kept);
  void abandon();

  /// A checkpoint that was found good.
  struct Saved
  {
    std::string path;
    Facts       facts;
  };

  /**
   * Collective. The newest checkpoint of which every file is as it was written.
   * @param complaints a line for each newer one that is not
   */
  std::optional<Saved> newest_good(std::vector<std::string> &complaints) const;

  /// Collective. Move what an earlier run has left to checkpoints.old; true if there was anything.
  bool set_aside();

private:
  /// Folders of checkpoints, the newest first; on rank 0.
  std::vector<std::string> list() const;
  void                     remove_old(const unsigned int n_kept) const;
  /// Empty, or what is wrong; the same on all ranks.
  std::string check(const std::string &name, Facts &facts) const;

  const std::string folder;
  MPI_Comm          comm;
  std::string       current;
};
} // namespace coracle
