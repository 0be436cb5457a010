// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/parameter_declaration.h>
#include <coracle/base/units.h>

#include <algorithm>

namespace coracle
{
using internal::Condition;
using internal::EntryDeclaration;
using internal::EntryKind;
using internal::SectionDeclaration;

namespace
{
bool
same(const std::vector<Condition> &a, const std::vector<Condition> &b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto &x, const auto &y) {
    return x.key == y.key && x.option == y.option;
  });
}

EntryDeclaration
make_entry(const std::string &name,
           const EntryKind    kind,
           const std::string &default_value,
           const std::string &meaning)
{
  EntryDeclaration entry;
  entry.name          = name;
  entry.kind          = kind;
  entry.default_value = default_value;
  entry.meaning       = meaning;
  return entry;
}
} // namespace

EntryDeclaration &
Declaration::Data::add(const EntryDeclaration &entry)
{
  AssertThrow(entry.name.find_first_of("/=#") == std::string::npos && !entry.meaning.empty(),
              dealii::ExcMessage("Bad declaration of the parameter " + entry.name));
  for (const EntryDeclaration &other : section->entries)
    AssertThrow(other.name != entry.name || !same(other.conditions, conditions),
                dealii::ExcMessage("Parameter declared twice: " + section->name + "/" +
                                   entry.name));
  section->entries.push_back(entry);
  section->entries.back().conditions = conditions;
  // A default that a user could not write is found when the program starts, not when it is used.
  if (!entry.default_value.empty())
    internal::check_value(section->entries.back(), entry.default_value);
  return section->entries.back();
}

SectionDeclaration &
Declaration::Data::add_section(const std::string &name,
                               const std::string &item,
                               const std::string &meaning)
{
  for (auto &other : section->sections)
    if (other->name == name && same(other->conditions, conditions))
      return *other;
  AssertThrow(name.find_first_of("/=#") == std::string::npos && !meaning.empty(),
              dealii::ExcMessage("Bad declaration of the section " + name));
  section->sections.push_back(std::make_unique<SectionDeclaration>());
  SectionDeclaration &added = *section->sections.back();
  added.name                = name;
  added.item                = item;
  added.meaning             = meaning;
  added.conditions          = conditions;
  return added;
}

Declaration &
Declaration::Data::view(SectionDeclaration &of, const std::vector<Condition> &under)
{
  views.push_back(std::make_unique<Declaration>());
  views.back()->data->root       = root;
  views.back()->data->section    = &of;
  views.back()->data->conditions = under;
  return *views.back();
}

Declaration::Declaration() : data(std::make_unique<Data>())
{
  data->root    = std::make_shared<SectionDeclaration>();
  data->section = data->root.get();
}

Declaration::~Declaration() = default;

void
Declaration::quantity(const std::string &name,
                      const std::string &default_value,
                      const std::string &unit,
                      const std::string &symbol,
                      const std::string &meaning,
                      const double       minimum,
                      const double       maximum)
{
  EntryDeclaration entry = make_entry(name, EntryKind::quantity, default_value, meaning);
  entry.unit             = unit;
  entry.symbol           = symbol;
  entry.minimum          = minimum;
  entry.maximum          = maximum;
  data->add(entry);
}

void
Declaration::list(const std::string &name,
                  const std::string &default_value,
                  const std::string &unit,
                  const std::string &symbol,
                  const std::string &meaning)
{
  EntryDeclaration entry = make_entry(name, EntryKind::list, default_value, meaning);
  entry.unit             = unit;
  entry.symbol           = symbol;
  data->add(entry);
}

void
Declaration::integer(const std::string &name,
                     const int          default_value,
                     const std::string &meaning,
                     const int          minimum,
                     const int          maximum)
{
  EntryDeclaration entry =
    make_entry(name, EntryKind::integer, std::to_string(default_value), meaning);
  entry.minimum = minimum;
  entry.maximum = maximum;
  data->add(entry);
}

void
Declaration::flag(const std::string &name, const bool default_value, const std::string &meaning)
{
  data->add(make_entry(name, EntryKind::flag, default_value ? "true" : "false", meaning));
}

void
Declaration::choice(const std::string              &name,
                    const std::string              &default_value,
                    const std::vector<std::string> &options,
                    const std::string              &meaning)
{
  EntryDeclaration entry = make_entry(name, EntryKind::choice, default_value, meaning);
  entry.options          = options;
  data->add(entry);
}

void
Declaration::text(const std::string &name,
                  const std::string &default_value,
                  const std::string &meaning)
{
  data->add(make_entry(name, EntryKind::text, default_value, meaning));
}

void
Declaration::file(const std::string &name, const std::string &meaning)
{
  data->add(make_entry(name, EntryKind::file, "", meaning));
}

void
Declaration::function(const std::string &name,
                      const std::string &default_value,
                      const std::string &unit,
                      const std::string &meaning)
{
  EntryDeclaration entry = make_entry(name, EntryKind::function, default_value, meaning);
  entry.unit             = unit;
  data->add(entry);
}

Declaration &
Declaration::section(const std::string &name, const std::string &meaning)
{
  return data->view(data->add_section(name, "", meaning), {});
}

Declaration &
Declaration::named_sections(const std::string &name,
                            const std::string &item,
                            const std::string &meaning)
{
  return data->view(data->add_section(name, item, meaning), {});
}

Declaration &
Declaration::when(const std::string &key, const std::string &option)
{
  const auto choice =
    std::find_if(data->section->entries.begin(), data->section->entries.end(), [&](const auto &e) {
      return e.name == key && e.kind == EntryKind::choice &&
             std::find(e.options.begin(), e.options.end(), option) != e.options.end();
    });
  AssertThrow(choice != data->section->entries.end(),
              dealii::ExcMessage("No choice " + key + " with the option " + option));
  std::vector<Condition> conditions = data->conditions;
  conditions.push_back({key, option});
  return data->view(*data->section, conditions);
}
} // namespace coracle
