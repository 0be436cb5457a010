// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>

#include <coracle/base/exceptions.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace coracle
{
/**
 * What one section of a parameter file may hold. Each entry has a default, a
 * pattern, an SI unit (which fixes its dimension), the symbol used in
 * doc/theory.md ("" if none) and a meaning. A room declares its own sections;
 * `doc/parameters.md` is generated from all of them.
 */
class Declaration
{
public:
  Declaration();
  ~Declaration();
  Declaration(const Declaration &) = delete;

  /// A number with a dimension; `unit` is an SI unit such as "m", "kg/m^3", "Pa", "1".
  void quantity(const std::string &name,
                const std::string &default_value,
                const std::string &unit,
                const std::string &symbol,
                const std::string &meaning,
                const double       minimum = -std::numeric_limits<double>::max(),
                const double       maximum = std::numeric_limits<double>::max());

  /// Comma separated numbers of one dimension: points, directions, lists. "" is the empty list.
  void list(const std::string &name,
            const std::string &default_value,
            const std::string &unit,
            const std::string &symbol,
            const std::string &meaning);

  void integer(const std::string &name,
               const int          default_value,
               const std::string &meaning,
               const int          minimum = 0,
               const int          maximum = std::numeric_limits<int>::max());

  void flag(const std::string &name, const bool default_value, const std::string &meaning);

  /// One of the given words.
  void choice(const std::string              &name,
              const std::string              &default_value,
              const std::vector<std::string> &options,
              const std::string              &meaning);

  void text(const std::string &name, const std::string &default_value, const std::string &meaning);

  /// A file that must exist; a relative path is relative to the parameter file's folder.
  void file(const std::string &name, const std::string &meaning);

  /// Expressions in x, y, z, t (as FunctionParser reads them), separated by ';'. Results in SI
  /// `unit`.
  void function(const std::string &name,
                const std::string &default_value,
                const std::string &unit,
                const std::string &meaning);

  /// A subsection with this name.
  Declaration &section(const std::string &name, const std::string &meaning);

  /// A subsection that holds any number of subsections with names of the user's, all alike.
  /// `item` is the word for one of them in the documentation ("body").
  Declaration &
  named_sections(const std::string &name, const std::string &item, const std::string &meaning);

  /// Entries that are allowed only where the choice `key` (declared before in this section) is
  /// `option`.
  Declaration &when(const std::string &key, const std::string &option);

private:
  struct Data;
  std::unique_ptr<Data> data;
  friend class ParameterFile;
};

/**
 * A view of one section of what was read; cheap to copy. Values are in SI.
 * Asking for an entry that was not declared is a programming error.
 */
class Parameters
{
public:
  double              quantity(const std::string &name) const;
  std::vector<double> list(const std::string &name) const;
  int                 integer(const std::string &name) const;
  bool                flag(const std::string &name) const;
  std::string         choice(const std::string &name) const;
  std::string         text(const std::string &name) const;
  /// Absolute path.
  std::string file(const std::string &name) const;

  /// A list with dim entries (fails with a readable message otherwise); "" gives the origin.
  template <int dim>
  dealii::Point<dim> point(const std::string &name) const;

  /// A ParsedFunction of space and time with n_components expressions.
  template <int dim>
  std::unique_ptr<dealii::Function<dim>> function(const std::string &name,
                                                  const unsigned int n_components) const;

  /// Was the entry set in the file or on the command line?
  bool is_set(const std::string &name) const;

  Parameters               section(const std::string &name) const;
  std::vector<std::string> section_names() const;
  /// Last part of the path: the user's name of a body, material, ...
  std::string name() const;
  /// "Bodies/water"
  std::string path() const;

  /// One entry of this section or of those below, as used.
  struct Entry
  {
    /// "Bodies/water/Particle spacing"; for sections with names of the user's the path of their
    /// parent, with their names as the text.
    std::string path;
    std::string text;
    /// In SI; none for texts and functions.
    std::vector<double> numbers;
    /// "case.prm, line 5, Bodies/water/Particle spacing"
    std::string where;
  };
  /// All of them, by path.
  std::vector<Entry> entries() const;

  /// A UserError that names file, line and entry ("" for the whole section); for `throw
  /// section.error(...)`.
  UserError error(const std::string &entry,
                  const std::string &title,
                  const std::string &found,
                  const std::string &cure) const;

private:
  struct Data;
  std::shared_ptr<const Data> data;
  std::string                 section_path;
  friend class ParameterFile;
};

/**
 * A parameter file as read, checked against a declaration: unknown entries
 * (with the nearest known one), wrong patterns, wrong dimensions and repeated
 * entries are UserErrors with file, line and section.
 */
class ParameterFile
{
public:
  explicit ParameterFile(const Declaration &declaration);
  ~ParameterFile();
  ParameterFile(ParameterFile &&);

  /// A file with the same declaration, nothing read.
  ParameterFile empty_copy() const;

  /// Reads the file on rank 0 and hands its text to all ranks.
  void read(const std::string &file_name);
  /// For tests: the text itself.
  void read_text(const std::string &text, const std::string &file_name = "case.prm");
  /// One `Section/Key=value` of the command line; wins over the file.
  void set(const std::string &assignment);
  /// Check all, then give the root section.
  Parameters parameters() const;

  /// The file as used, all entries, readable by read() again.
  std::string print() const;
  /// All defaults with units and meaning, as a parameter file / as Markdown.
  std::string print_defaults() const;
  std::string print_markdown() const;

private:
  ParameterFile();

  struct Data;
  std::unique_ptr<Data> data;
};
} // namespace coracle
