// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/shape.h>
#include <coracle/particles/shape_ball.h>
#include <coracle/particles/shape_box.h>
#include <coracle/particles/shape_indicator.h>
#include <coracle/particles/shape_polygon.h>
#include <coracle/particles/shape_surface.h>

#include <sstream>

namespace coracle
{
void
declare_shape(Declaration &body)
{
  body.choice(
    "Shape",
    "box",
    {"box", "ball", "polygon", "indicator", "surface mesh"},
    "Region that particles fill at the start: an axis-parallel box, a ball (2-D: disc), a "
    "polygon (3-D: extruded along z), where an expression is positive, or the inside of a "
    "closed surface");
  BoxShape<2>::declare(body.when("Shape", "box"));
  BallShape<2>::declare(body.when("Shape", "ball"));
  PolygonShape<2>::declare(body.when("Shape", "polygon"));
  IndicatorShape<2>::declare(body.when("Shape", "indicator"));
  SurfaceShape<2>::declare(body.when("Shape", "surface mesh"));
}

template <int dim>
std::unique_ptr<Shape<dim>>
read_shape(const Parameters &body)
{
  const std::string kind = body.choice("Shape");
  if (kind == "box")
    return std::make_unique<BoxShape<dim>>(body);
  if (kind == "ball")
    return std::make_unique<BallShape<dim>>(body);
  if (kind == "polygon")
    return std::make_unique<PolygonShape<dim>>(body);
  if (kind == "indicator")
    return std::make_unique<IndicatorShape<dim>>(body);
  return std::make_unique<SurfaceShape<dim>>(body);
}

template <int dim>
void
check_inside_box(const Parameters &body, const dealii::BoundingBox<dim> &box)
{
  const dealii::BoundingBox<dim> extent = read_shape<dim>(body)->bounding_box();
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double tolerance = 1e-9 * box.side_length(d);
      if (extent.lower_bound(d) >= box.lower_bound(d) - tolerance &&
          extent.upper_bound(d) <= box.upper_bound(d) + tolerance)
        continue;
      std::ostringstream found;
      found << "'" << body.name() << "' reaches from " << extent.lower_bound(d) << " m to "
            << extent.upper_bound(d) << " m in direction "
            << "xyz"[d] << ", the grid's box from " << box.lower_bound(d) << " m to "
            << box.upper_bound(d) << " m";
      throw body.error(
        "Shape",
        "a body lies outside the box",
        found.str(),
        "move or shrink the body, or enlarge Grid/Lower corner and Grid/Upper corner");
    }
}

template std::unique_ptr<Shape<2>> read_shape<2>(const Parameters &);
template std::unique_ptr<Shape<3>> read_shape<3>(const Parameters &);
template void check_inside_box(const Parameters &, const dealii::BoundingBox<2> &);
template void check_inside_box(const Parameters &, const dealii::BoundingBox<3> &);
} // namespace coracle
