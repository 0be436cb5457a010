// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/io/disk.h>

#include <filesystem>
#include <fstream>

namespace coracle
{
std::string
write_file(const std::string &file_name, const std::string &content)
{
  const std::string beside = file_name + ".part";
  std::ofstream     file(beside, std::ios::binary);
  file.write(content.data(), content.size());
  file.close();
  if (!file)
    return beside + ": it could not be written";

  std::error_code error;
  std::filesystem::rename(beside, file_name, error);
  return error ? file_name + ": " + error.message() : "";
}

void
throw_if_any(const std::string &problem, MPI_Comm communicator)
{
  using namespace dealii::Utilities::MPI;
  const unsigned int n_ranks = n_mpi_processes(communicator);
  const unsigned int first =
    min(problem.empty() ? n_ranks : this_mpi_process(communicator), communicator);
  if (first < n_ranks)
    throw RunFailure("a result could not be written",
                     broadcast(communicator, problem, first),
                     "make room on the disk, and see that the output folder still exists and may "
                     "be written to");
}
} // namespace coracle
