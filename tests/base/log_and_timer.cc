// SPDX-License-Identifier: GPL-3.0-or-later
// The log keeps what was said before its file was open, warnings of all ranks are shown five times
// and counted to the last; the timing table has every name of every rank, nested and per item.
#include <coracle/base/exceptions.h>
#include <coracle/base/log.h>
#include <coracle/base/timer.h>

#include "tests.h"

#include <sstream>
#include <thread>

using namespace coracle;

void
test_log(const unsigned int me, const unsigned int n_ranks)
{
  std::ostringstream console;
  Log                log(MPI_COMM_WORLD, console);
  log.out() << "before the file is open" << std::endl;
  log.open("log.txt");
  log.out() << "after" << std::endl;
  log.report();
  for (unsigned int i = 0; i < 8; ++i)
    log.warning("worn out", "event " + std::to_string(i) + " on rank " + std::to_string(me));
  if (me + 1 == n_ranks)
    log.warning("rare", "on the last rank");
  log.report();
  log.warning("worn out", "one more");
  log.finish();
  if (me == 0)
    {
      std::ostringstream file;
      file << std::ifstream("log.txt").rdbuf();
      deallog << console.str() << "file and console agree: " << (file.str() == console.str())
              << ", warnings: " << log.n_warnings() << std::endl;
      try
        {
          log.open("no_such_folder/log.txt");
        }
      catch (const UserError &error)
        {
          deallog << describe(error) << std::endl;
        }
    }
  else
    deallog << "silent: " << console.str().empty() << std::endl;
}

void
test_timer(const unsigned int me)
{
  TimingTable timed;
  for (unsigned int step = 0; step < 3; ++step)
    timed("step", [&] {
      timed.count("particle", 1000);
      const int answer = timed("contact", [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return 42;
      });
      if (step == 0)
        deallog << "result passed on: " << answer << std::endl;
    });
  try
    {
      timed("fails", [] { throw 1; });
    }
  catch (const int)
    {}
  if (me == 0)
    timed("rank 0 only", [] {});

  deallog << "time of parts within the whole: "
          << (timed.seconds("step/contact") >= 0.006 &&
              timed.seconds("step") >= timed.seconds("step/contact"))
          << std::endl;

  std::ostringstream table;
  timed.print(table, MPI_COMM_WORLD);
  std::istringstream lines(table.str());
  // Names and calls; the times are the machine's.
  for (std::string line; std::getline(lines, line);)
    deallog << line.substr(0, 46)
            << (line.find("/ particle") != std::string::npos ? " per item" : "") << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi_initialization(argc, argv, 1);
  MPILogInitAll                            all;
  const unsigned int me = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  test_log(me, dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
  test_timer(me);
}
