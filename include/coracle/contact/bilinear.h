// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/tensor.h>

namespace coracle::contact
{
template <typename T>
inline T
dot(const Vector<3, T> &a, const Vector<3, T> &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename T>
inline T
clamp(const T &x, const T &lower, const T &upper)
{
  return min(max(x, lower), upper);
}

/**
 * Bilinear facet seen from a point, for a double or for a pack of eight pairs:
 * x(xi, eta) - x_p = r + xi b + eta c + xi eta h on [-1,1]^2.
 */
template <typename T>
struct Bilinear
{
  Vector<3, T> r, b, c, h;
};

/// From the four corners relative to the point, counter-clockwise.
template <typename T>
inline Bilinear<T>
make_bilinear(const std::array<Vector<3, T>, 4> &x)
{
  Bilinear<T> f;
  for (int d = 0; d < 3; ++d)
    {
      f.r[d] = 0.25 * ((x[0][d] + x[2][d]) + (x[1][d] + x[3][d]));
      f.b[d] = 0.25 * ((x[2][d] - x[0][d]) + (x[1][d] - x[3][d]));
      f.c[d] = 0.25 * ((x[2][d] - x[0][d]) - (x[1][d] - x[3][d]));
      f.h[d] = 0.25 * ((x[0][d] + x[2][d]) - (x[1][d] + x[3][d]));
    }
  return f;
}

/// Result of the search on the square.
template <typename T>
struct NaturalPoint
{
  T xi, eta;
};

/**
 * How far |x - x_p|^2 / 2 is from being convex on the whole square: at least 0
 * means convex, so that every local minimum is the nearest point.
 *
 * Its second derivatives are |t_xi|^2 >= 0, |t_eta|^2 >= 0 and
 * s = t_xi . t_eta + (x - x_p) . h; s is bilinear, so that its extremes are at
 * the corners, and |t|^2 a parabola along one coordinate. [m^4]
 */
template <typename T>
inline T
convexity(const Bilinear<T> &f)
{
  const T one = splat<T>(1.), tiny = splat<T>(1e-300);
  const T hh = dot(f.h, f.h), bh = dot(f.b, f.h), ch = dot(f.c, f.h);
  const T eta = clamp(T(-bh / (hh + tiny)), T(-one), one);
  const T xi  = clamp(T(-ch / (hh + tiny)), T(-one), one);
  const T bb  = dot(f.b, f.b) + eta * (2. * bh + eta * hh),
          cc  = dot(f.c, f.c) + xi * (2. * ch + xi * hh);

  const T s0   = dot(f.b, f.c) + dot(f.r, f.h);
  const T same = abs(T(s0 + 2. * hh)) + abs(T(2. * bh + 2. * ch)), // corners with xi = eta
    opposite   = abs(T(s0 - 2. * hh)) + abs(T(2. * bh - 2. * ch)); // corners with xi = -eta
  const T s    = max(same, opposite);
  return bb * cc - s * s;
}

/// Nearest point of the line of constant eta.
template <typename T>
inline T
best_xi(const Bilinear<T> &f, const T &eta)
{
  Vector<3, T> a, b;
  for (int d = 0; d < 3; ++d)
    {
      a[d] = f.r[d] + eta * f.c[d];
      b[d] = f.b[d] + eta * f.h[d];
    }
  return clamp(T(-dot(a, b) / (dot(b, b) + splat<T>(1e-300))), splat<T>(-1.), splat<T>(1.));
}

/**
 * Nearest point under the condition convexity() >= 0.
 *
 * The best xi of a given eta is explicit, and what remains is a convex function
 * of eta with continuous derivative: Newton's step, kept inside the bracket of
 * the derivative's sign change. A flat parallelogram takes two evaluations.
 */
template <typename T>
inline NaturalPoint<T>
minimise_convex(const Bilinear<T> &f)
{
  const T one = splat<T>(1.), tiny = splat<T>(1e-300);
  T       eta = splat<T>(0.), xi = splat<T>(0.);
  // Bracket; beyond 1 while the end itself has not been tried.
  T lower = splat<T>(-1.5), upper = splat<T>(1.5);
  for (unsigned int iteration = 0; iteration < 100; ++iteration)
    {
      Vector<3, T> a, b, t;
      for (int d = 0; d < 3; ++d)
        {
          a[d] = f.r[d] + eta * f.c[d];
          b[d] = f.b[d] + eta * f.h[d];
        }
      const T bb = dot(b, b) + tiny, free_xi = -dot(a, b) / bb;
      xi = clamp(free_xi, T(-one), one);
      for (int d = 0; d < 3; ++d)
        {
          t[d] = f.c[d] + xi * f.h[d];
          a[d] += xi * b[d];
        }
      const T slope = dot(a, t), s = dot(b, t) + dot(a, f.h);
      const T curvature = dot(t, t) - select(abs(free_xi) < one, T(s * s / bb), splat<T>(0.));

      lower        = select(slope < splat<T>(0.), eta, lower);
      upper        = select(slope > splat<T>(0.), eta, upper);
      const T step = -slope / max(curvature, tiny);
      T       next = clamp(T(eta + step), T(-one), one);
      // Not within the bracket: halve it.
      const T middle = 0.5 * (max(lower, T(-one)) + min(upper, one));
      const T inside = select(next > lower, select(next < upper, one, splat<T>(0.)), splat<T>(0.));
      if (iteration < 20)
        next = select(next == eta, eta, select(inside > splat<T>(0.), next, middle));
      else // Newton creeps where the curvature jumps
        next = select(next == eta, eta, middle);
      const T change = abs(T(next - eta));
      eta            = next;
      if (sum(select(change > splat<T>(1e-13), one, splat<T>(0.))) == 0.)
        break;
    }
  return {best_xi(f, eta), eta};
}
} // namespace coracle::contact
