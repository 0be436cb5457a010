// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/field.h>
#include <coracle/io/output_directory.h>
#include <coracle/io/vtu_series.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace coracle
{
/// How particles are written.
struct ParticleFormat
{
  bool hdf5             = true;
  bool vtu              = false;
  bool single_precision = true;
};

/**
 * The particles of one body over time.
 *
 * HDF5: data/NAME.NNNNNN.h5 holds one dataset per field, N x 1 or N x 3, with
 * attributes `time` [s] (file) and `unit` (dataset), and `cells` (the numbers 0..N-1), written by
 * all ranks together through MPI-IO; NAME.xdmf lists them all (one temporal collection of
 * polyvertex grids) and is rewritten each time, so that it opens in ParaView
 * while the run goes on. VTU: see VtuSeries.
 *
 * A rank, or all of them, may have no particle; that is why this goes through
 * Hdf5File and not through DataOut::write_hdf5_parallel.
 */
class ParticleOutput
{
public:
  /// Claims `body` as a name in the folder. Collective.
  ParticleOutput(OutputDirectory &directory, const std::string &body, const ParticleFormat &format);

  /**
   * Write this moment. Collective; the same fields in the same order on all ranks.
   *
   * @param time [s]
   * @param n_particles on this rank
   * @param fields the first is "position" [m], two or three components
   *
   * Throws RunFailure on all ranks if the disk refuses.
   */
  void write(const double time, const std::size_t n_particles, const std::vector<Field> &fields);

  /// As VtuSeries::serialize().
  void serialize(Archive &archive);

private:
  void
  write_hdf5(const double time, const std::size_t n_particles, const std::vector<Field> &fields);
  void write_xdmf() const;

  std::string                folder, name, title;
  ParticleFormat             format;
  MPI_Comm                   comm;
  std::vector<std::string>   grids;
  std::unique_ptr<VtuSeries> vtu;
};
} // namespace coracle
