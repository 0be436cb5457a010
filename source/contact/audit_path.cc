// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/audit_path.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coracle::contact
{
namespace
{
/// A polynomial of degree three in time.
struct Cubic
{
  std::array<double, 4> c;

  /// Through its values at 0, 1/3, 2/3 and 1.
  Cubic(const double f0, const double f1, const double f2, const double f3)
    : c{{f0,
         -5.5 * f0 + 9 * f1 - 4.5 * f2 + f3,
         9 * f0 - 22.5 * f1 + 18 * f2 - 4.5 * f3,
         -4.5 * f0 + 13.5 * f1 - 13.5 * f2 + 4.5 * f3}}
  {}

  double operator()(const double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }

  /// How far from t a zero may really be, if values are wrong by `error`.
  double reach(const double t, const double error) const
  {
    const double slope = std::abs(c[1] + t * (2 * c[2] + t * 3 * c[3])),
                 bend = std::abs(c[2] + t * 3 * c[3]), third = std::abs(c[3]);
    double result = 1;
    if (slope > error)
      result = std::min(result, error / slope);
    if (bend > error)
      result = std::min(result, std::sqrt(error / bend));
    if (third > error)
      result = std::min(result, std::cbrt(error / third));
    return 2 * result;
  }
};

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
bisect(const Cubic &f, double a, double b, const bool rising)
{
  for (unsigned int i = 0; i < 60; ++i)
    {
      const double middle                 = 0.5 * (a + b);
      ((f(middle) > 0) == rising ? b : a) = middle;
    }
  return 0.5 * (a + b);
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

/// How far a point in the simplex's plane is from the nearest edge (2-D: end); negative outside.
double
depth_in(const dealii::Point<2> &p, const std::array<dealii::Point<2>, 2> &x)
{
  const auto   t      = x[1] - x[0];
  const double length = t.norm();
  return length > 0 ? std::min((p - x[0]) * t, (x[1] - p) * t) / length : -p.distance(x[0]);
}

double
depth_in(const dealii::Point<3> &p, const std::array<dealii::Point<3>, 3> &x)
{
  const auto   n      = normal_of(x);
  const double size   = n.norm();
  double       result = std::numeric_limits<double>::max();
  for (unsigned int k = 0; k < 3; ++k)
    {
      const auto   edge   = x[(k + 1) % 3] - x[k];
      const double length = edge.norm();
      result              = std::min(result,
                        length > 0 && size > 0
                                       ? dealii::cross_product_3d(edge, p - x[k]) * n / (length * size)
                                       : -p.distance(x[k]));
    }
  return result;
}

/// A path and a simplex at any time of the step.
template <int dim>
struct Motion
{
  const Path<dim>          &p;
  const MovingSimplex<dim> &x;

  dealii::Point<dim> point(const double t) const { return p[0] + t * (p[1] - p[0]); }

  std::array<dealii::Point<dim>, dim> simplex(const double t) const
  {
    std::array<dealii::Point<dim>, dim> result;
    for (unsigned int k = 0; k < dim; ++k)
      result[k] = x[0][k] + t * (x[1][k] - x[0][k]);
    return result;
  }

  /// How far the point can move relative to the simplex.
  double travel() const
  {
    double result = 0;
    for (unsigned int k = 0; k < dim; ++k)
      result = std::max(result, ((p[1] - p[0]) - (x[1][k] - x[0][k])).norm_square());
    return std::sqrt(result);
  }
};

/// Volume spanned by a simplex and a point, a cubic in time.
template <int dim>
double
volume(const dealii::Point<dim> &q, const std::array<dealii::Point<dim>, dim> &y)
{
  return (q - y[0]) * normal_of(y);
}

template <int dim>
double
sum_of_components(const dealii::Tensor<1, dim> &a)
{
  double sum = 0;
  for (int d = 0; d < dim; ++d)
    sum += std::abs(a[d]);
  return sum;
}

template <int dim>
bool
find_meetings(const Motion<dim>           &motion,
              const Cubic                 &f,
              const std::array<double, 2> &ends,
              const double                 doubt,
              const unsigned int           facet,
              std::vector<PathEvent<dim>> &events)
{
  const auto   parts  = monotonic_parts(f.c);
  const double travel = motion.travel();
  bool         sure   = true;
  double       before = ends[0];
  for (unsigned int i = 0; i < parts.n; ++i)
    {
      const double t = parts.t[i];
      // The exact values at the ends of the step: neighbouring steps must not both count, nor none.
      const double now = (i == 0 ? ends[0] : (i + 1 == parts.n ? ends[1] : f(t)));
      const auto   y   = motion.simplex(t);
      if (const double error = doubt * normal_of(y).norm(); std::abs(now) <= error)
        sure = sure && depth_in(motion.point(t), y) < -doubt - travel * f.reach(t, error);
      if (i > 0 && (before > 0) != (now > 0))
        {
          const double root  = bisect(f, parts.t[i - 1], t, now > before);
          const auto   z     = motion.simplex(root);
          const double error = doubt * normal_of(z).norm(), depth = depth_in(motion.point(root), z),
                       slack = doubt + travel * f.reach(root, error);
          if (depth >= 0)
            events.push_back({root, before > 0 ? 1 : -1, facet, motion.x});
          sure = sure && std::abs(depth) > slack;
        }
      before = now;
    }
  return sure;
}
} // namespace

template <int dim>
dealii::Tensor<1, dim>
normal_if_on(const dealii::Point<dim>                  &p,
             const std::array<dealii::Point<dim>, dim> &x,
             const double                               distance)
{
  const auto   normal = normal_of(x);
  const double square = normal.norm_square(), height = (p - x[0]) * normal;
  if (square == 0 || height * height > distance * distance * square || depth_in(p, x) < -distance)
    return dealii::Tensor<1, dim>();
  return normal / std::sqrt(square);
}

template <int dim>
double
distance_from_plane(const Path<dim> &path, const MovingSimplex<dim> &x, const double time)
{
  const Motion<dim> motion{path, x};
  const auto        y    = motion.simplex(time);
  const double      size = normal_of(y).norm();
  return size > 0 ? volume<dim>(motion.point(time), y) / size : 0.;
}

template <int dim>
bool
meet_simplex(const Path<dim>             &path,
             const MovingSimplex<dim>    &x,
             const double                 doubt,
             const unsigned int           facet,
             std::vector<PathEvent<dim>> &events)
{
  const Motion<dim> motion{path, x};
  const auto        along = [&](const double t) {
    return volume<dim>(motion.point(t), motion.simplex(t));
  };
  const auto   n0 = normal_of(x[0]), n1 = normal_of(x[1]);
  const double f0 = (path[0] - x[0][0]) * n0, f3 = (path[1] - x[1][0]) * n1;
  const double f1 = along(1. / 3), f2 = along(2. / 3);
  // A cubic that differs so little at four places has no zero between them.
  const double low = std::min({f0, f1, f2, f3}), high = std::max({f0, f1, f2, f3}),
               error = 4 * doubt * (sum_of_components(n0) + sum_of_components(n1));
  if ((low > error && high < 3.9 * low) || (high < -error && low > 3.9 * high))
    return true;
  // A simplex without size is a line or a point, which nothing goes through.
  if (error == 0 && low == 0 && high == 0)
    return true;
  return find_meetings<dim>(motion, Cubic(f0, f1, f2, f3), {{f0, f3}}, doubt, facet, events);
}

#define INSTANTIATE(dim)                                                                         \
  template dealii::Tensor<1, dim> normal_if_on<dim>(const dealii::Point<dim> &,                  \
                                                    const std::array<dealii::Point<dim>, dim> &, \
                                                    const double);                               \
  template double                 distance_from_plane<dim>(const Path<dim> &,                    \
                                           const MovingSimplex<dim> &,           \
                                           const double);                        \
  template bool                   meet_simplex<dim>(const Path<dim> &,                           \
                                  const MovingSimplex<dim> &,                  \
                                  const double,                                \
                                  const unsigned int,                          \
                                  std::vector<PathEvent<dim>> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace coracle::contact
