// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace coracle
{
/// The shortest decimal text that reads back as exactly this number ("inf", "-inf", "nan"
/// included).
std::string exact_number(const double value);

/// For people: three to four digits and an SI prefix: 0.0024, "s" gives "2.4 ms".
std::string with_prefix(const double value, const std::string &unit);

/// For people: 4210 s gives "1:10:10", 42 s gives "0:42"; "--" if not known (negative or not
/// finite).
std::string clock_time(const double seconds);

/// `&<>"` replaced, so that any name may stand in XML text or an attribute.
std::string xml_text(const std::string &text);

/// The name of a body or probe as part of a file name: '/' and what no file system likes become
/// '_'.
std::string file_name_part(const std::string &name);

/// 12 gives "000012".
std::string six_digits(const unsigned int number);
} // namespace coracle
