// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/parameter_values.h>
#include <coracle/base/units.h>

#include <deal.II/base/function_parser.h>

#include <algorithm>
#include <iostream>
#include <sstream>

namespace coracle
{
using internal::EntryKind;

namespace
{
/// deal.II's parser writes its errors to the error stream besides throwing them.
class QuietErrorStream
{
public:
  QuietErrorStream() : before(std::cerr.rdbuf(swallowed.rdbuf())) {}
  ~QuietErrorStream() { std::cerr.rdbuf(before); }

private:
  std::ostringstream    swallowed;
  std::streambuf *const before;
};
} // namespace

const internal::SectionValues &
Parameters::Data::section(const std::string &path) const
{
  const auto found = sections.find(path);
  AssertThrow(found != sections.end(),
              dealii::ExcMessage("The parameter section '" + path + "' is not declared"));
  return found->second;
}

const internal::Value &
Parameters::Data::value(const std::string &path,
                        const std::string &name,
                        const EntryKind    kind) const
{
  const auto &values = section(path).values;
  const auto  found  = values.find(name);
  AssertThrow(found != values.end() && found->second.entry->kind == kind,
              dealii::ExcMessage("The parameter '" + path + "/" + name +
                                 "' is not declared, or with another kind"));
  return found->second;
}

double
Parameters::quantity(const std::string &name) const
{
  const internal::Value &value = data->value(section_path, name, EntryKind::quantity);
  if (value.numbers.empty())
    throw error(name,
                "a value is missing",
                "'" + name + "' is not set and has no default",
                "set it: " + internal::describe_values(*value.entry));
  return value.numbers[0];
}

std::vector<double>
Parameters::list(const std::string &name) const
{
  return data->value(section_path, name, EntryKind::list).numbers;
}

int
Parameters::integer(const std::string &name) const
{
  return static_cast<int>(data->value(section_path, name, EntryKind::integer).numbers[0]);
}

bool
Parameters::flag(const std::string &name) const
{
  return data->value(section_path, name, EntryKind::flag).numbers[0] != 0.;
}

std::string
Parameters::choice(const std::string &name) const
{
  return data->value(section_path, name, EntryKind::choice).text;
}

std::string
Parameters::text(const std::string &name) const
{
  return data->value(section_path, name, EntryKind::text).text;
}

std::string
Parameters::file(const std::string &name) const
{
  return data->value(section_path, name, EntryKind::file).text;
}

template <int dim>
dealii::Point<dim>
Parameters::point(const std::string &name) const
{
  const std::vector<double> values = list(name);
  if (values.size() != dim && !values.empty())
    throw error(name,
                "a point has the wrong number of coordinates",
                std::to_string(values.size()) + " numbers, in " + std::to_string(dim) +
                  " dimensions",
                "give " + std::to_string(dim) + " numbers, separated by commas");
  dealii::Point<dim> point;
  std::copy(values.begin(), values.end(), point.begin_raw());
  return point;
}

template <int dim>
std::unique_ptr<dealii::Function<dim>>
Parameters::function(const std::string &name, const unsigned int n_components) const
{
  const std::string        text        = data->value(section_path, name, EntryKind::function).text;
  std::vector<std::string> expressions = split_and_trim(text, ';');
  if (expressions.empty())
    expressions.assign(n_components, "0");
  if (expressions.size() != n_components)
    throw error(name,
                "a function has the wrong number of components",
                std::to_string(expressions.size()) + " expressions in '" + text + "'",
                "give " + std::to_string(n_components) + ", separated by ';'");

  auto function = std::make_unique<dealii::FunctionParser<dim>>(n_components);
  try
    {
      const QuietErrorStream quiet;
      function->initialize(dim == 2 ? "x,y,t" : "x,y,z,t",
                           expressions,
                           {{"pi", dealii::numbers::PI}},
                           true);
      // Expressions are translated at their first use.
      for (unsigned int c = 0; c < n_components; ++c)
        function->value(dealii::Point<dim>(), c);
    }
  catch (const dealii::ExceptionBase &exception)
    {
      std::ostringstream reason;
      exception.print_info(reason);
      throw error(name,
                  "an expression is not understood",
                  "'" + text + "'\n" + trim(reason.str()),
                  std::string("write expressions in ") + (dim == 2 ? "x, y, t" : "x, y, z, t") +
                    " and pi, with + - * / ^, if(a, b, c) and functions such as sin, exp, max");
    }
  return function;
}

bool
Parameters::is_set(const std::string &name) const
{
  const auto &values = data->section(section_path).values;
  const auto  found  = values.find(name);
  return found != values.end() && found->second.given;
}

Parameters
Parameters::section(const std::string &name) const
{
  Parameters result   = *this;
  result.section_path = internal::join_path(section_path, name);
  data->section(result.section_path);
  return result;
}

std::vector<std::string>
Parameters::section_names() const
{
  return data->section(section_path).section_names;
}

std::string
Parameters::name() const
{
  return section_path.substr(section_path.rfind('/') + 1);
}

std::string
Parameters::path() const
{
  return section_path;
}

std::vector<Parameters::Entry>
Parameters::entries() const
{
  std::vector<Entry> result;
  const std::string  below = (section_path.empty() ? "" : section_path + "/");
  for (const auto &[path, section] : data->sections)
    {
      if (path != section_path && path.compare(0, below.size(), below) != 0)
        continue;
      if (!section.declaration->item.empty())
        result.push_back({path, internal::join(section.section_names), {}, path});
      for (const auto &[name, value] : section.values)
        {
          internal::Location location = value.location;
          if (location.file.empty() && !value.given)
            location.file = data->file_name;
          const std::string entry = internal::join_path(path, name);
          result.push_back({entry, value.text, value.numbers, internal::describe(location, entry)});
        }
    }
  return result;
}

UserError
Parameters::error(const std::string &entry,
                  const std::string &title,
                  const std::string &found,
                  const std::string &cure) const
{
  const internal::SectionValues &section  = data->section(section_path);
  const auto                     value    = section.values.find(entry);
  internal::Location             location = section.location;
  if (value != section.values.end() && value->second.given)
    location = value->second.location;
  else if (location.file.empty())
    location.file = data->file_name;
  const bool is_default = value != section.values.end() && !value->second.given;
  return UserError(title,
                   internal::describe(location, internal::join_path(section_path, entry)) +
                     (is_default ? " (not set there)" : ""),
                   found,
                   cure);
}

template dealii::Point<2>                     Parameters::point(const std::string &) const;
template dealii::Point<3>                     Parameters::point(const std::string &) const;
template std::unique_ptr<dealii::Function<2>> Parameters::function(const std::string &,
                                                                   const unsigned int) const;
template std::unique_ptr<dealii::Function<3>> Parameters::function(const std::string &,
                                                                   const unsigned int) const;
} // namespace coracle
