// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>

#include <memory>
#include <string>
#include <vector>

/**
 * What a Declaration collects: the tree of sections and entries that parameter
 * files are checked against and documentation is printed from. Only the
 * parameters' own sources include this, and sources that look up a name the
 * user gave (suggest()).
 */
namespace coracle::internal
{
enum class EntryKind
{
  quantity,
  list,
  integer,
  flag,
  choice,
  text,
  file,
  function
};

/// The choice `key` of the same section must be `option`.
struct Condition
{
  std::string key, option;
};

struct EntryDeclaration
{
  std::string              name;
  EntryKind                kind;
  std::string              default_value;
  std::string              meaning;
  std::string              unit;
  std::string              symbol;
  std::vector<std::string> options;
  double                   minimum = -std::numeric_limits<double>::max();
  double                   maximum = std::numeric_limits<double>::max();
  std::vector<Condition>   conditions;
};

struct SectionDeclaration
{
  std::string name, meaning;
  /// If not empty: holds any number of subsections with names of the user's, each with the entries
  /// and sections below; the word for one of them.
  std::string                                      item;
  std::vector<Condition>                           conditions;
  std::vector<EntryDeclaration>                    entries;
  std::vector<std::unique_ptr<SectionDeclaration>> sections;
};

/// "a length [m], at least 0", "one of a, b": what may be written, for documents and messages.
std::string describe_values(const EntryDeclaration &entry);

/// A value that its entry does not accept.
struct ValueError
{
  std::string found, cure;
};

/**
 * The value in SI: one number for quantities, integers and flags (0 or 1), any number of them for
 * lists, none for the rest. Throws ValueError.
 */
std::vector<double> check_value(const EntryDeclaration &entry, const std::string &text);
/// The candidate nearest to a word by the number of letters to change, or "" if none is near.
std::string nearest(const std::string &word, const std::vector<std::string> &candidates);

/// "a, b, c"
std::string join(const std::vector<std::string> &words, const std::string &separator = ", ");

/// "did you mean 'Density'? Allowed here: Density, Viscosity"; the list is left out when it is
/// long.
std::string suggest(const std::string &word, const std::vector<std::string> &candidates);
} // namespace coracle::internal

namespace coracle
{
struct Declaration::Data
{
  /// Of the whole tree, so that what was read may outlive the declaration.
  std::shared_ptr<internal::SectionDeclaration> root;
  internal::SectionDeclaration                 *section = nullptr;
  std::vector<internal::Condition>              conditions;
  std::vector<std::unique_ptr<Declaration>>     views;

  internal::EntryDeclaration &add(const internal::EntryDeclaration &entry);
  internal::SectionDeclaration &
  add_section(const std::string &name, const std::string &item, const std::string &meaning);
  /// A Declaration of another section, or of this one under more conditions.
  Declaration &view(internal::SectionDeclaration           &section,
                    const std::vector<internal::Condition> &conditions);
};
} // namespace coracle
