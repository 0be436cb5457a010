// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/run_control.h>

#include <csignal>
#include <filesystem>

namespace coracle
{
namespace
{
/// Reasons as bits, so that those of all ranks go into one reduction.
enum Reason : int
{
  interrupted          = 1,
  terminated           = 2,
  asked_for_checkpoint = 4,
  found_stop_file      = 8,
  out_of_time          = 16,
  wall_interval_over   = 32
};

volatile std::sig_atomic_t signals = 0;

/// The limit of wall time is for all of the run, set-up too.
const auto program_start = std::chrono::steady_clock::now();

void
take_signal(const int signal)
{
  if (signal == SIGINT)
    {
      signals = signals | interrupted;
      std::signal(SIGINT, SIG_DFL);
    }
  else
    signals = signals | (signal == SIGTERM ? terminated : asked_for_checkpoint);
}

/// Of the limit, that is left for what follows the last step.
constexpr double share_of_limit = 0.02;
} // namespace

RunControl::RunControl(const CheckpointSettings &settings,
                       const std::string        &output_directory,
                       MPI_Comm                  communicator)
  : settings(settings)
  , stop_file(settings.stop_file.empty() ? "" : output_directory + "/" + settings.stop_file)
  , comm(communicator)
  , last_step(Clock::now())
  , last_checkpoint(last_step)
{
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1})
    std::signal(signal, take_signal);
  if (mpi::rank(comm) == 0)
    remove_stop_file();
}

double
RunControl::seconds_since(const Clock::time_point from) const
{
  return std::chrono::duration<double>(Clock::now() - from).count();
}

bool
RunControl::remove_stop_file() const
{
  std::error_code ignored;
  return !stop_file.empty() && std::filesystem::remove(stop_file, ignored);
}

bool
RunControl::time_is_up()
{
  longest_step = std::max(longest_step, seconds_since(last_step));
  last_step    = Clock::now();
  return settings.wall_limit > 0 &&
         seconds_since(program_start) + 2 * longest_step + 2 * longest_checkpoint >
           (1 - share_of_limit) * settings.wall_limit;
}

RunControl::Orders
RunControl::ask(const double time, const std::uint64_t step)
{
  int reasons = signals;
  signals     = 0;
  if (mpi::rank(comm) == 0)
    {
      if (remove_stop_file())
        reasons |= found_stop_file;
      if (time_is_up())
        reasons |= out_of_time;
      if (settings.wall_interval > 0 && seconds_since(last_checkpoint) > settings.wall_interval)
        reasons |= wall_interval_over;
    }
  MPI_Allreduce(MPI_IN_PLACE, &reasons, 1, MPI_INT, MPI_BOR, comm);

  Orders orders;
  orders.reason = reasons & interrupted       ? "SIGINT"
                  : reasons & terminated      ? "SIGTERM"
                  : reasons & found_stop_file ? "the stop file"
                  : reasons & out_of_time     ? "Checkpoint/Wall time limit"
                                              : "";
  orders.stop   = !orders.reason.empty();
  // Nobody needs the start of a case saved if he does not ask for it.
  const bool due    = settings.interval.due(time, step) || (reasons & wall_interval_over);
  orders.checkpoint = orders.stop || (due && step > 0) || (reasons & asked_for_checkpoint);
  return orders;
}

void
RunControl::checkpoint_written(const double seconds)
{
  longest_checkpoint = std::max(longest_checkpoint, seconds);
  last_checkpoint = last_step = Clock::now();
}
} // namespace coracle
