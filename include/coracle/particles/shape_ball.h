// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

namespace coracle
{
/**
 * Disc in 2-D, ball in 3-D.
 *
 * From a lattice its surface is a staircase, and a stiff ball rolls like a
 * polyhedron. In shells, particles lie on concentric spheres (2-D: circles) as
 * far apart as within each, where a spiral of the golden angle puts them; so
 * the outermost ones are all half a spacing under the surface.
 */
template <int dim>
class BallShape : public Shape<dim>
{
public:
  static void declare(Declaration &entries);
  explicit BallShape(const Parameters &body);
  BallShape(const dealii::Point<dim> &centre, const double radius, const bool in_shells = false);

  bool                     contains(const dealii::Point<dim> &point) const override;
  dealii::BoundingBox<dim> bounding_box() const override;
  std::optional<double>    volume() const override;
  bool                     for_each_place(const double                                           spacing,
                                          const std::function<void(const dealii::Point<dim> &)> &action) const override;

private:
  dealii::Point<dim> centre;
  double             radius;
  bool               in_shells;
};
} // namespace coracle
