// SPDX-License-Identifier: GPL-3.0-or-later
// Particles are read back by HDF5 and by VTK as they were written, whichever rank had them, by none
// of them too.
#include <coracle/base/columns.h>
#include <coracle/base/exceptions.h>
#include <coracle/io/particle_output.h>

#include <filesystem>
#include <hdf5.h>

#include "read_back.h"

using namespace coracle;

// Eight particles in the plane; of three ranks the second has none.
Columns
my_particles(const unsigned int rank, const unsigned int n_ranks)
{
  const unsigned int first = (n_ranks == 1 || rank == 0 ? 0 : 5);
  const unsigned int last  = (n_ranks == 1 || rank == 2 ? 8 : 5);
  Columns            particles(10);
  particles.resize(last - first);
  for (unsigned int i = first; i < last; ++i)
    for (unsigned int c = 0; c < 10; ++c)
      particles[c][i - first] = (c == 9 ? 9007199254740000. + i : std::sqrt(1. + i + 10 * c));
  return particles;
}

std::vector<Field>
fields(const Columns &p)
{
  return {{"position", "m", {p[0], p[1]}},
          {"velocity", "m/s", {p[2], p[3]}},
          {"pressure", "Pa", {p[4]}},
          {"stress", "Pa", {p[5], p[6], p[7], p[8]}},
          {"id", "", {p[9]}, 1, true}};
}

// Largest difference of a dataset from columns of all eight particles.
double
difference(const std::string               &file_name,
           const std::string               &dataset,
           const std::vector<unsigned int> &columns)
{
  const Columns all   = my_particles(0, 1);
  const hid_t   file  = H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t   set   = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  const hid_t   space = H5Dget_space(set);
  hsize_t       size[2];
  H5Sget_simple_extent_dims(space, size, nullptr);
  std::vector<double> values(size[0] * size[1]);
  H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);

  double result = (size[0] == all.size() ? 0. : 1e300);
  for (unsigned int i = 0; i < all.size(); ++i)
    for (unsigned int c = 0; c < size[1]; ++c)
      result = std::max(result,
                        std::abs(values[i * size[1] + c] -
                                 (c < columns.size() ? all[columns[c]][i] : 0.)));
  return result;
}

void
test(const bool single_precision)
{
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const std::string  folder  = single_precision ? "single" : "double";

  {
    OutputDirectory directory(folder, MPI_COMM_WORLD);
    ParticleFormat  format;
    format.single_precision = single_precision;
    ParticleOutput hdf5(directory, "salt & water", format);
    format.hdf5 = false;
    format.vtu  = true;
    ParticleOutput vtu(directory, "ice", format);

    Columns particles = my_particles(rank, n_ranks);
    for (const double time : {0., 0.125})
      {
        hdf5.write(time, particles.size(), fields(particles));
        vtu.write(time, particles.size(), fields(particles));
      }
    particles.resize(0);
    hdf5.write(0.25, 0, fields(particles));
    vtu.write(0.25, 0, fields(particles));
  }
  if (rank != 0)
    return;

  deallog << folder << " precision" << std::endl;
  const std::string file = folder + "/data/salt & water.000001.h5";
  // Single precision rounds numbers of at most 10 by less than 1e-6; ids must stay.
  const double tolerance = (single_precision ? 1e-6 : 0.);
  deallog << "HDF5 gives back position: " << (difference(file, "position", {0, 1}) <= tolerance)
          << ", pressure: " << (difference(file, "pressure", {4}) <= tolerance)
          << ", stress: " << (difference(file, "stress_xy", {8}) <= tolerance)
          << ", id: " << (difference(file, "id", {9}) == 0.) << std::endl;
  log_what_vtk_reads(folder);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test(false);
  test(true);

  // A second run into the same folder leaves nothing of the first, and names can't collide.
  OutputDirectory again("single", MPI_COMM_WORLD);
  const auto      n_files = [] {
    return std::distance(std::filesystem::directory_iterator("single/data"), {});
  };
  MPI_Barrier(MPI_COMM_WORLD);
  again.claim("ice");
  again.claim("salt & water");
  deallog << "files left of an earlier run: " << n_files() << std::endl;
  try
    {
      again.claim("ice");
    }
  catch (const UserError &error)
    {
      deallog << error.title << std::endl;
    }
  try
    {
      OutputDirectory nowhere("/proc/nowhere", MPI_COMM_WORLD);
    }
  catch (const UserError &error)
    {
      deallog << error.title << ", found: " << error.found << std::endl;
    }
}
