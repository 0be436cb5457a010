// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/disk.h>
#include <coracle/io/text.h>
#include <coracle/io/vtu_file.h>
#include <coracle/io/vtu_series.h>

namespace coracle
{
VtuSeries::VtuSeries(const OutputDirectory &directory,
                     const std::string     &file_part,
                     const bool             single_precision)
  : folder(directory.path())
  , name(file_part)
  , single_precision(single_precision)
  , comm(directory.communicator())
{}

void
VtuSeries::serialize(Archive &archive)
{
  if (!archive.has(name + ".times"))
    return;
  std::vector<double>      times;
  std::vector<std::string> files;
  for (const auto &[time, file] : entries)
    {
      times.push_back(time);
      files.push_back(file);
    }
  archive.same(name + ".times", times);
  archive.same(name + ".files", files);
  entries.clear();
  for (unsigned int i = 0; i < times.size(); ++i)
    entries.emplace_back(times[i], files[i]);
  if (archive.loads() && !entries.empty())
    mpi::agree(
      [&] {
        if (mpi::rank(comm) == 0)
          write_file(folder + "/" + name + ".pvd", pvd_text(entries));
      },
      comm);
}

void
VtuSeries::write(const double time, const VtuPiece &piece)
{
  const unsigned int rank = mpi::rank(comm), n_ranks = mpi::n_ranks(comm);
  const std::string  stem = name + "." + six_digits(entries.size());

  std::vector<std::string> pieces;
  for (unsigned int r = 0; r < n_ranks; ++r)
    pieces.push_back(stem + "." + std::to_string(r) + ".vtu");
  // A single piece needs no file that joins it.
  const std::string opened = (n_ranks == 1 ? pieces[0] : stem + ".pvtu");
  entries.emplace_back(time, "data/" + opened);

  mpi::agree(
    [&] {
      write_file(folder + "/data/" + pieces[rank], vtu_text(piece, single_precision));
      if (rank == 0 && n_ranks > 1)
        write_file(folder + "/data/" + opened, pvtu_text(piece, pieces, single_precision));
      if (rank == 0)
        write_file(folder + "/" + name + ".pvd", pvd_text(entries));
    },
    comm);
}
} // namespace coracle
