// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/checkpoint_folder.h>
#include <coracle/io/coupling_output.h>
#include <coracle/io/hdf5_archive.h>

namespace coracle
{
/// The parameters as used, inside the folder of a checkpoint.
std::string parameters_of(const CheckpointFolder::Saved &saved);

/// The state in a checkpoint, opened for reading by all ranks.
struct SavedState
{
  SavedState(const CheckpointFolder::Saved &saved, MPI_Comm comm);

  Hdf5Archive store;
  Archive     archive;
};

/**
 * The whole state of a run, with what has been written of it so far, as one
 * more checkpoint: one HDF5 file of each rank, octree included, and the parameters.
 * Collective; throws RunFailure on all ranks, and then nothing of it is left.
 *
 * @param parameters the case as used
 */
template <int dim>
void write_checkpoint(CheckpointFolder    &folder,
                      const std::string   &parameters,
                      Coupling<dim>       &coupling,
                      CouplingOutput<dim> &output,
                      const unsigned int   n_kept);

/**
 * Take the state of a checkpoint. The coupling has been built on its octree, see Coupling.
 * As many ranks as have saved it go on exactly as they would have; others get
 * the same particles, nodes and elements.
 * Collective; throws RunFailure.
 *
 * @param output may be null
 */
template <int dim>
void load_checkpoint(SavedState &saved, Coupling<dim> &coupling, CouplingOutput<dim> *output);
} // namespace coracle
