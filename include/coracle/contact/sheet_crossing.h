// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/box_tree.h>
#include <coracle/contact/surface.h>

namespace coracle::contact
{
/**
 * Which sheets lie between two points: those whose mid-surface the straight way
 * from one to the other meets an odd number of times.
 *
 * Facets are simplices: segments, triangles, a bilinear quadrilateral four
 * triangles around its middle. Whether the way meets a simplex is decided edge
 * by edge from the same numbers for all simplices that share the edge, so that
 * a way finds no gap between two of them and meets none twice. What is left
 * open is a point on the mid-surface itself; clear_of() moves it off.
 */
template <int dim>
class SheetCrossing
{
public:
  /// Numbers of the simplices to look at.
  struct List
  {
    const unsigned int *first, *last;
    const unsigned int *begin() const { return first; }
    const unsigned int *end() const { return last; }
  };

  /// Facets of sheets only. The surface must outlive this object.
  void reinit(const Surface<dim> &surface);
  /// Nodes have moved.
  void update();

  unsigned int n_simplices() const { return simplices.size(); }
  /// Around a simplex; the third direction is 0 in 2-D.
  const Box &box(const unsigned int simplex) const { return boxes[simplex]; }

  /// Those of a list whose boxes meet this one: enough for ways inside it. The third direction is 0
  /// in 2-D.
  void within(const Box &around, const List &list, std::vector<unsigned int> &result) const;

  /// A bit for each sheet (SurfaceBody::sheet; sheets beyond 64 share bits).
  std::uint64_t
  between(const dealii::Point<dim> &p, const dealii::Point<dim> &q, const List &list) const;

  /**
   * The point itself, or if a sheet is nearer than `distance` the place that far
   * off it, on the side that side(sheet) = +1 or -1 says.
   */
  template <typename Side>
  dealii::Point<dim> clear_of(const dealii::Point<dim> &p,
                              const List               &list,
                              const double              distance,
                              const Side               &side) const
  {
    dealii::Point<dim>     foot;
    dealii::Tensor<1, dim> off;
    double                 nearest = distance;
    for (const unsigned int s : list)
      if (is_near(p, s, distance))
        {
          const dealii::Point<dim> x = nearest_point(p, s);
          if (x.distance(p) < distance)
            off += side(sheets[s]) * normal(s);
          if (x.distance(p) < nearest)
            {
              nearest = x.distance(p);
              foot    = x;
            }
        }
    return off.norm() > 0 ? foot + distance / off.norm() * off : p;
  }

private:
  bool is_near(const dealii::Point<dim> &p, const unsigned int s, const double distance) const;
  bool meets(const dealii::Point<dim> &p, const dealii::Point<dim> &q, const unsigned int s) const;
  dealii::Point<dim>     nearest_point(const dealii::Point<dim> &p, const unsigned int s) const;
  dealii::Tensor<1, dim> normal(const unsigned int s) const;

  const Surface<dim> *surface = nullptr;
  /// The surface's nodes, then the middles of quadrilaterals.
  std::vector<dealii::Point<dim>> vertices;
  /// Facets that have a middle.
  std::vector<unsigned int>                  quadrilaterals;
  std::vector<std::array<unsigned int, dim>> simplices;
  std::vector<int>                           sheets;
  std::vector<Box>                           boxes;
  /// Not of unit length; none in 2-D.
  std::vector<dealii::Tensor<1, dim>> normals;
};
} // namespace coracle::contact
