// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/text.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace coracle
{
std::string
exact_number(const double value)
{
  std::array<char, 32> buffer;
  const auto           result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string
with_prefix(const double value, const std::string &unit)
{
  static const std::array<const char *, 9> prefixes = {
    {"p", "n", "u", "m", "", "k", "M", "G", "T"}};
  if (!std::isfinite(value))
    return exact_number(value) + " " + unit;

  int index = 4;
  if (value != 0)
    {
      // 999.96 would be printed as 1000 with four digits: it is the next prefix's.
      const double rounded = std::abs(value) * (1 + 5e-5);
      index = std::min(8, std::max(0, static_cast<int>(std::floor(std::log10(rounded) / 3)) + 4));
    }
  std::array<char, 32> number;
  std::snprintf(number.data(), number.size(), "%.4g", value * std::pow(1000., 4 - index));
  std::string text = std::string(number.data()) + " " + prefixes[index] + unit;
  if (text.back() == ' ')
    text.pop_back();
  return text;
}

std::string
clock_time(const double seconds)
{
  if (!std::isfinite(seconds) || seconds < 0 || seconds > 1e9)
    return "--";
  const long           total = std::lround(seconds);
  std::array<char, 32> text;
  if (total < 3600)
    std::snprintf(text.data(), text.size(), "%ld:%02ld", total / 60, total % 60);
  else
    std::snprintf(
      text.data(), text.size(), "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
  return text.data();
}

std::string
xml_text(const std::string &text)
{
  std::string result;
  for (const char c : text)
    switch (c)
      {
        case '&':
          result += "&amp;";
          break;
        case '<':
          result += "&lt;";
          break;
        case '>':
          result += "&gt;";
          break;
        case '"':
          result += "&quot;";
          break;
        default:
          result += c;
      }
  return result;
}

std::string
file_name_part(const std::string &name)
{
  std::string result = name;
  for (char &c : result)
    if (static_cast<unsigned char>(c) < 32 ||
        std::string("/\\:*?\"<>|").find(c) != std::string::npos)
      c = '_';
  return result;
}

std::string
six_digits(const unsigned int number)
{
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "%06u", number);
  return text.data();
}
} // namespace coracle
