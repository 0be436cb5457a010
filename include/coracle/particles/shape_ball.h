// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

namespace coracle
{
/// Disc in 2-D, ball in 3-D.
template <int dim>
class BallShape : public Shape<dim>
{
public:
  static void declare(Declaration &entries);
  explicit BallShape(const Parameters &body);
  BallShape(const dealii::Point<dim> &centre, const double radius);

  bool                     contains(const dealii::Point<dim> &point) const override;
  dealii::BoundingBox<dim> bounding_box() const override;
  std::optional<double>    volume() const override;

private:
  dealii::Point<dim> centre;
  double             radius;
};
} // namespace coracle
