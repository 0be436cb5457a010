// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

/**
 * The text of parameter files as statements that know where they stand. The
 * syntax is deal.II's: `subsection X` ... `end`, `set A = b`, `include file`,
 * `#` comments and a `\` at the end of a line that goes on.
 */
namespace coracle::internal
{
struct Location
{
  /// "" for the command line.
  std::string  file;
  unsigned int line = 0;
  /// 0 in the file itself, 1 in one that it includes, ...
  unsigned int depth = 0;

  template <typename Archive>
  void serialize(Archive &archive, const unsigned int /*version*/)
  {
    archive &file &line &depth;
  }
};

/// One line of text, continuation lines joined.
struct Line
{
  Location    location;
  std::string text;

  template <typename Archive>
  void serialize(Archive &archive, const unsigned int /*version*/)
  {
    archive &location &text;
  }
};

/// `set key = value`, or with an empty key the beginning of a section.
struct Statement
{
  Location                 location;
  std::vector<std::string> sections;
  std::string              key, value;
};

/// Split into lines without comments; the lines of included files stand in the place of `include`.
/// A file that cannot be read, or includes itself, is a UserError.
std::vector<Line> read_lines(const std::string &file_name);
std::vector<Line> split_lines(const std::string &text, const std::string &file_name);

/// Unknown statements, unclosed and over-closed sections are UserErrors.
std::vector<Statement> scan(const std::vector<Line> &lines);

/// `Section/Key=value`
Statement scan_assignment(const std::string &assignment);

/// "case.prm, line 31, Bodies/water/Shape"; for the command line "--set Bodies/water/Shape".
std::string describe(const Location &location, const std::string &path);

/// "a" + "/" + "b", where either may be empty.
std::string join_path(const std::string &a, const std::string &b);
} // namespace coracle::internal
