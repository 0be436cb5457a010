// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape_ball.h>

#include <deal.II/base/numbers.h>

#include <cmath>

namespace coracle
{
namespace
{
using dealii::numbers::PI;

/// Unit vector number i of n, evenly over the circle or sphere; `turn` [rad] sets shells apart.
template <int dim>
dealii::Tensor<1, dim>
direction(const std::uint64_t i, const std::uint64_t n, const double turn)
{
  dealii::Tensor<1, dim> result;
  if constexpr (dim == 2)
    {
      const double angle = turn + 2 * PI * i / n;
      result[0]          = std::cos(angle);
      result[1]          = std::sin(angle);
    }
  else
    {
      const double golden_angle = PI * (3 - std::sqrt(5.));
      const double z = 1 - (2. * i + 1) / n, across = std::sqrt(1 - z * z);
      result[0] = across * std::cos(turn + golden_angle * i);
      result[1] = across * std::sin(turn + golden_angle * i);
      result[2] = z;
    }
  return result;
}
} // namespace

template <int dim>
void
BallShape<dim>::declare(Declaration &entries)
{
  entries.list("Centre", "", "m", "", "Centre of the ball; empty is the origin");
  entries.quantity("Radius", "1", "m", "", "Radius of the ball", 1e-300);
  entries.choice("Arrangement",
                 "lattice",
                 {"lattice", "shells"},
                 "Of the particles. lattice: regular, with a staircase as surface; shells: on "
                 "concentric spheres, with a smooth surface for balls that roll or collide");
}

template <int dim>
BallShape<dim>::BallShape(const Parameters &body)
  : BallShape(body.point<dim>("Centre"),
              body.quantity("Radius"),
              body.choice("Arrangement") == "shells")
{}

template <int dim>
BallShape<dim>::BallShape(const dealii::Point<dim> &centre,
                          const double              radius,
                          const bool                in_shells)
  : centre(centre), radius(radius), in_shells(in_shells)
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
  return dim == 2 ? PI * radius * radius : 4. / 3. * PI * radius * radius * radius;
}

template <int dim>
bool
BallShape<dim>::for_each_place(const double                                           spacing,
                               const std::function<void(const dealii::Point<dim> &)> &action) const
{
  if (!in_shells)
    return false;
  // Shell k is one thickness wide; numbers are rounded so that their sum is that of the ball.
  const double n_shells = std::max(1., std::round(radius / spacing)), thickness = radius / n_shells,
               volume = (dim == 2 ? PI : 4. / 3. * PI);
  std::uint64_t done  = 0;
  for (unsigned int k = 0; k < n_shells; ++k)
    {
      const auto   up_to = static_cast<std::uint64_t>(std::llround(volume * std::pow(k + 1., dim)));
      const double middle = (up_to - done > 1 ? (k + 0.5) * thickness : 0.);
      for (std::uint64_t i = 0; i < up_to - done; ++i)
        action(centre + middle * direction<dim>(i, up_to - done, k));
      done = up_to;
    }
  return true;
}

template class BallShape<2>;
template class BallShape<3>;
} // namespace coracle
