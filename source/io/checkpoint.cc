// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/checkpoint.h>
#include <coracle/io/disk.h>
#include <coracle/io/hdf5_archive.h>
#include <coracle/io/text.h>

#include <filesystem>

namespace coracle
{
namespace
{
const std::string octree_name = "octree.p4est", parameters_name = "parameters.prm";

std::string
state_name(const unsigned int rank)
{
  return "state." + six_digits(rank) + ".h5";
}

/// p4est ends the program where the disk refuses: find that out before, for the same bytes.
void
try_to_write(const std::string &name, const std::uint64_t size)
{
  write_durable(name, std::vector<char>(size));
  std::filesystem::remove(name);
}
} // namespace

std::string
octree_of(const CheckpointFolder::Saved &saved)
{
  return saved.path + "/" + octree_name;
}

std::string
parameters_of(const CheckpointFolder::Saved &saved)
{
  return saved.path + "/" + parameters_name;
}

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
      coupling.serialize(archive);
      output.serialize(archive);
      const std::uint64_t octree_size = octree.saved_size();
      mpi::agree(
        [&] {
          write_durable(path + files[0], store.image());
          if (rank != 0)
            return;
          files.insert(files.end(), {parameters_name, octree_name, octree_name + ".info"});
          write_durable(path + parameters_name, {parameters.begin(), parameters.end()});
          try_to_write(path + octree_name, octree_size);
        },
        comm);
      octree.save(path + octree_name);
      mpi::agree(
        [&] {
          if (rank == 0)
            for (const char *const ending : {"", ".info"})
              make_durable(path + octree_name + ending);
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
load_checkpoint(const CheckpointFolder::Saved &saved,
                Coupling<dim>                 &coupling,
                CouplingOutput<dim>           *output)
{
  const MPI_Comm           comm = coupling.points.octree.triangulation.get_communicator();
  std::vector<std::string> files;
  for (unsigned int part = 0; part < saved.facts.n_ranks; ++part)
    files.push_back(saved.path + "/" + state_name(part));
  Hdf5Archive store(files);
  Archive     archive(store, Archive::Mode::load, mpi::rank(comm), mpi::n_ranks(comm));
  coupling.serialize(archive);
  if (output != nullptr)
    output->serialize(archive);
}

#define INSTANTIATE(dim)                                         \
  template void write_checkpoint(CheckpointFolder &,             \
                                 const std::string &,            \
                                 Coupling<dim> &,                \
                                 CouplingOutput<dim> &,          \
                                 const unsigned int);            \
  template void load_checkpoint(const CheckpointFolder::Saved &, \
                                Coupling<dim> &,                 \
                                CouplingOutput<dim> *);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
