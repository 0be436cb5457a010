// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace coracle
{
/**
 * What a run says: rank 0 writes to the console and, once it is open, to a file
 * that also receives what was said before. Other ranks write to nowhere.
 *
 * Warnings may come from any rank at any time. They are shown at the next
 * report(), the first five of a kind; the rest are counted.
 */
class Log
{
public:
  explicit Log(const MPI_Comm comm, std::ostream &console = std::cout);
  ~Log();

  /// For everything that is not a warning.
  std::ostream &out() { return stream; }

  /// Rank 0 goes on in this file, which is replaced, or gets longer. A UserError (on rank 0) if it
  /// cannot be written.
  void open(const std::string &file_name, const bool append = false);

  /// Not collective.
  void warning(const std::string &kind, const std::string &details);

  /// Show what has come in. Collective.
  void report();

  /// Show what has come in, and how often each kind came. Collective.
  void finish();

  /// Warnings so far, as far as reported; on rank 0.
  std::size_t n_warnings() const;

private:
  struct Warnings
  {
    std::uint64_t            n = 0;
    std::vector<std::string> first;

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &n &first;
    }
  };

  /// Everything written goes to the console and to the file (or is kept for it).
  class Tee : public std::streambuf
  {
  public:
    explicit Tee(std::streambuf *console);
    void open(const std::string &file_name, const bool append);

  protected:
    int overflow(int character) override;
    int sync() override;

  private:
    std::streambuf *console;
    std::string     kept;
    std::ofstream   file;
  };

  MPI_Comm                        comm;
  bool                            writes;
  Tee                             tee;
  std::ostream                    stream;
  std::map<std::string, Warnings> incoming;
  /// On rank 0: how many of each kind were reported.
  std::map<std::string, std::uint64_t> reported;
};
} // namespace coracle
