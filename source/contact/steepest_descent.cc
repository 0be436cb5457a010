// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/steepest_descent.h>

namespace coracle::contact
{
NearestPoint<2>
nearest_point_by_descent(const dealii::Point<2>                &x_p,
                         const std::array<dealii::Point<2>, 2> &vertices)
{
  return nearest_point(x_p, vertices);
}

NearestPoint<3>
nearest_point_by_descent(const dealii::Point<3>                &x_p,
                         const std::array<dealii::Point<3>, 4> &vertices)
{
  const auto found = steepest_descent(make_bilinear(relative_corners(x_p, vertices)), {});
  return describe(x_p, vertices, found.xi, found.eta);
}
} // namespace coracle::contact
