// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

#include <vector>

namespace coracle
{
/**
 * Simple polygon in the x-y plane, either orientation, convex or not; in 3-D
 * extruded along z over a range of heights.
 */
template <int dim>
class PolygonShape : public Shape<dim>
{
public:
  static void declare(Declaration &entries);
  explicit PolygonShape(const Parameters &body);
  /// @param heights z of bottom and top [m]; not used in 2-D
  PolygonShape(const std::vector<dealii::Point<2>> &vertices,
               const std::pair<double, double>     &heights = {0., 1.});

  bool                     contains(const dealii::Point<dim> &point) const override;
  dealii::BoundingBox<dim> bounding_box() const override;
  std::optional<double>    volume() const override;

private:
  std::vector<dealii::Point<2>> vertices;
  std::pair<double, double>     heights;
};
} // namespace coracle
