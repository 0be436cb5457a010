// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/octree.h>

namespace coracle
{
/// How a particle's shape meets the grid's.
enum class ParticleShape
{
  /// All mass at the centre.
  linear,
  /// Mass spread over a box that keeps its size (uGIMP).
  gimp
};

/**
 * Cut the box of a particle at the faces of the leaves that it reaches into,
 * and call `use(leaf, centre of the piece, fraction of the box)` for each.
 *
 * The mean of a multilinear function over a box is its value at the box's
 * centre, and likewise for its gradient. So a GIMP particle is exactly these
 * few weighted linear points, in cells of any size (Bardenhagen & Kober 2004
 * for the method; the cut for octrees is this project's).
 *
 * A box that sticks out of the grid is cut there and its fractions made to sum
 * to one. `half_size` 0 gives one piece.
 */
template <int dim, typename Use>
void
for_each_piece(const Octree<dim>        &octree,
               const dealii::Point<dim> &centre,
               const double              half_size,
               const Use                &use)
{
  if (half_size == 0)
    {
      use(octree.find(centre), centre, 1.);
      return;
    }
  struct Box
  {
    dealii::Point<dim> lower, upper;
  };
  // Leaves may be half as large as the particle's box at a 2:1 face; 4^dim pieces are never
  // reached.
  std::array<Box, (1 << (2 * dim))> stack;
  unsigned int                      n_boxes = 1;
  double                            volume  = 1;
  for (unsigned int d = 0; d < dim; ++d)
    {
      stack[0].lower[d] = std::max(centre[d] - half_size, octree.box().lower_bound(d));
      stack[0].upper[d] = std::min(centre[d] + half_size, octree.box().upper_bound(d));
      volume *= stack[0].upper[d] - stack[0].lower[d];
    }
  // A sliver is not a piece; its width is well above the round-off of coordinates, so that the cut
  // always goes on to the next leaf.
  const double nothing = 1e-9 * half_size;
  while (n_boxes > 0)
    {
      Box                box = stack[--n_boxes];
      dealii::Point<dim> inside;
      for (unsigned int d = 0; d < dim; ++d)
        inside[d] = box.lower[d] + std::min(nothing, 0.5 * (box.upper[d] - box.lower[d]));
      const int leaf = octree.find(inside);
      Assert(leaf >= 0, dealii::ExcInternalError());
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double face = octree.lower(leaf)[d] + octree.size(leaf);
          if (box.upper[d] > face + nothing)
            {
              AssertIndexRange(n_boxes, stack.size());
              stack[n_boxes]          = box;
              stack[n_boxes].lower[d] = face;
              ++n_boxes;
              box.upper[d] = face;
            }
        }
      double fraction = 1. / volume;
      for (unsigned int d = 0; d < dim; ++d)
        fraction *= box.upper[d] - box.lower[d];
      use(leaf, box.lower + 0.5 * (box.upper - box.lower), fraction);
    }
}

/// Is a particle wholly in the leaf, upper faces not counted? `margin` is 0 or half its size.
template <int dim>
bool
is_inside_leaf(const Octree<dim>        &octree,
               const unsigned int        leaf,
               const dealii::Point<dim> &x,
               const double              margin)
{
  bool inside = true;
  for (unsigned int d = 0; d < dim; ++d)
    inside = inside && x[d] - margin >= octree.lower(leaf)[d] &&
             x[d] + margin < octree.lower(leaf)[d] + octree.size(leaf);
  return inside;
}

/// Coordinates of a point in a leaf, 0 to 1.
template <int dim>
std::array<double, dim>
unit_coordinates(const Octree<dim> &octree, const int leaf, const dealii::Point<dim> &point)
{
  std::array<double, dim> xi;
  for (unsigned int d = 0; d < dim; ++d)
    xi[d] = (point[d] - octree.lower(leaf)[d]) / octree.size(leaf);
  return xi;
}
} // namespace coracle
