// SPDX-License-Identifier: GPL-3.0-or-later
// Buffers arrive whole where they were sent, also from and to ranks that have nothing, also in
// hundreds of exchanges that follow each other without a barrier; errors of one rank reach all.
#include <coracle/base/mpi.h>

#include "tests.h"

using namespace coracle;

struct Item
{
  int    from;
  double value;
};

/// Rank r sends r + 1 items to every rank below it and to itself; rank 0 sends nothing at all.
bool
exchange_with_lower_ranks(const int round)
{
  const unsigned int me = mpi::rank(MPI_COMM_WORLD), n = mpi::n_ranks(MPI_COMM_WORLD);
  std::map<unsigned int, std::vector<Item>> to_send;
  for (unsigned int to = 0; to <= me && me > 0; ++to)
    to_send[to].assign(me + 1, Item{int(me), 100. * round + to});
  const auto received = mpi::exchange_values(to_send, MPI_COMM_WORLD);

  bool right = (received.size() == (me == 0 ? n - 1 : n - me));
  for (const auto &[from, items] : received)
    {
      right &= (from >= me && items.size() == from + 1);
      for (const Item &item : items)
        right &= (item.from == int(from) && item.value == 100. * round + me);
    }
  return right;
}

void
test_agree(const unsigned int culprit, const bool user_error)
{
  const unsigned int me = mpi::rank(MPI_COMM_WORLD);
  try
    {
      mpi::agree(
        [&] {
          if (me >= culprit && user_error)
            throw UserError("title", "where", "found on " + std::to_string(me), "cure");
          if (me >= culprit)
            throw RunFailure("title", "found on " + std::to_string(me), "cure");
        },
        MPI_COMM_WORLD);
      deallog << "nobody complained" << std::endl;
    }
  catch (const UserError &error)
    {
      deallog << describe(error) << std::endl;
    }
  catch (const RunFailure &error)
    {
      deallog << describe(error) << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi_initialization(argc, argv, 1);
  MPILogInitAll                            all;
  const unsigned int                       me = mpi::rank(MPI_COMM_WORLD);

  bool right = true;
  for (int round = 0; round < 500; ++round)
    right &= exchange_with_lower_ranks(round);
  deallog << "exchanged: " << right << std::endl;

  deallog << "nothing at all: "
          << mpi::exchange_buffers(std::map<unsigned int, mpi::Buffer>(), MPI_COMM_WORLD).size()
          << std::endl;
  const auto empty =
    mpi::exchange_buffers(std::map<unsigned int, mpi::Buffer>{{0, {}}}, MPI_COMM_WORLD);
  deallog << "empty buffers: " << empty.size() << std::endl;

  deallog << "sum " << mpi::sum(me + 1, MPI_COMM_WORLD) << " min " << mpi::min(me, MPI_COMM_WORLD)
          << " max " << mpi::max(me, MPI_COMM_WORLD) << " offset "
          << mpi::offset(me + 3, MPI_COMM_WORLD) << " any " << mpi::any(me == 1, MPI_COMM_WORLD)
          << ' ' << mpi::any(false, MPI_COMM_WORLD) << std::endl;
  deallog << mpi::on_root<std::string>([] { return "from rank 0"; }, MPI_COMM_WORLD) << std::endl;

  test_agree(1, true);
  test_agree(0, false);
  test_agree(99, true);
}
