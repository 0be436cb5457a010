// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace coracle
{
/**
 * Finds the leaf of a point by integer arithmetic: the coarse cell from the
 * scaled coordinates, then one bit per direction and level. No geometry is
 * compared, so a point on a face has exactly one leaf, on every rank the same.
 */
template <int dim>
class LeafTree
{
public:
  static constexpr unsigned int max_levels = 24;

  void reinit(const dealii::Point<dim>            &lower,
              const dealii::Point<dim>            &upper,
              const std::array<unsigned int, dim> &n_coarse_cells)
  {
    origin = lower;
    end    = upper;
    n      = n_coarse_cells;
    for (unsigned int d = 0; d < dim; ++d)
      scale[d] = std::ldexp(n[d] / (upper[d] - lower[d]), max_levels);
    std::size_t size = 1;
    for (const unsigned int k : n)
      size *= k;
    entries.assign(size, unknown);
  }

  /// Enter a leaf, `level` bisections below the coarse cell that contains `inside`.
  void insert(const dealii::Point<dim> &inside, const unsigned int level, const int leaf)
  {
    std::array<std::uint64_t, dim> c{};
    integer_coordinates(inside, c);
    std::size_t slot = coarse_slot(c);
    for (unsigned int l = 0; l < level; ++l)
      {
        if (entries[slot] == unknown)
          {
            const int first = entries.size();
            entries.resize(entries.size() + (1u << dim), unknown);
            entries[slot] = -2 - first;
          }
        slot = -2 - entries[slot] + child(c, l);
      }
    entries[slot] = leaf;
  }

  int find(const dealii::Point<dim> &point) const
  {
    std::array<std::uint64_t, dim> c{};
    if (!integer_coordinates(point, c))
      return unknown;
    int entry = entries[coarse_slot(c)];
    for (unsigned int l = 0; entry < unknown; ++l)
      entry = entries[-2 - entry + child(c, l)];
    return entry;
  }

  /// The coarse cell (x fastest) and the place within it, bits of all directions interleaved, x
  /// lowest, cut off after n_bits of each; false outside the box.
  bool curve_place(const dealii::Point<dim> &point,
                   const unsigned int        n_bits,
                   std::size_t              &coarse_cell,
                   std::uint64_t            &place) const
  {
    std::array<std::uint64_t, dim> c{};
    if (!integer_coordinates(point, c))
      return false;
    coarse_cell = coarse_slot(c);
    place       = 0;
    for (unsigned int l = 0; l < n_bits; ++l)
      place = (place << dim) | child(c, l);
    return true;
  }
  std::size_t n_coarse_cells() const
  {
    std::size_t result = 1;
    for (const unsigned int k : n)
      result *= k;
    return result;
  }

private:
  static constexpr int unknown = -1;

  /// False if the point is outside the box (or not a number).
  bool integer_coordinates(const dealii::Point<dim> &point, std::array<std::uint64_t, dim> &c) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        // The coordinates themselves are compared: scaled ones may round to beyond the upper face.
        if (!(point[d] >= origin[d] && point[d] <= end[d]))
          return false;
        const std::uint64_t limit = static_cast<std::uint64_t>(n[d]) << max_levels;
        c[d] = std::min(static_cast<std::uint64_t>((point[d] - origin[d]) * scale[d]), limit - 1);
      }
    return true;
  }

  std::size_t coarse_slot(const std::array<std::uint64_t, dim> &c) const
  {
    std::size_t slot = 0;
    for (int d = dim - 1; d >= 0; --d)
      slot = slot * n[d] + (c[d] >> max_levels);
    return slot;
  }

  static unsigned int child(const std::array<std::uint64_t, dim> &c, const unsigned int level)
  {
    unsigned int result = 0;
    for (unsigned int d = 0; d < dim; ++d)
      result |= ((c[d] >> (max_levels - 1 - level)) & 1u) << d;
    return result;
  }

  dealii::Point<dim>            origin, end;
  std::array<double, dim>       scale{};
  std::array<unsigned int, dim> n{};
  /// >= 0: leaf; -1: not known here; below: -2 - index of the first of 2^dim children.
  std::vector<int> entries;
};
} // namespace coracle
