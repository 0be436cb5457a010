// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/bilinear.h>

namespace coracle::contact
{
/**
 * Squared distance from the point to the facet as a function of eta alone: for
 * a given eta the best xi in [-1,1] is explicit. What is left is smooth but for
 * its second derivative, which jumps where xi meets an end. A minimum of it is a
 * minimum on the whole square.
 *
 * Kept as the products of r, b, c, h (in h . r the product b . c is included,
 * because the two always come together), so that a step costs some thirty
 * operations whatever the dimension of space.
 */
template <typename T>
struct DistanceAlongEta
{
  T rr, rb, rc, rh_bc, bb, bh, cc, ch, hh;

  explicit DistanceAlongEta(const Bilinear<T> &f)
    : rr(dot(f.r, f.r))
    , rb(dot(f.r, f.b))
    , rc(dot(f.r, f.c))
    , rh_bc(dot(f.r, f.h) + dot(f.b, f.c))
    , bb(dot(f.b, f.b) + splat<T>(1e-300))
    , bh(dot(f.b, f.h))
    , cc(dot(f.c, f.c))
    , ch(dot(f.c, f.h))
    , hh(dot(f.h, f.h))
  {}

  /// Squared distance [m^2].
  T value(const double eta) const
  {
    const T t_xi_square = bb + eta * (2. * bh + eta * hh), along = rb + eta * (rh_bc + eta * ch);
    const T xi = clamp(T(-along / t_xi_square), splat<T>(-1.), splat<T>(1.));
    return rr + eta * (2. * rc + eta * cc) + xi * (2. * along + xi * t_xi_square);
  }

  /// Half the first and second derivative [m^2].
  struct Derivatives
  {
    T slope, curvature;
  };

  Derivatives derivatives(const T &eta) const
  {
    const T t_xi_square = bb + eta * (2. * bh + eta * hh);
    const T free_xi     = -(rb + eta * (rh_bc + eta * ch)) / t_xi_square;
    const T xi          = clamp(free_xi, splat<T>(-1.), splat<T>(1.));
    const T bh_eta = bh + eta * hh, mixed = rh_bc + 2. * eta * ch;
    const T slope        = rc + eta * cc + xi * (mixed + xi * bh_eta);
    const T cross        = mixed + 2. * xi * bh_eta;
    const T t_eta_square = cc + xi * (2. * ch + xi * hh);
    const T through_xi   = select(free_xi == xi, T(cross * cross / t_xi_square), splat<T>(0.));
    return {slope, t_eta_square - through_xi};
  }
};

/// The best of equally spaced etas, ends included, to start from.
template <int n, typename T>
inline T
best_sample(const DistanceAlongEta<T> &distance)
{
  T eta = splat<T>(-1.), best = distance.value(-1.);
  for (int i = 1; i < n; ++i)
    {
      const double at     = -1 + 2. * i / (n - 1);
      const T      value  = distance.value(at);
      const auto   better = value < best;
      best                = select(better, value, best);
      eta                 = select(better, splat<T>(at), eta);
    }
  return eta;
}

/// Nearest point of the line of constant eta, and one Newton step from there, without the
/// cancellation that products suffer near the ends of a facet that narrows to nothing.
template <typename T>
inline NaturalPoint<T>
polished(const Bilinear<T> &f, const T &eta)
{
  const T    one = splat<T>(1.), tiny = splat<T>(1e-300);
  const auto best_xi = [&](const T &at) {
    const auto there = evaluate(f, {splat<T>(0.), at});
    return T(-dot(there.place, there.t_xi) / (dot(there.t_xi, there.t_xi) + tiny));
  };
  const T    free_xi = best_xi(eta), xi = clamp(free_xi, T(-one), one);
  const auto x        = evaluate(f, {xi, eta});
  const T    cross    = dot(x.t_xi, x.t_eta) + dot(x.place, f.h);
  const T    t_square = dot(x.t_xi, x.t_xi) + tiny;
  const T    curvature =
    dot(x.t_eta, x.t_eta) - select(free_xi == xi, T(cross * cross / t_square), splat<T>(0.));
  const T newton = clamp(T(eta - dot(x.place, x.t_eta) / curvature), T(-one), one);
  const T end    = select(curvature > splat<T>(0.), newton, eta);
  return {clamp(best_xi(end), T(-one), one), end};
}

/**
 * A local minimum of the distance from the point to the facet: Newton's step for
 * eta inside the bracket of the slope's change of sign, halving where the
 * curvature is of no use. Sixteen steps at most; whether it has arrived is for
 * the proof to say (global_minimum.h).
 *
 * A lane that has arrived is left alone, so that its result does not depend on
 * its neighbours in the pack.
 */
template <typename T>
inline NaturalPoint<T>
local_minimum(const Bilinear<T> &f, const DistanceAlongEta<T> &distance, const T &start)
{
  const T one = splat<T>(1.), zero = splat<T>(0.);
  T       eta = start, lower = T(-one), upper = one, moving = one;
  for (unsigned int iteration = 0; iteration < 16; ++iteration)
    {
      const auto at = distance.derivatives(eta);
      lower         = select(at.slope < zero, eta, lower);
      upper         = select(at.slope > zero, eta, upper);

      // An end of the square may be taken, an end of the bracket that has been tried may not.
      const T newton = eta - at.slope / at.curvature, middle = 0.5 * (lower + upper);
      T       next  = select(at.curvature > zero, clamp(newton, lower, upper), middle);
      const T below = select(newton < lower, select(lower > T(-one), one, zero), zero),
              above = select(newton > upper, select(upper < one, one, zero), zero);
      next          = select(below + above > zero, middle, next);
      next          = select(at.slope == zero, eta, next);
      next          = select(moving > zero, next, eta);
      moving        = select(abs(T(next - eta)) > splat<T>(1e-7), one, zero);
      eta           = next;
      if (sum(moving) == 0.)
        break;
    }
  return polished(f, eta);
}
} // namespace coracle::contact
