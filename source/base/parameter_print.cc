// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/parameter_values.h>
#include <coracle/base/units.h>

#include <algorithm>
#include <sstream>

namespace coracle
{
using internal::Condition;
using internal::EntryDeclaration;
using internal::SectionDeclaration;

namespace
{
std::string
describe(const std::vector<Condition> &conditions)
{
  std::vector<std::string> words;
  for (const Condition &condition : conditions)
    words.push_back(condition.key + " = " + condition.option);
  return internal::join(words, " and ");
}

std::string
assignment(const std::string &name, const std::string &value)
{
  return "set " + name + (value.empty() ? " =" : " = " + value);
}

/// With a full stop, whether the declaration has it or not.
std::string
sentence(const std::string &text)
{
  return text.back() == '.' ? text : text + ".";
}

/// The file as used.
class UsedPrinter
{
public:
  explicit UsedPrinter(const std::map<std::string, internal::SectionValues> &sections)
    : sections(sections)
  {}

  std::string print()
  {
    section("", 0);
    return out.str();
  }

private:
  void section(const std::string &path, const unsigned int level)
  {
    const std::string              indent(2 * level, ' ');
    const internal::SectionValues &values = sections.at(path);
    // Entries in the order of their declaration, which is the order of the documentation.
    if (values.declaration->item.empty() || !values.values.empty())
      for (const EntryDeclaration &entry : values.declaration->entries)
        if (const auto value = values.values.find(entry.name);
            value != values.values.end() && value->second.entry == &entry)
          out << indent << assignment(entry.name, value->second.text) << '\n';
    for (const std::string &name : values.section_names)
      {
        out << indent << "subsection " << name << '\n';
        section(internal::join_path(path, name), level + 1);
        out << indent << "end\n";
      }
  }

  const std::map<std::string, internal::SectionValues> &sections;
  std::ostringstream                                    out;
};

/// All defaults with their meaning, as a file; what would not be accepted stands in comments.
class DefaultsPrinter
{
public:
  std::string print(const SectionDeclaration &root)
  {
    contents(root, 0, "");
    return out.str();
  }

private:
  void
  contents(const SectionDeclaration &section, const unsigned int level, const std::string &mark)
  {
    for (const EntryDeclaration &entry : section.entries)
      this->entry(section, entry, mark + std::string(2 * level, ' '));
    for (const auto &subsection : section.sections)
      this->section(section, *subsection, level, mark);
  }

  void
  entry(const SectionDeclaration &section, const EntryDeclaration &entry, const std::string &indent)
  {
    const bool active = indent.substr(0, 1) == "#" || applies(section, entry.conditions);
    separate();
    out << indent << "# " << sentence(entry.meaning) << " (" << internal::describe_values(entry)
        << (entry.symbol.empty() ? "" : "; symbol " + entry.symbol) << ')' << '\n';
    if (!entry.conditions.empty())
      out << indent << "# Only where " << describe(entry.conditions) << ".\n";
    // An empty quantity has no default: it must be set where it is used.
    const bool required =
      entry.default_value.empty() && entry.kind == internal::EntryKind::quantity;
    out << indent << (active && !required ? "" : "# ")
        << assignment(entry.name, entry.default_value) << '\n';
  }

  void section(const SectionDeclaration &parent,
               const SectionDeclaration &section,
               const unsigned int        level,
               const std::string        &mark)
  {
    const std::string below  = applies(parent, section.conditions) ? mark : "# ";
    const std::string indent = below + std::string(2 * level, ' ');
    separate();
    out << mark << std::string(2 * level, ' ') << "# " << sentence(section.meaning) << '\n';
    if (!section.conditions.empty())
      out << indent << "# Only where " << describe(section.conditions) << ".\n";
    out << indent << "subsection " << section.name << '\n';
    begins = true;
    if (section.item.empty())
      contents(section, level + 1, below);
    else
      {
        const std::string inner = "# " + std::string(2 * (level + 1), ' ');
        out << inner << "subsection <name of the " << section.item << ">\n";
        begins = true;
        contents(section, level + 2, "# ");
        out << inner << "end\n";
      }
    out << indent << "end\n";
  }

  /// A blank line between entries, none at the beginning of a section.
  void separate()
  {
    out << (begins ? "" : "\n");
    begins = false;
  }

  /// Do the conditions hold when everything has its default?
  static bool applies(const SectionDeclaration &section, const std::vector<Condition> &conditions)
  {
    return std::all_of(conditions.begin(), conditions.end(), [&](const Condition &condition) {
      return std::any_of(section.entries.begin(), section.entries.end(), [&](const auto &entry) {
        return entry.name == condition.key && entry.default_value == condition.option &&
               applies(section, entry.conditions);
      });
    });
  }

  std::ostringstream out;
  bool               begins = true;
};

/// One table a section.
class MarkdownPrinter
{
public:
  std::string print(const SectionDeclaration &root)
  {
    out
      << "# Parameters\n\n"
         "Generated by `contrib/update_parameters_reference` from the declarations in the code.\n\n"
         "A parameter file has lines `set Name = value`, grouped by `subsection Name` ... `end`; "
         "`#`\n"
         "begins a comment, a `\\` at the end of a line goes on, and `include file` reads another "
         "file,\n"
         "whose entries may be set again. Numbers may carry a unit (`20 mm`, `1.2 g/cm^3`, `50 "
         "kN/m`,\n"
         "`3 Pa s`, `4 J/(kg K)`); without one they are in SI. In lists each number has its unit, "
         "or the\n"
         "last one's holds for all. Entries without a default must be set where they are used.\n";
    contents(root, "");
    return out.str();
  }

private:
  void contents(const SectionDeclaration &section, const std::string &path)
  {
    if (!section.entries.empty())
      out << "\n| Entry | Default | Value | Symbol | Meaning |\n|---|---|---|---|---|\n";
    for (const EntryDeclaration &entry : section.entries)
      out << "| `" << entry.name << "` | "
          << (entry.default_value.empty() ? "" : "`" + cell(entry.default_value) + "`") << " | "
          << cell(internal::describe_values(entry)) << " | " << cell(entry.symbol) << " | "
          << cell(sentence(entry.meaning))
          << (entry.conditions.empty() ? "" : " *Where " + describe(entry.conditions) + ".*")
          << " |\n";
    for (const auto &subsection : section.sections)
      {
        const std::string name  = subsection->item.empty() ? "" : "/<" + subsection->item + ">";
        const std::string below = internal::join_path(path, subsection->name + name);
        out << "\n## `" << below << "`\n\n"
            << sentence(subsection->meaning)
            << (subsection->conditions.empty()
                  ? ""
                  : " *Where " + describe(subsection->conditions) + ".*")
            << '\n';
        contents(*subsection, below);
      }
  }

  /// A bar would end the table's cell.
  static std::string cell(std::string text)
  {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
      text.insert(at, "\\");
    return text;
  }

  std::ostringstream out;
};
} // namespace

std::string
ParameterFile::print() const
{
  return UsedPrinter(parameters().data->sections).print();
}

std::string
ParameterFile::print_defaults() const
{
  return DefaultsPrinter().print(*data->root);
}

std::string
ParameterFile::print_markdown() const
{
  return MarkdownPrinter().print(*data->root);
}
} // namespace coracle
