// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace coracle
{
/**
 * A named array to be written: one entry per particle, node or cell, viewed
 * where it lies, never copied by the caller. Component c of entry i is
 * `components[c][i * stride]`; columns have stride 1, an array of dim-vectors
 * has stride dim and one pointer into it per component.
 *
 *   1 component           scalar
 *   2 or 3                vector; a plane one is written with a third component 0
 *   4 (xx,yy,zz,xy), 6 (xx,yy,zz,xy,yz,xz)
 *                         symmetric tensor, written as scalars NAME_xx, NAME_yy, ... because
 *                         readers disagree about the order of tensor components
 */
struct Field
{
  std::string                 name;
  std::string                 unit;
  std::vector<const double *> components;
  std::size_t                 stride = 1;
  /// Always in double precision: numbers that name something (ids), which rounding would change.
  bool exact = false;
};

/// A view of an array of vectors (dealii::Point, dealii::Tensor<1, dim>, std::array<double, dim>).
template <typename VectorType>
Field
vector_field(const std::string             &name,
             const std::string             &unit,
             const std::vector<VectorType> &values)
{
  constexpr std::size_t dim = sizeof(VectorType) / sizeof(double);
  Field                 field{name, unit, {}, dim, false};
  for (std::size_t d = 0; d < dim; ++d)
    field.components.push_back(reinterpret_cast<const double *>(values.data()) + d);
  return field;
}

/// A view of one column.
inline Field
scalar_field(const std::string &name, const std::string &unit, const std::vector<double> &values)
{
  return {name, unit, {values.data()}, 1, false};
}

/// Symmetric tensors split into scalars; everything else unchanged.
std::vector<Field> split_tensors(const std::vector<Field> &fields);

/// Components a scalar (1) or vector (3) has in a file.
inline unsigned int
n_written_components(const Field &field)
{
  return field.components.size() == 1 ? 1 : 3;
}

/**
 * Scalar or vector entries one after the other, as files hold them.
 *
 * @param n number of entries
 * @param indices which entries, in which order; null means 0 .. n-1
 */
template <typename Number>
std::vector<Number> interleave(const Field                     &field,
                               const std::size_t                n,
                               const std::vector<unsigned int> *indices = nullptr);
} // namespace coracle
