// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/config.h>

#include <coracle/base/parameter_declaration.h>
#include <coracle/command_line.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace coracle
{
namespace
{
const std::string version_text = std::string("coracle ") + CORACLE_VERSION + " (" +
                                 CORACLE_BUILD_TYPE + ", deal.II " + DEAL_II_PACKAGE_VERSION +
                                 ")\n";

const std::string exit_codes = "Exit codes:\n"
                               "  0 OK    1 SUSPECT    2 mistake in the input    3 FAILED\n"
                               "  4 error of the program\n\n"
                               "On several processors: mpirun -q -n 4 coracle case.prm";

UserError
not_understood(const std::string &found, const std::string &cure)
{
  return UserError("the command line is not understood", "command line", found, cure);
}

/// What CLI11 fills in.
struct Arguments
{
  std::string              file, print;
  std::vector<std::string> assignments;
  bool                     check = false, restart = false, version = false, help = false;
};

void
set_up(CLI::App &app, Arguments &arguments)
{
  app.set_help_flag();
  app.footer(exit_codes);
  app.add_option("case.prm", arguments.file, "Parameter file of the case to run")->type_name("");
  app.allow_extras();
  app.add_flag("-h,--help", arguments.help, "Show this help");
  app.add_flag("--version", arguments.version, "Show the version");
  app.add_flag("--check",
               arguments.check,
               "Read and build everything, show sizes, the first time step, estimated steps and "
               "memory; run nothing");
  app
    .add_option("--set",
                arguments.assignments,
                "Section/Key=value: set an entry, wins over the file (repeatable)")
    ->type_name("")
    ->allow_extra_args(false);
  app.add_flag("--print-parameters{prm}",
               arguments.print,
               "Show all parameters with default, unit and meaning, as a parameter file; after "
               "case.prm: all values of this case; --print-parameters=markdown: the reference");
  app.add_flag("--restart",
               arguments.restart,
               "Go on from the newest checkpoint in the output folder");
}

void
check_files(const Arguments &arguments, const std::vector<std::string> &extras)
{
  if (!extras.empty() && extras[0].substr(0, 1) == "-")
    throw not_understood(
      "'" + extras[0] + "' is not an option",
      internal::suggest(
        extras[0], {"--help", "--version", "--check", "--set", "--print-parameters", "--restart"}));
  if (!extras.empty())
    throw not_understood("two parameter files, '" + arguments.file + "' and '" + extras[0] + "'",
                         "give one; a file can 'include' another");
  if (arguments.file.empty() && arguments.print.empty())
    throw not_understood("no parameter file is given", "coracle case.prm, or see coracle --help");
}
} // namespace

CommandLine
parse_command_line(const int argc, const char *const *const argv)
{
  CLI::App  app("Violent fluid-structure interaction: finite elements and material points meet.",
               "coracle");
  Arguments arguments;
  set_up(app, arguments);
  try
    {
      app.parse(argc, argv);
    }
  catch (const CLI::ParseError &error)
    {
      throw not_understood(error.what(), "see coracle --help");
    }

  CommandLine result;
  result.options = {arguments.file, arguments.assignments, arguments.check, arguments.restart};
  if (arguments.help || arguments.version)
    {
      result.action = CommandLine::Action::print_text;
      result.text   = arguments.help ? app.help() : version_text;
      return result;
    }
  check_files(arguments, app.remaining());
  if (arguments.print == "markdown")
    result.action = CommandLine::Action::print_markdown;
  else if (arguments.print == "prm")
    result.action = CommandLine::Action::print_parameters;
  else if (!arguments.print.empty())
    throw not_understood("--print-parameters=" + arguments.print,
                         "--print-parameters or --print-parameters=markdown");
  return result;
}
} // namespace coracle
