// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/units.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>

namespace coracle
{
namespace
{
constexpr double pi = 3.14159265358979323846;

struct NamedUnit
{
  Unit unit;
  /// Letters that may stand before the name.
  const char *prefixes;
};

const std::map<std::string, NamedUnit> &
named_units()
{
  static const std::map<std::string, NamedUnit> units = {
    {"1", {{1., {}}, ""}},
    {"%", {{0.01, {}}, ""}},
    {"rad", {{1., {}}, ""}},
    {"deg", {{pi / 180., {}}, ""}},
    {"m", {{1., {{1, 0, 0, 0}}}, "numcdk"}},
    {"g", {{1e-3, {{0, 1, 0, 0}}}, "mk"}},
    {"t", {{1e3, {{0, 1, 0, 0}}}, ""}},
    {"s", {{1., {{0, 0, 1, 0}}}, "num"}},
    {"min", {{60., {{0, 0, 1, 0}}}, ""}},
    {"h", {{3600., {{0, 0, 1, 0}}}, ""}},
    {"K", {{1., {{0, 0, 0, 1}}}, ""}},
    {"Hz", {{1., {{0, 0, -1, 0}}}, "kMG"}},
    {"rpm", {{pi / 30., {{0, 0, -1, 0}}}, ""}},
    {"l", {{1e-3, {{3, 0, 0, 0}}}, "m"}},
    {"N", {{1., {{1, 1, -2, 0}}}, "mkM"}},
    {"Pa", {{1., {{-1, 1, -2, 0}}}, "mhkMG"}},
    {"bar", {{1e5, {{-1, 1, -2, 0}}}, "m"}},
    {"J", {{1., {{2, 1, -2, 0}}}, "mkM"}},
    {"W", {{1., {{2, 1, -3, 0}}}, "mkM"}},
  };
  return units;
}

double
prefix_factor(const char prefix)
{
  switch (prefix)
    {
      case 'n':
        return 1e-9;
      case 'u':
        return 1e-6;
      case 'm':
        return 1e-3;
      case 'c':
        return 1e-2;
      case 'd':
        return 1e-1;
      case 'h':
        return 1e2;
      case 'k':
        return 1e3;
      case 'M':
        return 1e6;
      default:
        return 1e9;
    }
}

Unit
lookup(const std::string &name)
{
  const auto &units = named_units();
  // A whole name first: "min" is a minute and no inch, "m" is no prefix.
  if (const auto found = units.find(name); found != units.end())
    return found->second.unit;
  if (name.size() > 1)
    if (const auto found = units.find(name.substr(1)); found != units.end())
      if (std::string(found->second.prefixes).find(name[0]) != std::string::npos)
        return {prefix_factor(name[0]) * found->second.unit.factor, found->second.unit.dimension};
  throw UnitError("'" + name + "' is not a known unit");
}

/// Beyond these a unit is a slip of the pen; they also keep numbers in bounds.
constexpr int largest_exponent = 12, deepest_parentheses = 16;

void
check_exponents(const Unit &unit)
{
  for (const int e : unit.dimension)
    if (std::abs(e) > 10 * largest_exponent)
      throw UnitError("the exponents of a unit are too large");
}

Unit
power(const Unit &unit, const int exponent)
{
  Unit result{std::pow(unit.factor, exponent), unit.dimension};
  for (int &e : result.dimension)
    e *= exponent;
  check_exponents(result);
  return result;
}

Unit
product(const Unit &a, const Unit &b)
{
  Unit result{a.factor * b.factor, a.dimension};
  for (unsigned int i = 0; i < result.dimension.size(); ++i)
    result.dimension[i] += b.dimension[i];
  check_exponents(result);
  return result;
}

/// Recursive descent over  product := factor { [*|/] factor },  factor := (name | '(' product ')')
/// [^ int].
class UnitReader
{
public:
  explicit UnitReader(const std::string &text) : text(text) {}

  Unit read()
  {
    const Unit unit = read_product();
    if (position < text.size())
      throw UnitError("'" + text.substr(position) + "' in the unit '" + text +
                      "' is not understood");
    return unit;
  }

private:
  Unit read_product()
  {
    Unit result      = read_factor();
    bool after_slash = false;
    for (skip_blanks(); position < text.size() && text[position] != ')'; skip_blanks())
      {
        const bool divide = (text[position] == '/');
        if (!divide && after_slash)
          throw UnitError("the unit '" + text +
                          "' can be read in two ways; use parentheses, as in J/(kg K)");
        if (divide || text[position] == '*')
          ++position;
        after_slash = divide;
        result      = product(result, divide ? power(read_factor(), -1) : read_factor());
      }
    return result;
  }

  Unit read_factor()
  {
    skip_blanks();
    Unit unit;
    if (position < text.size() && text[position] == '(')
      {
        ++position;
        if (++depth > deepest_parentheses)
          throw UnitError("the unit '" + text + "' has too many parentheses");
        unit = read_product();
        --depth;
        if (position == text.size())
          throw UnitError("the unit '" + text + "' lacks a ')'");
        ++position;
      }
    else
      unit = lookup(read_name());
    skip_blanks();
    if (position < text.size() && text[position] == '^')
      {
        ++position;
        unit = power(unit, read_exponent());
      }
    return unit;
  }

  std::string read_name()
  {
    const std::size_t begin = position;
    if (position < text.size() && (text[position] == '1' || text[position] == '%'))
      ++position;
    else
      while (position < text.size() && std::isalpha(static_cast<unsigned char>(text[position])))
        ++position;
    if (position == begin)
      throw UnitError("'" + text + "' is not a unit");
    return text.substr(begin, position - begin);
  }

  int read_exponent()
  {
    const char *const begin = text.c_str() + position;
    char             *end   = nullptr;
    const long        value = std::strtol(begin, &end, 10);
    if (end == begin || std::abs(value) > largest_exponent)
      throw UnitError("the unit '" + text + "' needs a whole number after '^'");
    position += end - begin;
    return value;
  }

  void skip_blanks()
  {
    while (position < text.size() && text[position] == ' ')
      ++position;
  }

  const std::string &text;
  std::size_t        position = 0;
  int                depth    = 0;
};

struct NumberAndUnit
{
  double      number;
  std::string unit;
};

NumberAndUnit
split_number(const std::string &text)
{
  const std::string trimmed = trim(text);
  const char *const begin   = trimmed.c_str();
  char             *end     = nullptr;
  const double      number  = std::strtod(begin, &end);
  // strtod knows hexadecimal numbers and NaN, users of parameter files do not.
  if (end == begin || std::isnan(number) || trimmed.find_first_of("xX") < std::size_t(end - begin))
    throw UnitError("'" + trimmed + "' is not a number");
  return {number, trim(end)};
}

double
to_si(const NumberAndUnit &value, const std::string &text, const std::string &si_unit)
{
  if (value.unit.empty())
    return value.number;
  const Unit      unit     = parse_unit(value.unit);
  const Dimension expected = parse_unit(si_unit).dimension;
  if (unit.dimension != expected)
    throw UnitError("'" + trim(text) + "' is " + describe(unit.dimension) + ", but " +
                    describe(expected) + " is expected");
  return value.number * unit.factor;
}

/// Dimensions that have a name of their own.
const std::map<std::string, std::string> &
named_dimensions()
{
  static const std::map<std::string, std::string> names = {
    {"1", "a plain number"},
    {"m", "a length"},
    {"m^2", "an area"},
    {"m^3", "a volume"},
    {"kg", "a mass"},
    {"s", "a time"},
    {"K", "a temperature"},
    {"1/s", "a rate or frequency"},
    {"m/s", "a velocity"},
    {"m/s^2", "an acceleration"},
    {"N", "a force"},
    {"N/m", "a force per length"},
    {"Pa", "a pressure or stress"},
    {"J", "an energy or moment"},
    {"W", "a power"},
    {"N s", "an impulse"},
    {"kg/m^3", "a density"},
    {"kg/m^2", "a mass per area"},
    {"kg/m", "a mass per length"},
    {"kg m^2", "a moment of inertia"},
    {"Pa s", "a dynamic viscosity"},
    {"m^2/s", "a kinematic viscosity"},
    {"Pa/m", "a force per volume"},
    {"J/(kg K)", "a specific heat capacity"},
    {"J/kg", "a specific energy"},
  };
  return names;
}
} // namespace

Unit
parse_unit(const std::string &text)
{
  const std::string trimmed = trim(text);
  return trimmed.empty() ? Unit() : UnitReader(trimmed).read();
}

std::string
describe(const Dimension &dimension)
{
  for (const auto &[unit, name] : named_dimensions())
    if (parse_unit(unit).dimension == dimension)
      return unit == "1" ? name : name + " [" + unit + "]";

  const char *const base_units[] = {"m", "kg", "s", "K"};
  std::string       unit;
  for (unsigned int i = 0; i < dimension.size(); ++i)
    if (dimension[i] != 0)
      unit += (unit.empty() ? "" : " ") + std::string(base_units[i]) +
              (dimension[i] == 1 ? "" : "^" + std::to_string(dimension[i]));
  return "a quantity in [" + unit + "]";
}

double
parse_quantity(const std::string &text, const std::string &si_unit)
{
  return to_si(split_number(text), text, si_unit);
}

std::vector<double>
parse_quantities(const std::string &text, const std::string &si_unit)
{
  const std::vector<std::string> parts = split_and_trim(text, ',');
  std::vector<NumberAndUnit>     values;
  unsigned int                   n_with_unit = 0;
  for (const std::string &part : parts)
    {
      values.push_back(split_number(part));
      n_with_unit += !values.back().unit.empty();
    }

  const bool unit_for_all = (n_with_unit == 1 && !values.back().unit.empty());
  const bool unit_each    = (n_with_unit > 0 && !unit_for_all);

  std::vector<double> result;
  for (unsigned int i = 0; i < parts.size(); ++i)
    {
      if (unit_for_all)
        values[i].unit = values.back().unit;
      else if (unit_each && values[i].unit.empty() && values[i].number != 0)
        throw UnitError(
          "'" + parts[i] + "' in '" + trim(text) +
          "' has no unit while others have; give each number its unit, or only the last");
      result.push_back(to_si(values[i], parts[i], si_unit));
    }
  return result;
}

std::string
trim(const std::string &text)
{
  const char *const blanks = " \t\r\n";
  const std::size_t begin  = text.find_first_not_of(blanks);
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::vector<std::string>
split_and_trim(const std::string &text, const char separator)
{
  std::vector<std::string> parts;
  if (trim(text).empty())
    return parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(trim(text.substr(begin, end - begin)));
  parts.push_back(trim(text.substr(begin)));
  return parts;
}
} // namespace coracle
