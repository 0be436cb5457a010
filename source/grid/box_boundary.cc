// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/box_boundary.h>

namespace coracle
{
template <int dim>
std::string
BoxBoundary<dim>::face_name(const unsigned int face)
{
  return std::string(1, "xyz"[face / 2]) + (face % 2 == 0 ? " min" : " max");
}

template <int dim>
void
BoxBoundary<dim>::declare(Declaration &grid)
{
  Declaration &section =
    grid.section("Boundaries", "What the faces of the box do to material points.");
  for (unsigned int face = 0; face < 2 * dim; ++face)
    section.choice(face_name(face),
                   "slip",
                   {"slip", "stick", "open"},
                   "slip: no motion through the face, free along it (also a plane of symmetry); "
                   "stick: no motion; open: points may leave, are counted and removed.");
}

template <int dim>
std::array<FaceCondition, 2 * dim>
BoxBoundary<dim>::read(const Parameters &grid)
{
  const Parameters                   section = grid.section("Boundaries");
  std::array<FaceCondition, 2 * dim> result;
  for (unsigned int face = 0; face < 2 * dim; ++face)
    {
      const std::string word = section.choice(face_name(face));
      result[face]           = word == "slip"    ? FaceCondition::slip
                               : word == "stick" ? FaceCondition::stick
                                                 : FaceCondition::open;
    }
  return result;
}

template <int dim>
BoxBoundary<dim>::BoxBoundary(const std::array<FaceCondition, 2 * dim> &conditions,
                              const Octree<dim>                        &octree)
  : conditions(conditions), box(octree.box())
{
  reinit(octree);
}

template <int dim>
void
BoxBoundary<dim>::reinit(const Octree<dim> &octree)
{
  flags.assign(octree.n_nodes(), 0);
  nodes.clear();
  const double tolerance = 1e-6 * octree.smallest_cell_size();
  for (unsigned int node = 0; node < octree.n_nodes(); ++node)
    {
      for (unsigned int face = 0; face < 2 * dim; ++face)
        {
          const unsigned int d     = face / 2;
          const double       bound = face % 2 == 0 ? box.lower_bound(d) : box.upper_bound(d);
          if (std::abs(octree.position(node)[d] - bound) > tolerance)
            continue;
          if (conditions[face] == FaceCondition::slip)
            flags[node] |= 1u << d;
          else if (conditions[face] == FaceCondition::stick)
            flags[node] |= (1u << dim) - 1;
        }
      if (flags[node] != 0)
        nodes.push_back(node);
    }
}

template <int dim>
unsigned int
BoxBoundary<dim>::face_left(const dealii::Point<dim> &point) const
{
  unsigned int face     = 0;
  double       farthest = -std::numeric_limits<double>::max();
  for (unsigned int d = 0; d < dim; ++d)
    for (unsigned int side = 0; side < 2; ++side)
      {
        const double beyond =
          side == 0 ? box.lower_bound(d) - point[d] : point[d] - box.upper_bound(d);
        if (beyond > farthest)
          {
            farthest = beyond;
            face     = 2 * d + side;
          }
      }
  return face;
}

template class BoxBoundary<2>;
template class BoxBoundary<3>;
} // namespace coracle
