// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/box.h>

#include <memory>
#include <vector>

namespace coracle::contact
{
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
