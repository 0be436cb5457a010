// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape_box.h>

#include <sstream>

namespace coracle
{
template <int dim>
dealii::BoundingBox<dim>
read_box(const Parameters &body)
{
  const auto lower = body.point<dim>("Lower corner"), upper = body.point<dim>("Upper corner");
  for (int d = 0; d < dim; ++d)
    if (!(lower[d] < upper[d]))
      {
        std::ostringstream found;
        found << "lower corner (" << lower << ") m, upper corner (" << upper
              << ") m: no extent along "
              << "xyz"[d];
        throw body.error("Upper corner",
                         "box without volume",
                         found.str(),
                         "give an upper corner that is larger in each direction");
      }
  return {{lower, upper}};
}

template <int dim>
void
BoxShape<dim>::declare(Declaration &entries)
{
  entries.list(
    "Lower corner", "", "m", "", "Corner with the smallest coordinates; empty is the origin");
  entries.list("Upper corner", "", "m", "", "Corner with the largest coordinates");
}

template <int dim>
BoxShape<dim>::BoxShape(const Parameters &body) : BoxShape(read_box<dim>(body))
{}

template <int dim>
BoxShape<dim>::BoxShape(const dealii::BoundingBox<dim> &box) : box(box)
{}

template <int dim>
bool
BoxShape<dim>::contains(const dealii::Point<dim> &point) const
{
  return box.point_inside(point, 0.);
}

template <int dim>
dealii::BoundingBox<dim>
BoxShape<dim>::bounding_box() const
{
  return box;
}

template <int dim>
std::optional<double>
BoxShape<dim>::volume() const
{
  return box.volume();
}

template class BoxShape<2>;
template class BoxShape<3>;
template dealii::BoundingBox<2> read_box<2>(const Parameters &);
template dealii::BoundingBox<3> read_box<3>(const Parameters &);
} // namespace coracle
