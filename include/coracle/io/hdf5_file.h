// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <hdf5.h>
#include <string>
#include <vector>

namespace coracle
{
/// Which rows of a dataset a rank writes; `local` may be 0.
struct RowPartition
{
  hsize_t total = 0, first = 0, local = 0, n_components = 1;
};

/**
 * A new HDF5 file, written by all ranks together through MPI-IO. All calls are
 * collective. dealii::HDF5 would do, but checks the library's answers in Debug
 * only: here the first failure is kept and everything after it is skipped, so
 * that a full disk can end the run with a readable message.
 */
class Hdf5File
{
public:
  Hdf5File(const std::string &file_name, MPI_Comm communicator);
  ~Hdf5File();
  Hdf5File(const Hdf5File &) = delete;

  /// A two-dimensional dataset of rows; `type` is a native type of HDF5.
  void write_rows(const std::string  &dataset,
                  const hid_t         type,
                  const void         *values,
                  const RowPartition &rows);

  /// Of a dataset, or of the file if its name is "".
  void set_attribute(const std::string &dataset, const std::string &key, const double value);
  void set_attribute(const std::string &dataset, const std::string &key, const std::string &value);

  void close();

  /// Empty, or the first thing that went wrong on this rank.
  const std::string &problem() const { return why; }

private:
  void write_attribute(const std::string &dataset,
                       const std::string &key,
                       const hid_t        type,
                       const void        *value);
  void check(const bool good, const std::string &what);

  std::string name, why;
  hid_t       file = -1, transfer = -1;
};
} // namespace coracle
