// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>

#include <functional>
#include <memory>
#include <optional>

namespace coracle
{
/**
 * A region of space that a body fills at the start. Asked once per lattice
 * point when particles are generated, never during a step.
 */
template <int dim>
class Shape
{
public:
  virtual ~Shape() = default;

  /// Points on the boundary belong to either side, always to the same one.
  virtual bool contains(const dealii::Point<dim> &point) const = 0;

  /// The smallest axis-parallel box around the shape [m], if the shape knows it, or one that holds
  /// it.
  virtual dealii::BoundingBox<dim> bounding_box() const = 0;

  /// Exact volume [m^dim], where it is known in closed form.
  virtual std::optional<double> volume() const = 0;

  /**
   * Calls action(place) for the particles of a shape that follow its boundary, all of one volume
   * and about `spacing` [m] apart; in the same order on all ranks.
   * @return false, and no call, for shapes that are filled from a lattice
   */
  virtual bool for_each_place(const double,
                              const std::function<void(const dealii::Point<dim> &)> &) const
  {
    return false;
  }
};

/// The entry `Shape` of a body and the entries that each shape has.
void declare_shape(Declaration &body);

/**
 * The shape that the section of a body describes. Throws a UserError for an
 * empty or self-crossing shape, a surface that is not closed, a file that cannot
 * be read, or a shape that this number of dimensions does not have.
 */
template <int dim>
std::unique_ptr<Shape<dim>> read_shape(const Parameters &body);

/// A UserError if the shape of a body reaches out of the box.
template <int dim>
void check_inside_box(const Parameters &body, const dealii::BoundingBox<dim> &box);
} // namespace coracle
