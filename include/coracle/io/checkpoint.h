// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/checkpoint_folder.h>
#include <coracle/io/coupling_output.h>

namespace coracle
{
/// Names inside the folder of a checkpoint.
std::string octree_of(const CheckpointFolder::Saved &saved);
std::string parameters_of(const CheckpointFolder::Saved &saved);

/**
 * The whole state of a run, with what has been written of it so far, as one
 * more checkpoint: octree (p4est), one HDF5 file of each rank, parameters.
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
 * Take the state of a checkpoint. The coupling has been built on its octree.
 * As many ranks as have saved it go on exactly as they would have; others get
 * the same particles, nodes and elements.
 * Collective; throws RunFailure.
 *
 * @param output may be null
 */
template <int dim>
void load_checkpoint(const CheckpointFolder::Saved &saved,
                     Coupling<dim>                 &coupling,
                     CouplingOutput<dim>           *output);
} // namespace coracle
