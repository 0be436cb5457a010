// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/bilinear.h>

namespace coracle::contact
{
/**
 * Proof that a local minimum x* of the distance to a bilinear facet is the
 * global one.
 *
 * Each of the (up to) four rectangles into which x* divides the square is
 * scaled to (s,t) in [0,1]^2 with x* at the origin, the tangents T1, T2 and the
 * twist H. With e = x* - x_p, the gradients G1 = e.T1, G2 = e.T2 (not negative,
 * because x* is a minimum) and K = -e.H, the squared distance exceeds that of
 * x* by
 *   f = |s T1 + t T2 + s t H|^2 + 2 s G1 + 2 t G2 - 2 s t K.
 * Nothing is to be shown where K <= 0, so that two opposite rectangles are left.
 * Elsewhere divide by s^2 t^2 and put s = 1/(1+x), t = 1/(1+y) with x, y >= 0:
 *   |(1+y) T1 + (1+x) T2 + H|^2 + 2 G1 (1+x)(1+y)^2 + 2 G2 (1+x)^2 (1+y) - 2 K (1+x)(1+y),
 * a quadratic function but for the terms G1 x y^2 and G2 x^2 y, which vanish where x* is
 * inside the facet. They are replaced by what lies below them,
 *   x y^2 >= 2 y0 x y - y0^2 x,
 * at first with y0 = 0. So f >= 0 if the symmetric 3x3 matrix of that quadratic
 * function of (y, x, 1) is copositive, which has a closed criterion. Inside the facet that is
 * necessary, too: the proof fails only where a nearer point exists.
 */
namespace internal
{
/// Symmetric matrix of a quadratic function of (y, x, 1).
template <typename T>
struct Quadratic
{
  T yy, xx, xy, y, x, one;
};

/**
 * v.Mv >= 0 for all v >= 0? Hadeler (Linear Algebra Appl. 49, 1983): yes if it
 * holds on the faces, unless the determinant is negative and all cofactors are
 * not. Where it fails, x0 and y0 are moved to where it does.
 * @return 1 where it holds, else 0
 */
template <typename T>
inline T
copositive(const Quadratic<T> &m, T &x0, T &y0)
{
  const T    zero = splat<T>(0.), one = splat<T>(1.), tiny = splat<T>(1e-300);
  const auto fails = [&](const T &mixed, const T &a, const T &b) {
    return select(mixed < zero, select(mixed * mixed > a * b, one, zero), zero);
  };
  const T fails_far = fails(m.xy, m.yy, m.xx), fails_y = fails(m.y, m.yy, m.one),
          fails_x = fails(m.x, m.xx, m.one);

  const T c_yy = m.xx * m.one - m.x * m.x, c_xx = m.yy * m.one - m.y * m.y,
          c_one = m.yy * m.xx - m.xy * m.xy, c_xy = m.y * m.x - m.xy * m.one,
          c_y = m.xy * m.x - m.xx * m.y, c_x = m.xy * m.y - m.yy * m.x;
  const T determinant  = m.yy * c_yy + m.xy * c_xy + m.y * c_y;
  const T smallest     = min(min(min(c_yy, c_xx), min(c_one, c_xy)), min(c_y, c_x));
  const T fails_inside = select(determinant < zero, select(smallest >= zero, one, zero), zero);

  const T far_x = 2. * x0 + one, far_y = 2. * y0 + one;
  x0               = select(fails_inside > zero, T(c_x / (c_one + tiny)), x0);
  y0               = select(fails_inside > zero, T(c_y / (c_one + tiny)), y0);
  x0               = select(fails_far > zero, far_x, x0);
  y0               = select(fails_far > zero, far_y, y0);
  x0               = select(fails_y > zero, zero, select(fails_x > zero, T(-m.x / m.xx), x0));
  y0               = select(fails_x > zero, zero, select(fails_y > zero, T(-m.y / m.yy), y0));
  x0               = min(x0, splat<T>(1e6));
  y0               = min(y0, splat<T>(1e6));
  const T anything = fails_far + fails_y + fails_x + fails_inside;
  return select(anything + select(m.one < zero, one, zero) > zero, zero, one);
}
} // namespace internal

/// What is known of a point of a facet.
template <typename T>
struct Proof
{
  T distance_square;
  /// 1 where no point of the facet is nearer, else 0.
  T holds;
};

/**
 * @param passes how often y0 and x0 are moved to where the proof failed
 *
 * The distance of a point for which the proof holds exceeds the smallest by at
 * most 1e-10 of the facet's size; so much is allowed for round-off.
 */
template <typename T>
inline Proof<T>
prove_global(const Bilinear<T> &f, const NaturalPoint<T> &x, const unsigned int passes)
{
  const T    one = splat<T>(1.), zero = splat<T>(0.);
  const auto at = evaluate(f, x);
  const T t11 = dot(at.t_xi, at.t_xi), t22 = dot(at.t_eta, at.t_eta), t12 = dot(at.t_xi, at.t_eta),
          h1 = dot(at.t_xi, f.h), h2 = dot(at.t_eta, f.h), hh = dot(f.h, f.h);
  const T g1 = dot(at.place, at.t_xi), g2 = dot(at.place, at.t_eta), k = -dot(at.place, f.h);
  const T distance = dot(at.place, at.place), reach = t11 + t22 + hh + distance;

  // A minimum has no slope but outwards.
  const T down1  = max(select(x.xi < one, T(-g1), zero), select(x.xi > T(-one), g1, zero)),
          down2  = max(select(x.eta < one, T(-g2), zero), select(x.eta > T(-one), g2, zero));
  const T cosine = 1e-22 * distance + 1e-29 * reach;
  const T down   = max(down1, zero) * max(down1, zero) - t11 * cosine,
          down_2 = max(down2, zero) * max(down2, zero) - t22 * cosine;
  Proof<T> proof{distance, select(max(down, down_2) <= zero, one, zero)};

  const T negligible = 1e-24 * distance * reach;
  const T diagonal   = select(k > zero, one, T(-one));
  for (const double sign : {1., -1.})
    {
      const T u = sign - x.xi, v = sign * diagonal - x.eta, uv = u * v;
      const T G1 = max(T(u * g1), zero), G2 = max(T(v * g2), zero), K = uv * k;
      const T T11 = u * u * t11, T22 = v * v * t22, T12 = uv * t12, H1 = u * uv * h1,
              H2 = v * uv * h2, HH = uv * uv * hh;
      const T S1 = T11 + T12 + H1, S2 = T22 + T12 + H2, SS = S1 + S2 + H1 + H2 + HH;
      T       x0 = zero, y0 = zero, holds = select(K * K <= negligible, one, zero);
      for (unsigned int pass = 0; pass < passes; ++pass)
        {
          const internal::Quadratic<T> m{T11 + 2. * G1,
                                         T22 + 2. * G2,
                                         T12 + 2. * (G1 + G2) - K + 2. * (G1 * y0 + G2 * x0),
                                         S1 + 2. * G1 + G2 - K - G2 * x0 * x0,
                                         S2 + G1 + 2. * G2 - K - G1 * y0 * y0,
                                         SS + 2. * (G1 + G2) - 2. * K};
          holds = max(holds, internal::copositive(m, x0, y0));
        }
      proof.holds = min(proof.holds, holds);
    }
  return proof;
}
} // namespace coracle::contact
