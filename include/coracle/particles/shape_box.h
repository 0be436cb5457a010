// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

namespace coracle
{
/// Axis-parallel rectangle or cuboid.
template <int dim>
class BoxShape : public Shape<dim>
{
public:
  static void declare(Declaration &entries);
  explicit BoxShape(const Parameters &body);
  explicit BoxShape(const dealii::BoundingBox<dim> &box);

  bool                     contains(const dealii::Point<dim> &point) const override;
  dealii::BoundingBox<dim> bounding_box() const override;
  std::optional<double>    volume() const override;

private:
  dealii::BoundingBox<dim> box;
};

/// The entries `Lower corner` and `Upper corner`, checked for a positive extent in each direction.
template <int dim>
dealii::BoundingBox<dim> read_box(const Parameters &body);
} // namespace coracle
