// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>

#include <deal.II/base/function.h>

#include <memory>

namespace coracle
{
/// `Initial velocity` and `Initial velocity function` of a body that is made of points.
template <int dim>
class InitialVelocity
{
public:
  /// Throws a UserError if there are not dim components.
  explicit InitialVelocity(const Parameters &body) : constant(body.list("Initial velocity"))
  {
    if (body.is_set("Initial velocity function"))
      varying = body.function<dim>("Initial velocity function", dim);
    if (!constant.empty() && constant.size() != dim)
      throw body.error("Initial velocity",
                       "a velocity has the wrong number of components",
                       std::to_string(constant.size()) + " components",
                       "give " + std::to_string(dim) + ", one for each direction");
  }

  /// At a place [m/s].
  dealii::Tensor<1, dim> operator()(const dealii::Point<dim> &x) const
  {
    dealii::Tensor<1, dim> v;
    for (unsigned int d = 0; d < dim; ++d)
      v[d] = varying ? varying->value(x, d) : (constant.empty() ? 0. : constant[d]);
    return v;
  }

private:
  const std::vector<double>              constant;
  std::unique_ptr<dealii::Function<dim>> varying;
};
} // namespace coracle
