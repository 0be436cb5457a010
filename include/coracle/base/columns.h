// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/aligned_vector.h>

#include <coracle/base/pack.h>

#include <vector>

namespace coracle
{
/**
 * Column storage: n_columns arrays of doubles of one common size, each with
 * pack_size spare entries behind its end, so that the last pack may be loaded
 * whole. Rows (one value of each column) are what migrates between ranks and
 * what a checkpoint holds.
 */
class Columns
{
public:
  explicit Columns(const unsigned int n_columns = 0);

  unsigned int n_columns() const { return columns.size(); }
  std::size_t  size() const { return n_rows; }

  double       *operator[](const unsigned int column) { return columns[column].data(); }
  const double *operator[](const unsigned int column) const { return columns[column].data(); }

  /// New rows are zero. Capacity grows by half, so that appending is cheap.
  void resize(const std::size_t n_rows);

  /// Row i becomes what row source[i] was; source may be shorter than size().
  void reorder(const std::vector<unsigned int> &source);

  /// Copy one row out, and back.
  void get_row(const std::size_t row, double *values) const;
  void set_row(const std::size_t row, const double *values);

  std::size_t memory_consumption() const;

private:
  std::size_t                                n_rows   = 0;
  std::size_t                                capacity = 0;
  std::vector<dealii::AlignedVector<double>> columns;
  dealii::AlignedVector<double>              scratch;
};
} // namespace coracle
