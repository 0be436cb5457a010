// SPDX-License-Identifier: GPL-3.0-or-later
// The only file of the room that includes CGAL.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <coracle/contact/box_tree.h>

namespace coracle::contact
{
namespace
{
using Kernel = CGAL::Simple_cartesian<double>;
using Cuboid = Kernel::Iso_cuboid_3;

/// A numbered box, as CGAL wants to see it. The boxes themselves are kept by the tree's owner.
class Primitive
{
public:
  using Id              = unsigned int;
  using Datum           = Cuboid;
  using Datum_reference = const Cuboid &;
  using Point           = Kernel::Point_3;

  Primitive() = default;
  Primitive(const Cuboid &cuboid, const unsigned int number) : cuboid(&cuboid), number(number) {}

  Id              id() const { return number; }
  Datum_reference datum() const { return *cuboid; }
  Point           reference_point() const { return cuboid->min(); }

private:
  const Cuboid *cuboid = nullptr;
  unsigned int  number = 0;
};

using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Cuboid
to_cuboid(const Box &box)
{
  return Cuboid(Kernel::Point_3(box.lower[0], box.lower[1], box.lower[2]),
                Kernel::Point_3(box.upper[0], box.upper[1], box.upper[2]));
}

/// Takes the numbers from the primitives that the tree hits.
struct Collector
{
  std::vector<unsigned int> *result;

  Collector &operator*() { return *this; }
  Collector &operator++() { return *this; }
  Collector &operator++(int) { return *this; }
  void       operator=(const unsigned int number) { result->push_back(number); }
};
} // namespace

struct BoxTree::Data
{
  std::vector<Cuboid> cuboids;
  Tree                tree;
};

BoxTree::BoxTree() : data(std::make_unique<Data>()) {}

BoxTree::~BoxTree()                     = default;
BoxTree::BoxTree(BoxTree &&)            = default;
BoxTree &BoxTree::operator=(BoxTree &&) = default;

void
BoxTree::build(const std::vector<Box> &boxes)
{
  data->tree.clear();
  data->cuboids.clear();
  data->cuboids.reserve(boxes.size());
  for (const auto &box : boxes)
    data->cuboids.push_back(to_cuboid(box));
  for (unsigned int i = 0; i < boxes.size(); ++i)
    data->tree.insert(Primitive(data->cuboids[i], i));
  data->tree.build();
}

void
BoxTree::find(const Box &box, std::vector<unsigned int> &result) const
{
  result.clear();
  if (!data->cuboids.empty())
    data->tree.all_intersected_primitives(to_cuboid(box), Collector{&result});
}
} // namespace coracle::contact
