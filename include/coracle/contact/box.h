// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <limits>

namespace coracle::contact
{
/// Lower and upper corner, both belong to it; in 2-D the third coordinate is 0 in both.
struct Box
{
  std::array<double, 3> lower{{0, 0, 0}}, upper{{0, 0, 0}};
};

inline bool
overlap(const Box &a, const Box &b)
{
  bool result = true;
  for (int d = 0; d < 3; ++d)
    result &= (a.lower[d] <= b.upper[d]) & (b.lower[d] <= a.upper[d]);
  return result;
}

/// Meets nothing until something is included.
inline Box
empty_box(const int dim)
{
  Box box;
  for (int d = 0; d < dim; ++d)
    {
      box.lower[d] = std::numeric_limits<double>::max();
      box.upper[d] = std::numeric_limits<double>::lowest();
    }
  return box;
}

inline void
include(Box &box, const Box &other)
{
  for (int d = 0; d < 3; ++d)
    {
      box.lower[d] = std::min(box.lower[d], other.lower[d]);
      box.upper[d] = std::max(box.upper[d], other.upper[d]);
    }
}
} // namespace coracle::contact
