// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace coracle
{
/**
 * Wall-clock time by name. An object of this class is called with a name and a
 * function, whose result it gives back:
 *
 *   const double dt = timed("time step", [&] { return choose_time_step(); });
 *
 * What is timed inside another timed function appears below it, indented. Items
 * (particles, elements) worked on may be counted, and the table then shows
 * nanoseconds for one.
 */
class TimingTable
{
public:
  TimingTable();

  template <typename Function>
  auto operator()(const std::string &name, const Function &function)
  {
    const Running running(*this, name);
    return function();
  }

  /// n items were worked on inside the function that is being timed; `item` as in "particle".
  void count(const std::string &item, const double n);

  /// Seconds so far in all calls of a name, on this rank; path as in "contact/search".
  double seconds(const std::string &path) const;

  /// Calls, seconds (mean over ranks), share of the time since construction, least and most of the
  /// ranks, and processor time per item. Collective; rank 0 writes.
  void print(std::ostream &out, const MPI_Comm comm) const;

private:
  using Clock = std::chrono::steady_clock;

  struct Entry
  {
    std::string   name;
    int           parent  = -1;
    std::uint64_t calls   = 0;
    double        seconds = 0;
    double        n_items = 0;
    std::string   item;
  };

  /// Ends the timing also when the function throws.
  class Running
  {
  public:
    Running(TimingTable &table, const std::string &name);
    ~Running();

  private:
    TimingTable            &table;
    const Clock::time_point start;
  };

  std::string path(const Entry &entry) const;

  std::vector<Entry> entries;
  int                current = -1;
  Clock::time_point  start;
};
} // namespace coracle
