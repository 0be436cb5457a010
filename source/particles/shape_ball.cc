// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape_ball.h>

#include <deal.II/base/numbers.h>

namespace coracle
{
template <int dim>
void
BallShape<dim>::declare(Declaration &entries)
{
  entries.list("Centre", "", "m", "", "Centre of the ball; empty is the origin");
  entries.quantity("Radius", "1", "m", "", "Radius of the ball", 1e-300);
}

template <int dim>
BallShape<dim>::BallShape(const Parameters &body)
  : BallShape(body.point<dim>("Centre"), body.quantity("Radius"))
{}

template <int dim>
BallShape<dim>::BallShape(const dealii::Point<dim> &centre, const double radius)
  : centre(centre), radius(radius)
{}

template <int dim>
bool
BallShape<dim>::contains(const dealii::Point<dim> &point) const
{
  return point.distance_square(centre) <= radius * radius;
}

template <int dim>
dealii::BoundingBox<dim>
BallShape<dim>::bounding_box() const
{
  dealii::Tensor<1, dim> half;
  for (int d = 0; d < dim; ++d)
    half[d] = radius;
  return {{centre - half, centre + half}};
}

template <int dim>
std::optional<double>
BallShape<dim>::volume() const
{
  using dealii::numbers::PI;
  return dim == 2 ? PI * radius * radius : 4. / 3. * PI * radius * radius * radius;
}

template class BallShape<2>;
template class BallShape<3>;
} // namespace coracle
