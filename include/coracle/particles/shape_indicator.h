// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

#include <deal.II/base/function.h>

namespace coracle
{
/// The part of a box where an expression of x, y, z is positive.
template <int dim>
class IndicatorShape : public Shape<dim>
{
public:
  static void declare(Declaration &entries);
  explicit IndicatorShape(const Parameters &body);
  IndicatorShape(std::unique_ptr<dealii::Function<dim>> indicator,
                 const dealii::BoundingBox<dim>        &box);

  bool                     contains(const dealii::Point<dim> &point) const override;
  dealii::BoundingBox<dim> bounding_box() const override;
  std::optional<double>    volume() const override;

private:
  std::unique_ptr<dealii::Function<dim>> indicator;
  dealii::BoundingBox<dim>               box;
};
} // namespace coracle
