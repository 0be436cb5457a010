// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/disk.h>
#include <coracle/io/output_directory.h>
#include <coracle/io/text.h>

#include <filesystem>
#include <fstream>

namespace coracle
{
namespace
{
const char *const title = "the output folder can't be used";
const char *const cure  = "set Output/Directory to a folder that may be created and written to";

/// Is this NAME.NNNNNN<anything>, a data file of the series NAME?
bool
belongs_to(const std::string &file, const std::string &name)
{
  return file.size() > name.size() + 8 && file.compare(0, name.size(), name) == 0 &&
         file[name.size()] == '.' && file[name.size() + 7] == '.' &&
         file.find_first_not_of("0123456789", name.size() + 1) == name.size() + 7;
}
} // namespace

OutputDirectory::OutputDirectory(const Parameters  &output_section,
                                 const std::string &case_file,
                                 MPI_Comm           communicator,
                                 const bool         goes_on)
  : directory(choose(output_section, case_file)), comm(communicator), goes_on(goes_on)
{
  const std::string problem = create();
  if (!problem.empty())
    throw output_section.error("Directory", title, problem, cure);
}

OutputDirectory::OutputDirectory(const std::string &path, MPI_Comm communicator)
  : directory(path), comm(communicator)
{
  const std::string problem = create();
  if (!problem.empty())
    throw UserError(title, "Output/Directory", problem, cure);
}

std::string
OutputDirectory::choose(const Parameters &output_section, const std::string &case_file)
{
  const std::string given = output_section.text("Directory");
  return given.empty() ? "output/" + std::filesystem::path(case_file).stem().string() : given;
}

std::string
OutputDirectory::create() const
{
  std::string problem;
  if (mpi::rank(comm) == 0)
    {
      std::error_code error;
      std::filesystem::create_directories(directory + "/data", error);
      const std::string trial = directory + "/data/.write_test";
      if (error)
        problem = directory + ": " + error.message();
      else if (!std::ofstream(trial).put('\n'))
        problem = directory + ": it exists, but nothing can be written to it";
      std::filesystem::remove(trial, error);
    }
  return dealii::Utilities::MPI::broadcast(comm, problem);
}

std::string
OutputDirectory::claim(const std::string &series_name)
{
  const std::string name = file_name_part(series_name);
  if (!claimed.insert(name).second)
    throw UserError("two results would be written to the same files",
                    "Output/Directory",
                    "the name '" + series_name + "' (files " + name + ".*) is taken",
                    "give the body another name ('octree' is the background grid's own)");

  if (mpi::rank(comm) == 0 && !goes_on)
    {
      std::error_code ignored;
      for (const auto &entry : std::filesystem::directory_iterator(directory + "/data", ignored))
        if (belongs_to(entry.path().filename().string(), name))
          std::filesystem::remove(entry.path(), ignored);
      for (const char *const ending : {".pvd", ".xdmf"})
        std::filesystem::remove(file(name + ending), ignored);
    }
  MPI_Barrier(comm);
  return name;
}

void
OutputDirectory::write_parameters(const std::string &text) const
{
  mpi::agree(
    [&] {
      if (mpi::rank(comm) == 0)
        write_file(file("parameters.prm"), text);
    },
    comm);
}
} // namespace coracle
