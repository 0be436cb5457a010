// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/checkpoint.h>
#include <coracle/io/disk.h>
#include <coracle/io/hdf5_archive.h>
#include <coracle/io/text.h>

namespace coracle
{
namespace
{
const std::string parameters_name = "parameters.prm";

std::string
state_name(const unsigned int rank)
{
  return "state." + six_digits(rank) + ".h5";
}

/// Of each rank that saved.
std::vector<std::string>
states_of(const CheckpointFolder::Saved &saved)
{
  std::vector<std::string> files;
  for (unsigned int part = 0; part < saved.facts.n_ranks; ++part)
    files.push_back(saved.path + "/" + state_name(part));
  return files;
}
} // namespace

std::string
parameters_of(const CheckpointFolder::Saved &saved)
{
  return saved.path + "/" + parameters_name;
}

SavedState::SavedState(const CheckpointFolder::Saved &saved, MPI_Comm comm)
  : store(states_of(saved))
  , archive(store, Archive::Mode::load, mpi::rank(comm), mpi::n_ranks(comm))
{}

template <int dim>
void
write_checkpoint(CheckpointFolder    &folder,
                 const std::string   &parameters,
                 Coupling<dim>       &coupling,
                 CouplingOutput<dim> &output,
                 const unsigned int   n_kept)
{
  const Octree<dim> &octree = coupling.points.octree;
  const MPI_Comm     comm   = octree.triangulation.get_communicator();
  const unsigned int rank = mpi::rank(comm), n_ranks = mpi::n_ranks(comm);
  try
    {
      const std::string        path = folder.begin(coupling.step()) + "/";
      std::vector<std::string> files{state_name(rank)};
      Hdf5Archive              store;
      Archive                  archive(store, Archive::Mode::save, rank, n_ranks);
      octree.save(archive);
      coupling.serialize(archive);
      output.serialize(archive);
      mpi::agree(
        [&] {
          write_durable(path + files[0], store.image());
          if (rank != 0)
            return;
          files.push_back(parameters_name);
          write_durable(path + parameters_name, {parameters.begin(), parameters.end()});
        },
        comm);
      folder.commit({dim, n_ranks, coupling.step(), coupling.time()}, files, n_kept);
    }
  catch (const RunFailure &)
    {
      folder.abandon();
      throw;
    }
}

template <int dim>
void
load_checkpoint(SavedState &saved, Coupling<dim> &coupling, CouplingOutput<dim> *output)
{
  coupling.serialize(saved.archive);
  if (output != nullptr)
    output->serialize(saved.archive);
}

#define INSTANTIATE(dim)                                \
  template void write_checkpoint(CheckpointFolder &,    \
                                 const std::string &,   \
                                 Coupling<dim> &,       \
                                 CouplingOutput<dim> &, \
                                 const unsigned int);   \
  template void load_checkpoint(SavedState &, Coupling<dim> &, CouplingOutput<dim> *);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
