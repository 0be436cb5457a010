// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/parameter_values.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace coracle::internal
{
namespace
{
const Value *
find_value(const std::map<std::string, Value> &values, const std::string &name)
{
  const auto found = values.find(name);
  return found == values.end() ? nullptr : &found->second;
}

/// "Kind = material points"
std::string
describe(const std::vector<Condition> &conditions)
{
  std::vector<std::string> words;
  for (const Condition &condition : conditions)
    words.push_back(condition.key + " = " + condition.option);
  return join(words, " and ");
}

/// "Kind = material points or Kind = rigid" for all declarations of this name.
template <typename Declarations>
std::string
describe_alternatives(const Declarations &declarations, const std::string &name)
{
  std::vector<std::string> alternatives;
  for (const auto &declaration : declarations)
    if (declaration->name == name)
      alternatives.push_back(describe(declaration->conditions));
  return join(alternatives, " or ");
}

/// The section that does have an entry of this name, as a path, or "".
std::string
home_of(const std::string &entry, const SectionDeclaration &section, const std::string &path)
{
  for (const auto &e : section.entries)
    if (e.name == entry && !path.empty())
      return path;
  for (const auto &s : section.sections)
    {
      const std::string name = s->name + (s->item.empty() ? "" : "/<" + s->item + ">");
      if (const std::string home = home_of(entry, *s, join_path(path, name)); !home.empty())
        return home;
    }
  return "";
}

/// Walks declaration and file side by side.
class Resolver
{
public:
  explicit Resolver(const SectionDeclaration &root, const std::string &file_name)
    : root(root), file_name(file_name)
  {}

  void
  section(const SectionDeclaration &declaration, const GivenSection &given, const std::string &path)
  {
    SectionValues &result = sections[path];
    result.declaration    = &declaration;
    result.location       = given.location;
    refuse_unknown_entries(declaration, given, path);
    for (const EntryDeclaration &entry : declaration.entries)
      if (holds(entry.conditions, result.values))
        result.values[entry.name] = value(entry, given, path);
    refuse_entries_of_other_options(declaration, given, path);
    refuse_unknown_sections(declaration, given, path);
    for (const auto &subsection : declaration.sections)
      if (holds(subsection->conditions, sections[path].values))
        {
          sections[path].section_names.push_back(subsection->name);
          named_or_plain(*subsection, given, join_path(path, subsection->name));
        }
  }

  std::map<std::string, SectionValues> sections;

private:
  void named_or_plain(const SectionDeclaration &declaration,
                      const GivenSection       &parent,
                      const std::string        &path)
  {
    static const GivenSection nothing;
    const GivenSection       *given = &nothing;
    for (const auto &[name, subsection] : parent.sections)
      if (name == declaration.name)
        given = &subsection;
    if (declaration.item.empty())
      {
        section(declaration, *given, path);
        return;
      }
    sections[path].declaration = &declaration;
    sections[path].location    = given->location;
    if (!given->statements.empty())
      {
        const auto &[key, statement] = *given->statements.begin();
        throw UserError("an entry stands outside its " + declaration.item,
                        internal::describe(statement.location, join_path(path, key)),
                        "'" + key + "' stands directly in '" + declaration.name + "'",
                        "put it into a subsection of its own, 'subsection <name of the " +
                          declaration.item + ">' ... 'end'");
      }
    for (const auto &[name, subsection] : given->sections)
      {
        if (subsection.location.file.empty())
          throw UserError("a section is not known",
                          internal::describe(subsection.location, join_path(path, name)),
                          "the parameter file has no " + declaration.item + " '" + name + "'",
                          suggest(name, sections[path].section_names));
        sections[path].section_names.push_back(name);
        section(declaration, subsection, join_path(path, name));
      }
  }

  Value value(const EntryDeclaration &entry, const GivenSection &given, const std::string &path)
  {
    Value      result{&entry, entry.default_value, {}, false, {file_name, 0, 0}};
    const auto statement = given.statements.find(entry.name);
    if (statement != given.statements.end())
      {
        result.given    = true;
        result.text     = statement->second.value;
        result.location = statement->second.location;
      }
    if (!result.given && result.text.empty())
      return result;
    const std::string where = internal::describe(result.location, join_path(path, entry.name));
    try
      {
        result.numbers = check_value(entry, result.text);
      }
    catch (const ValueError &error)
      {
        throw UserError("a value is not accepted", where, error.found, error.cure);
      }
    if (entry.kind == EntryKind::file && !result.text.empty())
      result.text = existing_file(result, where);
    return result;
  }

  std::string existing_file(const Value &value, const std::string &where) const
  {
    namespace fs            = std::filesystem;
    const std::string &from = value.location.file.empty() ? file_name : value.location.file;
    const fs::path     path = fs::absolute(fs::path(from).parent_path() / value.text);
    std::error_code    ignored;
    if (!fs::is_regular_file(path, ignored))
      throw UserError("a file does not exist",
                      where,
                      "there is no file '" + path.lexically_normal().string() + "'",
                      "correct the name; it is relative to the folder of the parameter file");
    return path.lexically_normal().string();
  }

  void refuse_unknown_entries(const SectionDeclaration &declaration,
                              const GivenSection       &given,
                              const std::string        &path) const
  {
    std::vector<std::string> known;
    for (const EntryDeclaration &entry : declaration.entries)
      if (std::find(known.begin(), known.end(), entry.name) == known.end())
        known.push_back(entry.name);
    for (const auto &[key, statement] : given.statements)
      if (std::find(known.begin(), known.end(), key) == known.end())
        {
          const std::string home = home_of(key, root, "");
          throw UserError("an entry is not known",
                          internal::describe(statement.location, join_path(path, key)),
                          "'" + key + "' is not an entry " + of_section(path),
                          home.empty() ? suggest(key, known)
                                       : "'" + key + "' belongs into the section " + home);
        }
  }

  void refuse_entries_of_other_options(const SectionDeclaration &declaration,
                                       const GivenSection       &given,
                                       const std::string        &path) const
  {
    const auto                           &values = sections.at(path).values;
    std::vector<const EntryDeclaration *> entries;
    for (const EntryDeclaration &entry : declaration.entries)
      entries.push_back(&entry);
    for (const auto &[key, statement] : given.statements)
      if (find_value(values, key) == nullptr)
        throw UserError("an entry does not apply",
                        internal::describe(statement.location, join_path(path, key)),
                        "'" + key + "' is allowed only where " +
                          describe_alternatives(entries, key) + ", but " +
                          made_choices(entries, key, values),
                        "remove it, or make the choice that it belongs to");
  }

  /// "Kind is rigid": the first condition that does not hold.
  static std::string made_choices(const std::vector<const EntryDeclaration *> &entries,
                                  const std::string                           &name,
                                  const std::map<std::string, Value>          &values)
  {
    for (const EntryDeclaration *entry : entries)
      if (entry->name == name)
        for (const Condition &condition : entry->conditions)
          if (const Value *choice = find_value(values, condition.key);
              choice != nullptr && choice->text != condition.option)
            return condition.key + " is " + choice->text + (choice->given ? "" : " (the default)");
    return "that choice does not apply here";
  }

  void refuse_unknown_sections(const SectionDeclaration &declaration,
                               const GivenSection       &given,
                               const std::string        &path) const
  {
    std::vector<std::string>                known;
    std::vector<const SectionDeclaration *> declared;
    for (const auto &section : declaration.sections)
      {
        known.push_back(section->name);
        declared.push_back(section.get());
      }
    for (const auto &[name, subsection] : given.sections)
      {
        const std::string where    = internal::describe(subsection.location, join_path(path, name));
        bool              is_known = false, applies = false;
        for (const auto *section : declared)
          if (section->name == name)
            {
              is_known = true;
              applies |= holds(section->conditions, sections.at(path).values);
            }
        if (!is_known)
          throw UserError("a section is not known",
                          where,
                          "'" + name + "' is not a section " + of_section(path),
                          suggest(name, known));
        if (!applies)
          throw UserError("a section does not apply",
                          where,
                          "'" + name + "' is allowed only where " +
                            describe_alternatives(declared, name),
                          "remove it, or make the choice that it belongs to");
      }
  }

  static std::string of_section(const std::string &path)
  {
    return path.empty() ? "of the whole (outside all sections)" : "of " + path;
  }

  const SectionDeclaration &root;
  const std::string         file_name;
};
} // namespace

bool
holds(const std::vector<Condition> &conditions, const std::map<std::string, Value> &values)
{
  return std::all_of(conditions.begin(), conditions.end(), [&](const Condition &condition) {
    const Value *choice = find_value(values, condition.key);
    return choice != nullptr && choice->text == condition.option;
  });
}

GivenSection *
GivenSection::find(const std::string &name)
{
  for (auto &[other, section] : sections)
    if (other == name)
      return &section;
  return nullptr;
}

GivenSection
collect(const std::vector<Statement> &statements)
{
  GivenSection root;
  for (const Statement &statement : statements)
    {
      GivenSection *section = &root;
      for (const std::string &name : statement.sections)
        {
          GivenSection *next = section->find(name);
          if (next == nullptr)
            {
              next           = &section->sections.emplace_back(name, GivenSection()).second;
              next->location = statement.location;
            }
          section = next;
        }
      if (statement.key.empty())
        continue;
      const auto previous = section->statements.find(statement.key);
      if (previous != section->statements.end())
        {
          const Location &first = previous->second.location;
          if (!statement.location.file.empty() && first.depth <= statement.location.depth)
            throw UserError("an entry is set twice",
                            describe(statement.location,
                                     join_path(join(statement.sections, "/"), statement.key)),
                            "'" + previous->second.value + "' in " + describe(first, "") +
                              ", and '" + statement.value + "' here",
                            "remove one of the two");
          section->statements.erase(previous);
        }
      section->statements.emplace(statement.key, statement);
    }
  return root;
}

std::map<std::string, SectionValues>
resolve(const SectionDeclaration &declaration,
        const GivenSection       &given,
        const std::string        &file_name)
{
  Resolver resolver(declaration, file_name);
  resolver.section(declaration, given, "");
  return std::move(resolver.sections);
}
} // namespace coracle::internal
