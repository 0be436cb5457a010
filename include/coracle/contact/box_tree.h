// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace coracle::contact
{
/// Lower and upper corner; in 2-D the third coordinate is 0 in both.
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

/**
 * A tree of axis-aligned boxes that answers which of them meet a given box:
 * CGAL's AABB tree, hidden because it takes long to compile.
 */
class BoxTree
{
public:
  BoxTree();
  ~BoxTree();
  BoxTree(BoxTree &&);
  BoxTree &operator=(BoxTree &&);

  /// Forget the old boxes and take these; they are numbered as in the list.
  void build(const std::vector<Box> &boxes);

  /// Numbers of the boxes that meet this one, replacing what `result` held, in no particular order.
  void find(const Box &box, std::vector<unsigned int> &result) const;

private:
  struct Data;
  std::unique_ptr<Data> data;
};
} // namespace coracle::contact
