// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace coracle
{
/// A number, unit or dimension that cannot be read as what was asked for; what() says why.
class UnitError : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/// Exponents of metre, kilogram, second and kelvin. Angles and percentages have no dimension.
using Dimension = std::array<int, 4>;

struct Unit
{
  /// One of this unit is `factor` of the SI unit.
  double    factor = 1;
  Dimension dimension{};
};

/**
 * Read a unit: names with an optional prefix and an integer exponent (`mm`, `m^3`, `s^-1`),
 * multiplied by a space or `*` and divided by `/`, with parentheses: `kg/m^3`, `N s/m`,
 * `J/(kg K)`. "1" and "" are the unit of plain numbers. After a `/` a product needs
 * parentheses, because `J/kg K` is read in two ways.
 *
 * Throws UnitError, naming the part that is not understood.
 */
Unit parse_unit(const std::string &text);

/// Words for a dimension, with its SI unit: "a length [m]", "a dynamic viscosity [Pa s]",
/// "a quantity in [kg m^4/s]".
std::string describe(const Dimension &dimension);

/**
 * A number with a unit (`20 mm`); a bare number is in SI.
 *
 * @param text    what the user wrote
 * @param si_unit unit of the result; its dimension is the only one accepted
 * @return value in SI
 *
 * Throws UnitError that names what was read and what is expected.
 */
double parse_quantity(const std::string &text, const std::string &si_unit);

/**
 * Numbers separated by commas; "" is the empty list. Each may carry its unit (`2 m, 50 cm`), or
 * the last one's holds for all (`10, 0, 20 mm`); anything between is refused as ambiguous unless
 * the bare numbers are 0.
 */
std::vector<double> parse_quantities(const std::string &text, const std::string &si_unit);

/// Split at a separator and remove the blanks around each part; "" has no parts.
std::vector<std::string> split_and_trim(const std::string &text, const char separator);

std::string trim(const std::string &text);
} // namespace coracle
