// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/key_directory.h>

namespace coracle
{
namespace
{
using Keys = std::map<unsigned int, std::vector<std::uint64_t>>;
using Rows = std::map<unsigned int, std::vector<double>>;
} // namespace

KeyDirectory::KeyDirectory(const unsigned int n_columns, const MPI_Comm comm)
  : n_columns(n_columns), n_ranks(mpi::n_ranks(comm)), comm(comm)
{}

unsigned int
KeyDirectory::home(const std::uint64_t key) const
{
  // Neighbouring keys are on one rank already: the multiplier spreads them.
  return (key * 0x9E3779B97F4A7C15ull >> 32) % n_ranks;
}

void
KeyDirectory::add(const std::vector<std::uint64_t> &keys, const Columns &rows)
{
  AssertDimension(rows.n_columns(), n_columns);
  Keys                keys_sent;
  Rows                rows_sent;
  std::vector<double> row(n_columns);
  for (std::size_t i = 0; i < keys.size(); ++i)
    {
      const unsigned int to = home(keys[i]);
      keys_sent[to].push_back(keys[i]);
      if (n_columns == 0)
        continue;
      rows.get_row(i, row.data());
      auto &message = rows_sent[to];
      message.insert(message.end(), row.begin(), row.end());
    }
  const Keys keys_received = mpi::exchange_values(keys_sent, comm);
  const Rows rows_received = mpi::exchange_values(rows_sent, comm);
  for (const auto &[rank, some] : keys_received)
    for (std::size_t i = 0; i < some.size(); ++i)
      if (row_of_key.emplace(some[i], row_of_key.size()).second && n_columns > 0)
        {
          const double *const values = rows_received.at(rank).data() + i * n_columns;
          kept.insert(kept.end(), values, values + n_columns);
        }
}

std::vector<bool>
KeyDirectory::find(const std::vector<std::uint64_t> &keys, Columns &rows) const
{
  Keys                                             asked;
  std::map<unsigned int, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < keys.size(); ++i)
    {
      asked[home(keys[i])].push_back(keys[i]);
      places[home(keys[i])].push_back(i);
    }
  // Whether it is there, and the row.
  Rows answers;
  for (const auto &[rank, some] : mpi::exchange_values(asked, comm))
    {
      auto &answer = answers[rank];
      answer.reserve(some.size() * (1 + n_columns));
      for (const std::uint64_t key : some)
        {
          const auto found = row_of_key.find(key);
          answer.push_back(found != row_of_key.end());
          if (found == row_of_key.end())
            answer.resize(answer.size() + n_columns);
          else
            answer.insert(answer.end(),
                          kept.data() + found->second * n_columns,
                          kept.data() + (found->second + 1) * n_columns);
        }
    }
  std::vector<bool> result(keys.size());
  for (const auto &[rank, answer] : mpi::exchange_values(answers, comm))
    for (std::size_t i = 0; i < places[rank].size(); ++i)
      if (const double *const entry = &answer[i * (1 + n_columns)]; *entry > 0)
        {
          result[places[rank][i]] = true;
          if (n_columns > 0)
            rows.set_row(places[rank][i], entry + 1);
        }
  return result;
}
} // namespace coracle
