// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape_box.h>
#include <coracle/particles/shape_indicator.h>

namespace coracle
{
template <int dim>
void
IndicatorShape<dim>::declare(Declaration &entries)
{
  entries.function("Indicator",
                   "1",
                   "1",
                   "Expression of x, y, z [m] that is positive inside the body");
  BoxShape<dim>::declare(entries);
}

template <int dim>
IndicatorShape<dim>::IndicatorShape(const Parameters &body)
  : IndicatorShape(body.function<dim>("Indicator", 1), read_box<dim>(body))
{}

template <int dim>
IndicatorShape<dim>::IndicatorShape(std::unique_ptr<dealii::Function<dim>> indicator,
                                    const dealii::BoundingBox<dim>        &box)
  : indicator(std::move(indicator)), box(box)
{}

template <int dim>
bool
IndicatorShape<dim>::contains(const dealii::Point<dim> &point) const
{
  return box.point_inside(point, 0.) && indicator->value(point) > 0;
}

template <int dim>
dealii::BoundingBox<dim>
IndicatorShape<dim>::bounding_box() const
{
  return box;
}

template <int dim>
std::optional<double>
IndicatorShape<dim>::volume() const
{
  return {};
}

template class IndicatorShape<2>;
template class IndicatorShape<3>;
} // namespace coracle
