// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <unistd.h>

/// What all fuzz targets do.
namespace fuzz
{
/// A folder of this process, in memory where there is such a place.
inline const std::string &
place()
{
  static const std::string folder = [] {
    const std::string memory = "/dev/shm",
                      name   = (std::filesystem::is_directory(memory) ? memory : "/tmp") +
                             "/coracle_fuzz." + std::to_string(getpid());
    std::filesystem::create_directories(name);
    return name;
  }();
  return folder;
}

inline void
write(const std::string &file_name, const void *data, const std::size_t size)
{
  std::ofstream(file_name, std::ios::binary).write(static_cast<const char *>(data), size);
}

/// MPI, for one process; and the folder goes with the process.
inline void
start()
{
  struct MpiRun
  {
    MpiRun()
    {
      // Which has to outlive this.
      place();
      int    argc   = 1;
      char   name[] = "fuzz", *argv[] = {name, nullptr};
      char **arguments = argv;
      mpi = std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(argc, arguments, 1);
    }
    ~MpiRun()
    {
      std::error_code ignored;
      std::filesystem::remove_all(place(), ignored);
    }
    std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize> mpi;
  };
  static MpiRun mpi_run;
}
} // namespace fuzz
