// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/audit.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// Share of its size by which a simplex counts as larger, so that no path slips between neighbours.
constexpr double margin = 1e-9;

double
polynomial(const std::array<double, 4> &c, const double t)
{
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

/// 0, the zeros of the derivative in (0, 1) ascending, 1.
struct Parts
{
  std::array<double, 4> t{{0, 1, 1, 1}};
  unsigned int          n = 1;
};

Parts
monotonic_parts(const std::array<double, 4> &c)
{
  Parts        parts;
  const double A = 3 * c[3], B = 2 * c[2], C = c[1], root = B * B - 4 * A * C;
  if (root >= 0)
    {
      const double q    = -0.5 * (B + std::copysign(std::sqrt(root), B));
      double       a[2] = {A != 0 ? q / A : -1, q != 0 ? C / q : -1};
      if (a[0] > a[1])
        std::swap(a[0], a[1]);
      for (const double s : a)
        if (s > 0 && s < 1)
          parts.t[parts.n++] = s;
    }
  parts.t[parts.n++] = 1;
  return parts;
}

double
bisect(const std::array<double, 4> &c, double a, double b)
{
  const bool rising = polynomial(c, b) > polynomial(c, a);
  for (unsigned int i = 0; i < 60; ++i)
    {
      const double middle                             = 0.5 * (a + b);
      ((polynomial(c, middle) > 0) == rising ? b : a) = middle;
    }
  return 0.5 * (a + b);
}

template <int dim>
dealii::Point<dim>
at(const dealii::Point<dim> &a, const dealii::Point<dim> &b, const double t)
{
  return a + t * (b - a);
}

/// Twice (2-D: once) the size of the simplex, the unit normal times that.
dealii::Tensor<1, 2>
normal_of(const std::array<dealii::Point<2>, 2> &x)
{
  const auto           t = x[1] - x[0];
  dealii::Tensor<1, 2> n;
  n[0] = t[1];
  n[1] = -t[0];
  return n;
}

dealii::Tensor<1, 3>
normal_of(const std::array<dealii::Point<3>, 3> &x)
{
  return dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
}

/// Is the point, which lies in the simplex's plane, inside it up to `margin`?
bool
inside(const dealii::Point<2> &p, const std::array<dealii::Point<2>, 2> &x)
{
  const auto   t      = x[1] - x[0];
  const double length = t.norm_square(), s = (p - x[0]) * t;
  return s >= -margin * length && s <= (1 + margin) * length;
}

bool
inside(const dealii::Point<3> &p, const std::array<dealii::Point<3>, 3> &x)
{
  const auto   n      = normal_of(x);
  const double square = n.norm_square();
  bool         result = square > 0;
  for (unsigned int k = 0; k < 3; ++k)
    result =
      result && dealii::cross_product_3d(x[(k + 1) % 3] - x[k], p - x[k]) * n >= -margin * square;
  return result;
}
} // namespace

template <int dim>
dealii::Tensor<1, dim>
normal_if_on(const dealii::Point<dim>                  &p,
             const std::array<dealii::Point<dim>, dim> &x,
             const double                               distance)
{
  const auto   normal = normal_of(x);
  const double size   = normal.norm();
  if (size > 0 && std::abs((p - x[0]) * normal) <= distance * size && inside(p, x))
    return normal / size;
  return dealii::Tensor<1, dim>();
}

template <int dim>
void
meet_simplex(const std::array<dealii::Point<dim>, 2>                  &p,
             const std::array<std::array<dealii::Point<dim>, dim>, 2> &x,
             const OnSurface                                          &on_surface,
             const unsigned int                                        facet,
             std::vector<PathEvent>                                   &events)
{
  const auto simplex = [&x](const double t) {
    std::array<dealii::Point<dim>, dim> result;
    for (unsigned int k = 0; k < dim; ++k)
      result[k] = at(x[0][k], x[1][k], t);
    return result;
  };
  // Volume spanned by the moving simplex and the moving point: a cubic through four values.
  const auto volume = [](const dealii::Point<dim>                  &q,
                         const std::array<dealii::Point<dim>, dim> &y) {
    return (q - y[0]) * normal_of(y);
  };
  const auto   along = [&](const double t) { return volume(at(p[0], p[1], t), simplex(t)); };
  double       f0 = volume(p[0], x[0]), f3 = volume(p[1], x[1]);
  const double f1 = along(1. / 3), f2 = along(2. / 3);
  // On the surface at an end of the step: on the side that the point belongs to. If there is none,
  // it has come from where it does not go.
  const double near0 = on_surface.distance * normal_of(x[0]).norm(),
               near1 = on_surface.distance * normal_of(x[1]).norm();
  if (on_surface.side != 0 && std::abs(f3) <= near1)
    f3 = on_surface.side * near1;
  if (on_surface.side == 0 && std::abs(f0) <= near0)
    f0 = std::copysign(near0, -f3);
  // A cubic that differs so little at four places has no zero between them.
  const double low = std::min({f0, f1, f2, f3}), high = std::max({f0, f1, f2, f3});
  if ((low > 0 && high < 4 * low) || (high < 0 && low > 4 * high))
    return;
  const std::array<double, 4> c     = {{f0,
                                        -5.5 * f0 + 9 * f1 - 4.5 * f2 + f3,
                                        9 * f0 - 22.5 * f1 + 18 * f2 - 4.5 * f3,
                                        -4.5 * f0 + 13.5 * f1 - 13.5 * f2 + 4.5 * f3}};
  const auto                  parts = monotonic_parts(c);
  for (unsigned int i = 0; i + 1 < parts.n; ++i)
    {
      // The exact values at the ends of the step: neighbouring steps must not both count, nor none.
      const double a = (i == 0 ? f0 : polynomial(c, parts.t[i])),
                   b = (i + 2 == parts.n ? f3 : polynomial(c, parts.t[i + 1]));
      if ((a > 0) == (b > 0))
        continue;
      const double t = bisect(c, parts.t[i], parts.t[i + 1]);
      const auto   y = simplex(t);
      if (inside(at(p[0], p[1], t), y))
        events.push_back({t, a > 0 ? 1 : -1, facet});
    }
}

template dealii::Tensor<1, 2>
normal_if_on<2>(const dealii::Point<2> &, const std::array<dealii::Point<2>, 2> &, const double);
template dealii::Tensor<1, 3>
normal_if_on<3>(const dealii::Point<3> &, const std::array<dealii::Point<3>, 3> &, const double);
template void meet_simplex<2>(const std::array<dealii::Point<2>, 2> &,
                              const std::array<std::array<dealii::Point<2>, 2>, 2> &,
                              const OnSurface &,
                              const unsigned int,
                              std::vector<PathEvent> &);
template void meet_simplex<3>(const std::array<dealii::Point<3>, 2> &,
                              const std::array<std::array<dealii::Point<3>, 3>, 2> &,
                              const OnSurface &,
                              const unsigned int,
                              std::vector<PathEvent> &);
} // namespace coracle::contact
