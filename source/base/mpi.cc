// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>

#include <chrono>
#include <iostream>
#include <limits>
#include <thread>

namespace coracle::mpi
{
namespace
{
/// What an exception was, in a form that travels.
enum class Kind
{
  none,
  user_error,
  run_failure,
  other
};

struct Failure
{
  Kind                     kind = Kind::none;
  std::vector<std::string> texts;
};

Failure
catch_failure(const std::function<void()> &function)
{
  try
    {
      function();
    }
  catch (const UserError &e)
    {
      return {Kind::user_error, {e.title, e.where, e.found, e.cure}};
    }
  catch (const RunFailure &e)
    {
      return {Kind::run_failure, {e.title, e.details, e.cure}};
    }
  catch (const std::exception &e)
    {
      return {Kind::other, {e.what()}};
    }
  return {};
}

[[noreturn]] void
rethrow(const Kind kind, const std::vector<std::string> &texts)
{
  if (kind == Kind::user_error)
    throw UserError(texts[0], texts[1], texts[2], texts[3]);
  if (kind == Kind::run_failure)
    throw RunFailure(texts[0], texts[1], texts[2]);
  throw std::runtime_error(texts[0]);
}

// Probes for any sender: no other message may have these tags.
constexpr int first_tag = 4901;

/// Two exchanges that follow each other must not take each other's messages: a rank that has
/// left the first one may already send while another still listens. It cannot be two ahead.
int
next_tag(const MPI_Comm comm)
{
  static std::map<MPI_Comm, int> parity;
  return first_tag + (parity[comm] ^= 1);
}

/// Receive one message if there is one.
void
receive_if_any(std::map<unsigned int, Buffer> &received, const int tag, const MPI_Comm comm)
{
  int        arrived = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, tag, comm, &arrived, &status);
  if (!arrived)
    return;
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  Buffer &buffer = received[status.MPI_SOURCE];
  buffer.resize(size);

  MPI_Recv(buffer.data(), size, MPI_CHAR, status.MPI_SOURCE, tag, comm, MPI_STATUS_IGNORE);
}

/// Do all ranks come here within a few seconds?
bool
all_arrive(const MPI_Comm comm)
{
  MPI_Request request;
  MPI_Ibarrier(comm, &request);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  for (int arrived = 0; std::chrono::steady_clock::now() < deadline;)
    {
      MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
      if (arrived)
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  return false;
}

/// Print once and return the exit code, or end the other ranks if they do not know.
int
finish(const std::string &message, const int exit_code, const MPI_Comm comm)
{
  const bool agreed = all_arrive(comm);
  if (!agreed)
    std::cerr << message << "\n  rank      " << rank(comm) << ", while others went on" << std::endl;
  else if (rank(comm) == 0)
    std::cerr << message << std::endl;
  if (!agreed)
    MPI_Abort(comm, exit_code);
  return exit_code;
}
} // namespace

bool
any(const bool value, const MPI_Comm comm)
{
  return max(static_cast<int>(value), comm) != 0;
}

std::map<unsigned int, Buffer>
exchange_buffers(const std::map<unsigned int, Buffer> &to_send, const MPI_Comm comm)
{
  const unsigned int             me  = rank(comm);
  const int                      tag = next_tag(comm);
  std::map<unsigned int, Buffer> received;
  std::vector<MPI_Request>       requests;
  for (const auto &[receiver, buffer] : to_send)
    if (receiver == me)
      received[me] = buffer;
    else
      {
        AssertThrow(buffer.size() < std::size_t(std::numeric_limits<int>::max()),
                    dealii::ExcMessage("A message of more than 2 GB"));
        // Synchronous: completes only when the receiver has taken it.
        MPI_Issend(
          buffer.data(), buffer.size(), MPI_CHAR, receiver, tag, comm, &requests.emplace_back());
      }

  // When all that this rank sent has arrived it enters the barrier; when all ranks have, no
  // message is on its way.
  MPI_Request barrier    = MPI_REQUEST_NULL;
  bool        in_barrier = false;
  for (int finished = 0; !finished;)
    {
      receive_if_any(received, tag, comm);
      if (in_barrier)
        MPI_Test(&barrier, &finished, MPI_STATUS_IGNORE);
      else
        {
          int sent = 0;
          MPI_Testall(requests.size(), requests.data(), &sent, MPI_STATUSES_IGNORE);
          if (sent)
            MPI_Ibarrier(comm, &barrier);
          in_barrier = sent;
        }
    }
  return received;
}

void
agree(const std::function<void()> &function, const MPI_Comm comm)
{
  const Failure failure = catch_failure(function);

  const int nobody = std::numeric_limits<int>::max();
  const int first  = min(failure.kind == Kind::none ? nobody : static_cast<int>(rank(comm)), comm);
  if (first == nobody)
    return;
  const auto kind  = dealii::Utilities::MPI::broadcast(comm, static_cast<int>(failure.kind), first);
  const auto texts = dealii::Utilities::MPI::broadcast(comm, failure.texts, first);
  rethrow(static_cast<Kind>(kind), texts);
}

int
run_guarded(const std::function<int()> &function, const MPI_Comm comm)
{
  int code = 0;
  try
    {
      code = function();
    }
  catch (const UserError &error)
    {
      code = finish(describe(error), 2, comm);
    }
  catch (const RunFailure &error)
    {
      code = finish(describe(error), 3, comm);
    }
  catch (const std::exception &error)
    {
      code = finish("error: the program failed in a way that was not foreseen\n" +
                      std::string(error.what()),
                    4,
                    comm);
    }
  return code;
}
} // namespace coracle::mpi
