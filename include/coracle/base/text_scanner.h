// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace coracle
{
/// What is wrong with a file that somebody has made: "FILE, line N: reason".
class FileError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// All bytes of a regular file. Throws FileError: one that is none may never end.
std::string read_whole_file(const std::string &file_name);

/**
 * The words and numbers of a text file, and the line that each is in. Nothing
 * is assumed of the file: whatever is not what was asked for throws a FileError
 * with the line.
 */
class TextScanner
{
public:
  explicit TextScanner(const std::string &file_name);
  TextScanner(const TextScanner &) = delete;

  /// Is nothing but blanks left?
  bool at_end();
  /// Is this the next character that is no blank?
  bool begins_with(const char c);
  /// What is between blanks; the file must have one more. Valid as long as this object.
  std::string_view word();
  /// Leave out what is left of a line that begins, or goes on, with this text; false if it does
  /// not.
  bool skip_line_of(const std::string_view &text);
  /// What is left of this line, without its end; empty at the end of the file.
  std::string_view rest_of_line();

  /// The next word, which must be this one.
  void expect(const std::string_view &text);
  /// The next word as a number; `what` is for messages.
  std::int64_t integer(const std::string &what);
  /// From 0 to 2^32 - 2, for what is stored as unsigned int.
  unsigned int natural(const std::string &what);
  /// Finite, and small enough that its cube is.
  double real(const std::string &what);
  /// How many of something follow: not more than the file has bytes left.
  std::size_t count(const std::string &what);

  /// The same for a word that is already there.
  std::int64_t to_integer(const std::string_view &word, const std::string &what) const;
  double       to_real(const std::string_view &word, const std::string &what) const;

  /// Line of the last word, from 1.
  std::size_t line() const { return line_of_word; }

  [[noreturn]] void fail(const std::string &reason) const { fail(reason, line_of_word); }
  [[noreturn]] void fail(const std::string &reason, const std::size_t at_line) const;

private:
  void skip_blanks();

  const std::string name, text;
  std::size_t       place = 0, line_of_place = 1, line_of_word = 1;
};
} // namespace coracle
