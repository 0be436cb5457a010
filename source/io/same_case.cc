// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/same_case.h>

#include <algorithm>
#include <map>

namespace coracle
{
namespace
{
/// Entries, and with a slash at their ends sections, that may change.
const std::vector<std::string> free_entries = {"End time",
                                               "Time/",
                                               "Output/",
                                               "Checkpoint/",
                                               "Contact/Tolerance",
                                               "Contact/Maximum iterations",
                                               "Contact/Maximum position iterations",
                                               "Contact/Accelerate",
                                               "Contact/Skin",
                                               "Contact/Search",
                                               "Contact/Initial overlap"};

bool
may_change(const std::string &path)
{
  return std::any_of(free_entries.begin(), free_entries.end(), [&path](const std::string &entry) {
    return entry.back() == '/' ? path.compare(0, entry.size(), entry) == 0 : path == entry;
  });
}

std::string
in_quotes(const std::string &text)
{
  return text.empty() ? "empty" : "'" + text + "'";
}

bool
is_same(const Parameters::Entry &a, const Parameters::Entry &b)
{
  return a.text == b.text || (!a.numbers.empty() && a.numbers == b.numbers);
}
} // namespace

std::vector<std::string>
check_same_case(const Parameters &now, const Parameters &then)
{
  std::map<std::string, Parameters::Entry> before;
  for (const auto &entry : then.entries())
    before.emplace(entry.path, entry);

  std::vector<std::string> changed, forbidden;
  std::string              where;
  const auto               note =
    [&](const std::string &path, const std::string &what, const std::string &place) {
      (may_change(path) ? changed : forbidden).push_back(path + ": " + what);
      if (!may_change(path) && where.empty())
        where = place;
    };
  for (const auto &entry : now.entries())
    {
      const auto found = before.find(entry.path);
      if (found == before.end())
        note(entry.path, "was not there, is " + in_quotes(entry.text), entry.where);
      else if (!is_same(entry, found->second))
        note(entry.path,
             "was " + in_quotes(found->second.text) + ", is " + in_quotes(entry.text),
             entry.where);
      if (found != before.end())
        before.erase(found);
    }
  for (const auto &[path, entry] : before)
    note(path, "was " + in_quotes(entry.text) + ", is not there", path);

  if (forbidden.empty())
    return changed;
  std::string found;
  for (const std::string &line : forbidden)
    found += (found.empty() ? "" : "\n") + line;
  throw UserError("this is not the case that is to be continued",
                  where,
                  found,
                  "take these entries back, or run the case from its start, without --restart");
}
} // namespace coracle
