// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <coracle/base/archive.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace coracle
{
/**
 * The table `statistics.csv`: a header row, then a row per reporting interval,
 * comma separated, each number with as many digits as it takes to read back
 * exactly the same. A row is on disk when end_row() returns.
 *
 * Columns are registered in order before the first row. Values are the same on
 * all ranks, rank 0 writes them. A value that is missing or set twice, and a
 * name that is not known, are programming errors and stop the run.
 */
class Statistics
{
public:
  /// Nothing is written before the first row.
  Statistics(const std::string &file_name, MPI_Comm communicator);

  /// "dt", "s" makes the column `dt [s]`; a count has the unit "".
  void add_column(const std::string &name, const std::string &unit);

  /// Columns name.x, name.y (, name.z).
  void add_vector(const std::string &name, const std::string &unit, const unsigned int dim);

  void begin_row();
  /// The name without its unit.
  void set(const std::string &name, const double value);
  /// Sets name.x, name.y (, name.z) from a dealii::Point, dealii::Tensor<1, dim> or std::array.
  template <typename VectorType>
  void set_vector(const std::string &name, const VectorType &value, const unsigned int dim)
  {
    static const char *const axis[] = {".x", ".y", ".z"};
    for (unsigned int d = 0; d < dim; ++d)
      set(name + axis[d], value[d]);
  }
  void end_row();

  /**
   * When loaded, the file is cut behind the rows it had then, and goes on from there.
   * Throws RunFailure on rank 0 if it has fewer, or other columns.
   */
  void serialize(Archive &archive);

  /// As in the header row: "dt [s]".
  const std::vector<std::string> &titles() const { return column_titles; }

private:
  void        write_line(const std::string &line);
  std::string header() const;
  /// Cut the file behind the rows written.
  void go_on();

  std::string                         file_name;
  bool                                writes;
  std::ofstream                       file;
  std::vector<std::string>            column_titles;
  std::map<std::string, unsigned int> column_of_name;
  std::vector<double>                 values;
  std::vector<bool>                   is_set;
  bool                                row_open = false;
  std::uint64_t                       n_rows   = 0;
};
} // namespace coracle
