// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/simulation.h>

#include <string>

namespace coracle
{
/// What the command line asks for.
struct CommandLine
{
  enum class Action
  {
    /// Run (or check) a case.
    run,
    /// Print `text` and end.
    print_text,
    /// Print all parameters: their defaults, or the values of the given file.
    print_parameters,
    /// Print the reference of all parameters as Markdown.
    print_markdown
  };

  Action      action = Action::run;
  RunOptions  options;
  std::string text;
};

/// Throws UserError for what is not understood or does not go together.
CommandLine parse_command_line(const int argc, const char *const *argv);
} // namespace coracle
