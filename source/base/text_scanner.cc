// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/text_scanner.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace coracle
{
namespace
{
bool
is_blank(const char c)
{
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// For messages: not a whole file in one word, and nothing that a terminal would obey.
std::string
quoted(const std::string_view &word)
{
  constexpr std::size_t longest = 40;
  std::string           result  = "'";
  for (const char c : word.substr(0, longest))
    result += (c < ' ' || c > '~') ? '?' : c;
  return result + (word.size() > longest ? "...'" : "'");
}
} // namespace

std::string
read_whole_file(const std::string &file_name)
{
  std::error_code error;
  if (!std::filesystem::is_regular_file(file_name, error))
    throw FileError(file_name + ": " +
                    (error ? error.message() : std::string("it is not a regular file")));
  std::ifstream file(file_name, std::ios::binary);
  std::string   text(std::filesystem::file_size(file_name, error), '\0');
  file.read(text.data(), text.size());
  if (error || !file)
    throw FileError(file_name + ": it cannot be read");
  return text;
}

TextScanner::TextScanner(const std::string &file_name)
  : name(file_name), text(read_whole_file(file_name))
{}

void
TextScanner::fail(const std::string &reason, const std::size_t at_line) const
{
  throw FileError(name + ", line " + std::to_string(at_line) + ": " + reason);
}

void
TextScanner::skip_blanks()
{
  for (; place < text.size() && is_blank(text[place]); ++place)
    line_of_place += (text[place] == '\n');
}

bool
TextScanner::at_end()
{
  skip_blanks();
  return place == text.size();
}

bool
TextScanner::begins_with(const char c)
{
  return !at_end() && text[place] == c;
}

std::string_view
TextScanner::word()
{
  skip_blanks();
  line_of_word = line_of_place;
  if (place == text.size())
    fail("the file ends too early");
  const std::size_t begin = place;
  while (place < text.size() && !is_blank(text[place]))
    ++place;
  return std::string_view(text).substr(begin, place - begin);
}

std::string_view
TextScanner::rest_of_line()
{
  line_of_word            = line_of_place;
  const std::size_t begin = place, end = std::min(text.find('\n', place), text.size());
  place = std::min(end + 1, text.size());
  line_of_place += (end < text.size());
  std::string_view result = std::string_view(text).substr(begin, end - begin);
  if (!result.empty() && result.back() == '\r')
    result.remove_suffix(1);
  return result;
}

bool
TextScanner::skip_line_of(const std::string_view &beginning)
{
  if (text.compare(place, beginning.size(), beginning) != 0)
    return false;
  rest_of_line();
  return true;
}

void
TextScanner::expect(const std::string_view &wanted)
{
  if (const auto found = word(); found != wanted)
    fail(quoted(found) + " instead of '" + std::string(wanted) + "'");
}

std::int64_t
TextScanner::to_integer(const std::string_view &word, const std::string &what) const
{
  std::int64_t result     = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), result);
  if (error != std::errc() || end != word.data() + word.size())
    fail(quoted(word) + " is no " + what);
  return result;
}

double
TextScanner::to_real(const std::string_view &word, const std::string &what) const
{
  // Its cube, a volume, is a number too.
  constexpr double      largest = 1e100;
  constexpr std::size_t longest = 100;
  // Not from_chars: too small a number is zero here, and no mistake.
  const std::string copy(word.substr(0, longest + 1));
  char             *end    = nullptr;
  const double      result = std::strtod(copy.c_str(), &end);
  if (copy.empty() || copy.size() > longest || end != copy.c_str() + copy.size())
    fail(quoted(word) + " is no " + what);
  if (!(std::fabs(result) <= largest))
    fail(quoted(word) + " is no finite " + what);
  return result;
}

std::int64_t
TextScanner::integer(const std::string &what)
{
  return to_integer(word(), what);
}

unsigned int
TextScanner::natural(const std::string &what)
{
  const std::int64_t result = integer(what);
  if (result < 0 || result >= std::numeric_limits<unsigned int>::max())
    fail(std::to_string(result) + " is no " + what);
  return result;
}

double
TextScanner::real(const std::string &what)
{
  return to_real(word(), what);
}

std::size_t
TextScanner::count(const std::string &what)
{
  const std::int64_t result = integer("number of " + what);
  if (result < 0 || static_cast<std::uint64_t>(result) > text.size() - place)
    fail(std::to_string(result) + " " + what + " are not in this file");
  return result;
}
} // namespace coracle
