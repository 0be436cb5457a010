// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/command_line.h>

#include <cstdlib>
#include <iostream>

namespace
{
using namespace coracle;

/// The text that is asked for, the same on all ranks.
std::string
text_of(const CommandLine &command_line)
{
  if (command_line.action == CommandLine::Action::print_text)
    return command_line.text;
  Declaration root;
  declare_parameters(root);
  ParameterFile file(root);
  if (command_line.action == CommandLine::Action::print_markdown)
    return file.print_markdown();
  if (command_line.options.file.empty())
    return file.print_defaults();
  file.read(command_line.options.file);
  for (const std::string &assignment : command_line.options.assignments)
    file.set(assignment);
  return file.print();
}

int
do_what_is_asked(const int argc, char **const argv)
{
  const CommandLine command_line = parse_command_line(argc, argv);
  if (command_line.action == CommandLine::Action::run)
    return run(command_line.options, MPI_COMM_WORLD);
  const std::string text = text_of(command_line);
  if (mpi::rank(MPI_COMM_WORLD) == 0)
    std::cout << text << std::flush;
  return 0;
}
} // namespace

int
main(int argc, char **argv)
{
  // Open MPI's own file layer aborts in the library's parallel output of meshes; ROMIO does not.
  // A choice made by the user stays.
  setenv("OMPI_MCA_io", "romio321", 0);

  // Ranks are processes; threads inside them would only compete.
  dealii::Utilities::MPI::MPI_InitFinalize mpi_initialization(argc, argv, 1);
  return mpi::run_guarded([&] { return do_what_is_asked(argc, argv); }, MPI_COMM_WORLD);
}
