// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/base/parameter_declaration.h>
#include <coracle/base/parameter_scanner.h>
#include <coracle/base/units.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace coracle::internal
{
namespace
{
namespace fs = std::filesystem;

constexpr unsigned int deepest_include = 16, deepest_section = 32;
/// Bytes of one file; more is no parameter file.
constexpr std::size_t longest_file = 1 << 26;

/// Blanks at the ends removed, several inside become one.
std::string
squeeze(const std::string &text)
{
  std::istringstream in(text);
  std::string        word, result;
  while (in >> word)
    result += (result.empty() ? "" : " ") + word;
  return result;
}

/// "set a" -> {"set", "a"}
std::pair<std::string, std::string>
split_first_word(const std::string &text)
{
  const std::size_t blank = text.find_first_of(" \t");
  return blank == std::string::npos
           ? std::make_pair(text, std::string())
           : std::make_pair(text.substr(0, blank), trim(text.substr(blank)));
}

std::string
slurp(const std::string &file_name, const std::string &where)
{
  std::error_code ignored;
  if (!fs::exists(file_name, ignored))
    throw UserError("a file does not exist",
                    where,
                    "there is no file '" + file_name + "'",
                    "correct the name, or give the path from the folder you are in");
  std::ifstream in(file_name);
  if (fs::is_directory(file_name, ignored) || !in)
    throw UserError("a file cannot be read",
                    where,
                    "'" + file_name + "' is a folder, or you may not read it",
                    "give a parameter file that you may read");
  std::string            text;
  std::array<char, 4096> part;
  while (text.size() <= longest_file && (in.read(part.data(), part.size()) || in.gcount() > 0))
    text.append(part.data(), in.gcount());
  if (text.size() > longest_file)
    throw UserError("a file is too long",
                    where,
                    "'" + file_name + "' has more than 64 MB",
                    "give a parameter file");
  return text;
}

std::vector<Line>
read_lines(const std::string &file_name, const std::string &where, const unsigned int depth);

/// `include` names a file relative to the one it stands in.
std::vector<Line>
read_included(const Line &line, const unsigned int depth)
{
  const std::string name  = split_first_word(line.text).second;
  const std::string where = describe(line.location, "");
  if (depth > deepest_include)
    throw UserError("parameter files include each other",
                    where,
                    "more than " + std::to_string(deepest_include) + " levels of 'include'",
                    "remove the circle");
  return read_lines((fs::path(line.location.file).parent_path() / name).string(), where, depth);
}

std::vector<Line>
split_lines(const std::string &text, const std::string &file_name, const unsigned int depth)
{
  std::vector<Line>  lines;
  std::istringstream in(text);
  std::string        raw;
  bool               goes_on = false;
  for (unsigned int number = 1; std::getline(in, raw); ++number)
    {
      std::string content = trim(raw.substr(0, raw.find('#')));
      if (goes_on)
        lines.back().text += content;
      else
        lines.push_back({{file_name, number, depth}, content});
      std::string &last = lines.back().text;
      goes_on           = (!content.empty() && content.back() == '\\');
      if (goes_on)
        {
          last.pop_back();
          last = trim(last) + " ";
        }
      else if (split_first_word(last).first == "include")
        {
          const Line              include  = lines.back();
          const std::vector<Line> included = read_included(include, depth + 1);
          lines.pop_back();
          lines.insert(lines.end(), included.begin(), included.end());
        }
    }
  return lines;
}

std::vector<Line>
read_lines(const std::string &file_name, const std::string &where, const unsigned int depth)
{
  return split_lines(slurp(file_name, where), file_name, depth);
}

Statement
scan_set(const Line &line, const std::vector<std::string> &sections, const std::string &rest)
{
  const std::size_t equals = rest.find('=');
  const std::string key    = squeeze(rest.substr(0, equals));
  if (equals == std::string::npos || key.empty())
    throw UserError("a line is not understood",
                    describe(line.location, join(sections, "/")),
                    "'" + line.text + "'",
                    "write 'set Name = value'");
  return {line.location, sections, key, trim(rest.substr(equals + 1))};
}
} // namespace

std::vector<Line>
read_lines(const std::string &file_name)
{
  return read_lines(file_name, file_name, 0);
}

std::vector<Line>
split_lines(const std::string &text, const std::string &file_name)
{
  return split_lines(text, file_name, 0);
}

std::vector<Statement>
scan(const std::vector<Line> &lines)
{
  std::vector<Statement>   statements;
  std::vector<std::string> sections;
  std::vector<Location>    opened;
  for (const Line &line : lines)
    {
      const auto [word, rest] = split_first_word(line.text);
      if (word.empty())
        continue;
      else if (word == "set")
        statements.push_back(scan_set(line, sections, rest));
      else if (word == "subsection" && !rest.empty() && rest.find('/') == std::string::npos)
        {
          if (sections.size() == deepest_section)
            throw UserError("too many subsections in each other",
                            describe(line.location, join(sections, "/")),
                            "more than " + std::to_string(deepest_section) + " are open",
                            "close subsections with 'end'");
          sections.push_back(squeeze(rest));
          opened.push_back(line.location);
          statements.push_back({line.location, sections, "", ""});
        }
      else if (word == "end" && rest.empty() && !sections.empty())
        {
          sections.pop_back();
          opened.pop_back();
        }
      else
        throw UserError(
          "a line is not understood",
          describe(line.location, join(sections, "/")),
          "'" + line.text + "'" +
            (word == "end" && sections.empty() ? ", but no subsection is open" : ""),
          word == "subsection"
            ? "give the subsection a name without '/'"
            : "a line is 'set Name = value', 'subsection Name', 'end', 'include file' "
              "or a comment that begins with '#'");
    }
  if (!sections.empty())
    throw UserError("a subsection is not closed",
                    describe(opened.back(), join(sections, "/")),
                    "the file ends inside this subsection",
                    "write 'end' on a line of its own after its last entry");
  return statements;
}

Statement
scan_assignment(const std::string &assignment)
{
  const std::size_t        equals = assignment.find('=');
  std::vector<std::string> path   = split_and_trim(assignment.substr(0, equals), '/');
  for (std::string &part : path)
    part = squeeze(part);
  if (equals == std::string::npos || path.empty() || path.back().empty() ||
      assignment.find_first_of("#\n") != std::string::npos)
    throw UserError("an assignment is not understood",
                    "command line",
                    "--set '" + assignment + "'",
                    "write --set 'Section/Key=value'");
  const std::string key = path.back();
  path.pop_back();
  return {{}, path, key, trim(assignment.substr(equals + 1))};
}

std::string
describe(const Location &location, const std::string &path)
{
  if (location.file.empty())
    return "command line, --set " + path;
  return location.file + (location.line > 0 ? ", line " + std::to_string(location.line) : "") +
         (path.empty() ? "" : ", " + path);
}

std::string
join_path(const std::string &a, const std::string &b)
{
  return a.empty() || b.empty() ? a + b : a + "/" + b;
}
} // namespace coracle::internal
