// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameter_declaration.h>
#include <coracle/base/parameter_scanner.h>

#include <map>

/**
 * What was read, matched with its declaration. Only the parameters' own sources
 * include this.
 */
namespace coracle::internal
{
struct Value
{
  const EntryDeclaration *entry = nullptr;
  /// As the user wrote it, or the default; for a file its absolute path.
  std::string         text;
  std::vector<double> numbers;
  /// Set in the file or on the command line, at:
  bool     given = false;
  Location location;
};

struct SectionValues
{
  const SectionDeclaration    *declaration = nullptr;
  Location                     location;
  std::map<std::string, Value> values;
  /// Subsections in the order of the file (named) or of the declaration.
  std::vector<std::string> section_names;
};

/// A section as it stands in the file.
struct GivenSection
{
  Location                                          location;
  std::map<std::string, Statement>                  statements;
  std::vector<std::pair<std::string, GivenSection>> sections;

  GivenSection *find(const std::string &name);
};

/// The tree of what is given; a repeated entry is a UserError. An entry of an included file may be
/// set again by the file that includes it, and any by the command line.
GivenSection collect(const std::vector<Statement> &statements);

/// Match with the declaration, check everything, add defaults: sections by path. UserErrors.
std::map<std::string, SectionValues> resolve(const SectionDeclaration &declaration,
                                             const GivenSection       &given,
                                             const std::string        &file_name);

/// Do the conditions hold for the choices made in this section?
bool holds(const std::vector<Condition> &conditions, const std::map<std::string, Value> &values);
} // namespace coracle::internal

namespace coracle
{
struct Parameters::Data
{
  /// Keeps the declarations alive that the values point to.
  std::shared_ptr<const internal::SectionDeclaration> root;
  std::string                                         file_name;
  std::map<std::string, internal::SectionValues>      sections;

  const internal::SectionValues &section(const std::string &path) const;
  const internal::Value &
  value(const std::string &path, const std::string &name, const internal::EntryKind kind) const;
};

struct ParameterFile::Data
{
  std::shared_ptr<const internal::SectionDeclaration> root;
  std::string                                         file_name;
  std::vector<internal::Statement>                    statements;
};
} // namespace coracle
