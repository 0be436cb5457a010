// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/exceptions.h>
#include <deal.II/base/logstream.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <string>

/**
 * What every test needs. A test writes with `deallog << ... << std::endl` into
 * the file "output", which is compared with NAME.output:
 *
 *   int main()                            int main(int argc, char **argv)
 *   {                                     {
 *     initlog();                            dealii::Utilities::MPI::MPI_InitFinalize mpi(argc,
 * argv, 1); deallog << ... << std::endl;          mpi_initlog();   // rank 0 writes; or
 * MPILogInitAll all; }                                       ...
 */
using dealii::deallog;

inline std::ofstream deallog_file;

/// Send deallog to the file "output". Booleans are written as true and false.
inline void
initlog()
{
  dealii::deal_II_exceptions::disable_abort_on_exception();
  deallog_file.open("output");
  deallog.attach(deallog_file, false);
  deallog.flags(std::ios_base::showpoint | std::ios_base::left | std::ios_base::boolalpha);
  deallog.depth_console(0);
}

/// The same on rank 0 of a parallel test; the other ranks are silent.
inline void
mpi_initlog()
{
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    initlog();
  else
    {
      dealii::deal_II_exceptions::disable_abort_on_exception();
      deallog.depth_console(0);
    }
}

/// All ranks write: rank r to "output<r>", put together in the order of ranks at the end of scope.
class MPILogInitAll
{
public:
  MPILogInitAll()
    : rank(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD))
    , n_ranks(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD))
  {
    dealii::deal_II_exceptions::disable_abort_on_exception();
    deallog_file.open(name(rank));
    deallog.attach(deallog_file, false);
    deallog.flags(std::ios_base::showpoint | std::ios_base::left | std::ios_base::boolalpha);
    deallog.depth_console(0);
    deallog.push(std::to_string(rank));
  }

  ~MPILogInitAll()
  {
    deallog.pop();
    deallog.detach();
    deallog_file.close();
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0)
      {
        std::ofstream out("output", std::ios::app);
        for (unsigned int r = 1; r < n_ranks; ++r)
          out << std::ifstream(name(r)).rdbuf();
      }
    MPI_Barrier(MPI_COMM_WORLD);
  }

private:
  static std::string name(const unsigned int r)
  {
    return r == 0 ? std::string("output") : "output" + std::to_string(r);
  }

  const unsigned int rank, n_ranks;
};

/// Numbers below the threshold become an exact zero, so that outputs do not depend on round-off.
inline double
filter_out_small_numbers(const double number, const double threshold = 1e-12)
{
  return std::fabs(number) < threshold ? 0. : number;
}
