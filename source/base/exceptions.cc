// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>

namespace coracle
{
namespace
{
/// "  found     first line" with further lines below its beginning.
std::string
labelled(const std::string &label, const std::string &text)
{
  const std::size_t width  = 12;
  std::string       result = "\n  " + label + std::string(width - 2 - label.size(), ' ');
  for (const char c : text)
    result += (c == '\n' ? "\n" + std::string(width, ' ') : std::string(1, c));
  return result;
}
} // namespace

UserError::UserError(const std::string &title,
                     const std::string &where,
                     const std::string &found,
                     const std::string &cure)
  : std::runtime_error(title + labelled("case", where) + labelled("found", found) +
                       labelled("cure", cure))
  , title(title)
  , where(where)
  , found(found)
  , cure(cure)
{}

RunFailure::RunFailure(const std::string &title,
                       const std::string &details,
                       const std::string &cure)
  : std::runtime_error(title + labelled("found", details) + labelled("cure", cure))
  , title(title)
  , details(details)
  , cure(cure)
{}

std::string
describe(const UserError &error)
{
  return "error: " + std::string(error.what());
}

std::string
describe(const RunFailure &error)
{
  return "error: " + std::string(error.what());
}
} // namespace coracle
