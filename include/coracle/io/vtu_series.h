// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/io/output_directory.h>
#include <coracle/io/vtu_file.h>

#include <string>
#include <utility>
#include <vector>

namespace coracle
{
/**
 * A growing series of VTU files with a PVD that lists them: NAME.pvd opens in
 * ParaView at any time of the run. Per output time each rank writes
 * data/NAME.NNNNNN.RANK.vtu (see vtu_file.h), and
 * rank 0 the .pvtu that joins them and the PVD.
 *
 * All ranks must pass the same fields in the same order.
 */
class VtuSeries
{
public:
  VtuSeries(const OutputDirectory &directory,
            const std::string     &file_part,
            const bool             single_precision);

  /// Collective. `time` [s] should grow from call to call.
  void write(const double time, const VtuPiece &piece);

  /// What has been written; when loaded, what came later is forgotten.
  void serialize(Archive &archive);

private:
  std::string                                 folder, name;
  bool                                        single_precision;
  MPI_Comm                                    comm;
  std::vector<std::pair<double, std::string>> entries;
};
} // namespace coracle
