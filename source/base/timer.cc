// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <coracle/base/timer.h>

#include <algorithm>
#include <iomanip>

namespace coracle
{
namespace
{
/// What one rank knows of one entry.
struct Row
{
  std::string   path;
  std::uint64_t calls;
  double        seconds, n_items;
  std::string   item;

  template <typename Archive>
  void serialize(Archive &archive, const unsigned int /*version*/)
  {
    archive &path &calls &seconds &n_items &item;
  }
};

/// The same over ranks.
struct Summary
{
  Row    total;
  double least, most;
};

std::vector<Summary>
summarise(const std::vector<std::vector<Row>> &ranks)
{
  std::vector<Summary> result;
  for (const std::vector<Row> &rows : ranks)
    for (const Row &row : rows)
      {
        const auto known = std::find_if(result.begin(), result.end(), [&](const Summary &s) {
          return s.total.path == row.path;
        });
        if (known == result.end())
          {
            result.push_back({row, row.seconds, row.seconds});
            continue;
          }
        known->total.calls = std::max(known->total.calls, row.calls);
        known->total.seconds += row.seconds;
        known->total.n_items += row.n_items;
        known->least = std::min(known->least, row.seconds);
        known->most  = std::max(known->most, row.seconds);
      }
  return result;
}

/// Below its parent, in the order of the first calls.
std::vector<Summary>
as_tree(const std::vector<Summary> &rows, const std::string &parent)
{
  std::vector<Summary> result;
  for (const Summary &row : rows)
    {
      const std::size_t slash = row.total.path.rfind('/');
      if ((slash == std::string::npos ? "" : row.total.path.substr(0, slash)) != parent)
        continue;
      result.push_back(row);
      const auto below = as_tree(rows, row.total.path);
      result.insert(result.end(), below.begin(), below.end());
    }
  return result;
}

constexpr int name_width = 34;

void
print_row(std::ostream &out, const Summary &row, const unsigned int n_ranks, const double wall)
{
  const Row        &total = row.total;
  const std::size_t level = std::count(total.path.begin(), total.path.end(), '/');
  const std::string name =
    std::string(2 * level, ' ') + total.path.substr(total.path.rfind('/') + 1);
  out << "  " << std::left << std::setw(name_width) << name << std::right << std::setw(10)
      << total.calls << std::fixed << std::setprecision(2) << std::setw(11)
      << total.seconds / n_ranks << std::setprecision(1) << std::setw(8)
      << 100 * total.seconds / n_ranks / wall << " %" << std::setprecision(2) << std::setw(11)
      << row.least << std::setw(11) << row.most;
  if (total.n_items > 0)
    out << std::setprecision(1) << std::setw(11) << 1e9 * total.seconds / total.n_items << " / "
        << total.item;
  out << '\n';
}
} // namespace

TimingTable::TimingTable() : start(Clock::now()) {}

TimingTable::Running::Running(TimingTable &table, const std::string &name)
  : table(table), start(Clock::now())
{
  auto &entries = table.entries;
  auto  entry   = std::find_if(entries.begin(), entries.end(), [&](const Entry &e) {
    return e.parent == table.current && e.name == name;
  });
  if (entry == entries.end())
    {
      Entry added;
      added.name   = name;
      added.parent = table.current;
      entry        = entries.insert(entries.end(), added);
    }
  ++entry->calls;
  table.current = entry - entries.begin();
}

TimingTable::Running::~Running()
{
  Entry &entry = table.entries[table.current];
  entry.seconds += std::chrono::duration<double>(Clock::now() - start).count();
  table.current = entry.parent;
}

void
TimingTable::count(const std::string &item, const double n)
{
  if (current < 0)
    return;
  entries[current].item = item;
  entries[current].n_items += n;
}

std::string
TimingTable::path(const Entry &entry) const
{
  return (entry.parent < 0 ? "" : path(entries[entry.parent]) + "/") + entry.name;
}

double
TimingTable::seconds(const std::string &of_path) const
{
  for (const Entry &entry : entries)
    if (path(entry) == of_path)
      return entry.seconds;
  return 0;
}

void
TimingTable::print(std::ostream &out, const MPI_Comm comm) const
{
  std::vector<Row> rows;
  for (const Entry &entry : entries)
    rows.push_back({path(entry), entry.calls, entry.seconds, entry.n_items, entry.item});
  const auto         all_rows = dealii::Utilities::MPI::gather(comm, rows, 0);
  const unsigned int n_ranks  = dealii::Utilities::MPI::n_mpi_processes(comm);
  const double       wall =
    dealii::Utilities::MPI::max(std::chrono::duration<double>(Clock::now() - start).count(), comm);
  if (dealii::Utilities::MPI::this_mpi_process(comm) != 0)
    return;

  const std::ios_base::fmtflags flags     = out.flags();
  const std::streamsize         precision = out.precision();
  out << "  " << std::left << std::setw(name_width)
      << "timing (" + std::to_string(n_ranks) + (n_ranks == 1 ? " rank)" : " ranks)") << std::right
      << std::setw(10) << "calls" << std::setw(11) << "seconds" << std::setw(10) << "share"
      << std::setw(11) << "least" << std::setw(11) << "most" << std::setw(11) << "ns" << '\n';
  for (const Summary &row : as_tree(summarise(all_rows), ""))
    print_row(out, row, n_ranks, wall);
  out << "  " << std::left << std::setw(name_width + 10) << "wall-clock time" << std::right
      << std::fixed << std::setprecision(2) << std::setw(11) << wall << std::endl;
  out.flags(flags);
  out.precision(precision);
}
} // namespace coracle
