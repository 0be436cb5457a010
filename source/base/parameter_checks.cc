// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/parameter_declaration.h>
#include <coracle/base/units.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>

namespace coracle::internal
{
namespace
{
std::string
number(const double value)
{
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string
with_unit(const double value, const std::string &unit)
{
  return number(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

/// A tiny least value only keeps zero out.
bool
means_positive(const EntryDeclaration &entry)
{
  return entry.kind == EntryKind::quantity && entry.minimum > 0 && entry.minimum <= 1e-9;
}

std::string
describe_range(const EntryDeclaration &entry)
{
  constexpr double unlimited = std::numeric_limits<int>::max();
  std::string      result;
  if (means_positive(entry))
    result += ", positive";
  else if (entry.minimum > -std::numeric_limits<double>::max())
    result += ", at least " + with_unit(entry.minimum, entry.unit);
  if (entry.kind == EntryKind::integer ? entry.maximum < unlimited
                                       : entry.maximum < std::numeric_limits<double>::max())
    result += ", at most " + with_unit(entry.maximum, entry.unit);
  return result;
}

void
check_range(const EntryDeclaration &entry, const double value, const std::string &text)
{
  if (value < entry.minimum && means_positive(entry))
    throw ValueError{"'" + text + "' is not positive", "give " + describe_values(entry)};
  if (value < entry.minimum)
    throw ValueError{"'" + text + "' is below the least allowed value, " +
                       with_unit(entry.minimum, entry.unit),
                     "give " + describe_values(entry)};
  if (value > entry.maximum)
    throw ValueError{"'" + text + "' is above the largest allowed value, " +
                       with_unit(entry.maximum, entry.unit),
                     "give " + describe_values(entry)};
}

std::vector<double>
check_numbers(const EntryDeclaration &entry, const std::string &text)
{
  std::vector<double> values;
  try
    {
      if (entry.kind == EntryKind::list)
        values = parse_quantities(text, entry.unit);
      else
        values = {parse_quantity(text, entry.unit)};
    }
  catch (const UnitError &error)
    {
      throw ValueError{error.what(), "give " + describe_values(entry)};
    }
  for (const double value : values)
    check_range(entry, value, text);
  return values;
}

std::vector<double>
check_integer(const EntryDeclaration &entry, const std::string &text)
{
  int         value        = 0;
  const char *end          = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end)
    throw ValueError{"'" + text + "' is not a whole number", "give " + describe_values(entry)};
  check_range(entry, value, text);
  return {double(value)};
}

std::vector<double>
check_flag(const std::string &text)
{
  if (text == "true" || text == "yes")
    return {1.};
  if (text == "false" || text == "no")
    return {0.};
  throw ValueError{"'" + text + "' is neither true nor false", "give true, yes, false or no"};
}

std::vector<double>
check_choice(const EntryDeclaration &entry, const std::string &text)
{
  if (std::find(entry.options.begin(), entry.options.end(), text) == entry.options.end())
    throw ValueError{"'" + text + "' is not a choice for '" + entry.name + "'",
                     suggest(text, entry.options)};
  return {};
}

std::string
lower_case(std::string word)
{
  for (char &c : word)
    c = std::tolower(static_cast<unsigned char>(c));
  return word;
}

/// Letters to insert, remove or change (Levenshtein); a wrong case counts nothing.
unsigned int
edit_distance(const std::string &a_in, const std::string &b_in)
{
  const std::string         a = lower_case(a_in), b = lower_case(b_in);
  std::vector<unsigned int> row(b.size() + 1);
  for (unsigned int j = 0; j < row.size(); ++j)
    row[j] = j;
  for (unsigned int i = 1; i <= a.size(); ++i)
    {
      unsigned int diagonal = row[0];
      row[0]                = i;
      for (unsigned int j = 1; j <= b.size(); ++j)
        {
          const unsigned int above = row[j];
          row[j]   = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
          diagonal = above;
        }
    }
  return row.back();
}
} // namespace

std::string
describe_values(const EntryDeclaration &entry)
{
  switch (entry.kind)
    {
      case EntryKind::quantity:
        return describe(parse_unit(entry.unit).dimension) + describe_range(entry);
      case EntryKind::list:
        return "a list, each entry " + describe(parse_unit(entry.unit).dimension);
      case EntryKind::integer:
        return "a whole number" + describe_range(entry);
      case EntryKind::flag:
        return "true or false";
      case EntryKind::choice:
        return "one of " + join(entry.options);
      case EntryKind::text:
        return "text";
      case EntryKind::file:
        return "the name of a file";
      case EntryKind::function:
        return "expressions in x, y, z, t, separated by ';'" +
               (entry.unit == "1" ? "" : ", result in " + entry.unit);
    }
  return "";
}

std::vector<double>
check_value(const EntryDeclaration &entry, const std::string &text)
{
  if (text.empty() && (entry.kind == EntryKind::quantity || entry.kind == EntryKind::integer ||
                       entry.kind == EntryKind::flag || entry.kind == EntryKind::choice))
    throw ValueError{"there is no value", "give " + describe_values(entry)};
  switch (entry.kind)
    {
      case EntryKind::quantity:
      case EntryKind::list:
        return check_numbers(entry, text);
      case EntryKind::integer:
        return check_integer(entry, text);
      case EntryKind::flag:
        return check_flag(text);
      case EntryKind::choice:
        return check_choice(entry, text);
      default:
        return {};
    }
}

std::string
nearest(const std::string &word, const std::vector<std::string> &candidates)
{
  std::string  best;
  unsigned int least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string &candidate : candidates)
    if (const unsigned int distance = edit_distance(word, candidate); distance < least)
      {
        least = distance;
        best  = candidate;
      }
  return best;
}

std::string
join(const std::vector<std::string> &words, const std::string &separator)
{
  std::string result;
  for (const std::string &word : words)
    result += (result.empty() ? "" : separator) + word;
  return result;
}

std::string
suggest(const std::string &word, const std::vector<std::string> &candidates)
{
  constexpr unsigned int few    = 12;
  const std::string      near   = nearest(word, candidates);
  std::string            result = near.empty() ? "" : "did you mean '" + near + "'?";
  if (candidates.empty())
    return "nothing is allowed here";
  if (near.empty() || candidates.size() <= few)
    result += (result.empty() ? "allowed here: " : " Allowed here: ") + join(candidates);
  return result;
}
} // namespace coracle::internal
