// SPDX-License-Identifier: GPL-3.0-or-later
// Rows are found by their keys from any rank, whichever rank brought them, and unknown keys are
// said to be unknown; no rank keeps many more than its share.
#include <coracle/base/key_directory.h>

#include "tests.h"

using namespace coracle;

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog << std::boolalpha;
  const MPI_Comm     comm = MPI_COMM_WORLD;
  const unsigned int rank = mpi::rank(comm), n_ranks = mpi::n_ranks(comm);
  // All rows are on the last rank, in two helpings.
  KeyDirectory directory(2, comm), set(0, comm);
  const auto   value = [](const std::uint64_t key) { return std::sqrt(double(key)); };
  for (unsigned int helping = 0; helping < 2; ++helping)
    {
      std::vector<std::uint64_t> keys;
      for (std::uint64_t i = 0; rank == n_ranks - 1 && i < 500; ++i)
        keys.push_back(((500 * helping + i) << 34) + 1);
      Columns rows(2), none;
      rows.resize(keys.size());
      for (std::size_t i = 0; i < keys.size(); ++i)
        {
          rows[0][i] = value(keys[i]);
          rows[1][i] = helping;
        }
      directory.add(keys, rows);
      set.add(keys, none);
    }
  // Each rank asks for others, some twice, some that are not there.
  std::vector<std::uint64_t> asked;
  for (std::uint64_t i = rank; i < 1200; i += 1 + rank)
    asked.push_back((i << 34) + 1);
  asked.push_back(asked.front());
  asked.push_back(77);
  Columns rows(2), none;
  rows.resize(asked.size());
  const auto found = directory.find(asked, rows), known = set.find(asked, none);
  bool       right = true;
  for (std::size_t i = 0; i < asked.size(); ++i)
    {
      const std::uint64_t n        = asked[i] >> 34;
      const bool          is_there = n < 1000 && asked[i] != 77;
      right                        = right && found[i] == is_there && known[i] == is_there &&
              rows[0][i] == (is_there ? value(asked[i]) : 0.) &&
              rows[1][i] == (is_there && n >= 500 ? 1. : 0.);
    }
  deallog << "found: " << !mpi::any(!right, comm) << ", kept evenly: "
          << (mpi::max<std::uint64_t>(directory.n_kept(), comm) * n_ranks < 1.3 * 1000)
          << ", all of them: " << (mpi::sum<std::uint64_t>(directory.n_kept(), comm) == 1000)
          << std::endl;
}
