// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <coracle/base/exceptions.h>
#include <coracle/base/log.h>

#include <boost/serialization/map.hpp>

namespace coracle
{
namespace
{
constexpr unsigned int n_shown = 5;
}

Log::Tee::Tee(std::streambuf *const console) : console(console) {}

void
Log::Tee::open(const std::string &file_name, const bool append)
{
  file.open(file_name, append ? std::ios::app : std::ios::out);
  file << kept << std::flush;
  if (!file)
    throw UserError("a file cannot be written",
                    file_name,
                    "the log of the run could not be created",
                    "set Output/Directory to a folder that you may write to");
  kept.clear();
}

int
Log::Tee::overflow(const int character)
{
  if (character == traits_type::eof() || console == nullptr)
    return traits_type::not_eof(character);
  console->sputc(static_cast<char>(character));
  if (file.is_open())
    file.put(static_cast<char>(character));
  else
    kept += static_cast<char>(character);
  return character;
}

int
Log::Tee::sync()
{
  if (file.is_open())
    file.flush();
  return console == nullptr ? 0 : console->pubsync();
}

Log::Log(const MPI_Comm comm, std::ostream &console)
  : comm(comm)
  , writes(dealii::Utilities::MPI::this_mpi_process(comm) == 0)
  , tee(writes ? console.rdbuf() : nullptr)
  , stream(&tee)
{}

Log::~Log() = default;

void
Log::open(const std::string &file_name, const bool append)
{
  if (writes)
    tee.open(file_name, append);
}

void
Log::warning(const std::string &kind, const std::string &details)
{
  Warnings &warnings = incoming[kind];
  ++warnings.n;
  if (warnings.first.size() < n_shown)
    warnings.first.push_back(details);
}

void
Log::report()
{
  // Mostly there is nothing to tell, which costs one reduction.
  if (dealii::Utilities::MPI::max(static_cast<unsigned int>(incoming.size()), comm) == 0)
    return;
  const auto of_all_ranks = dealii::Utilities::MPI::gather(comm, incoming, 0);
  incoming.clear();
  for (const auto &of_one_rank : of_all_ranks)
    for (const auto &[kind, warnings] : of_one_rank)
      {
        std::uint64_t &n = reported[kind];
        for (unsigned int i = 0; i < warnings.first.size() && n + i < n_shown; ++i)
          stream << "warning: " << kind << ": " << warnings.first[i] << '\n';
        if (n < n_shown && n + warnings.n >= n_shown)
          stream << "         (further warnings of this kind are counted)\n";
        n += warnings.n;
      }
  stream << std::flush;
}

void
Log::finish()
{
  report();
  for (const auto &[kind, n] : reported)
    if (n > n_shown)
      stream << "warning: " << kind << ": " << n << " times in all\n";
  stream << std::flush;
}

std::size_t
Log::n_warnings() const
{
  std::size_t result = 0;
  for (const auto &[kind, n] : reported)
    result += n;
  return result;
}
} // namespace coracle
