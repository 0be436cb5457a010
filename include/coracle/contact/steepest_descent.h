// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/nearest_point.h>

namespace coracle::contact
{
/// When steepest descent stops; Song, Liu & Zhang (2020) name no values but alpha "around 1".
struct DescentControl
{
  /// Relaxation, alpha of Eq. 42 [1].
  double relaxation = 1;
  /// Eq. 48, sum of the squared cosines of the angles to the tangents, and Eq. 51, square of the
  /// step in natural coordinates [1].
  double angle = 1e-10, step = 1e-10;
  /// On warped facets it may go back and forth for ever.
  unsigned int maximum_iterations = 100;
};

/**
 * Nearest point of a facet as Song, Liu & Zhang (2020) look for it, section 3.3:
 * steepest descent from the centre in natural coordinates, which are moved back
 * to the square after each step (Eq. 50).
 *
 * Equations 41 and 42 each have a wrong sign, which cancel: with g = x_p - x the
 * step is xi += 2 alpha gamma g.t_xi. The step length gamma, Eq. 46, is that of a flat facet
 * with orthogonal tangents. The cosines of Eq. 49 are 0/0 on the surface; the
 * test is therefore multiplied out.
 *
 * For comparison: it may stop short (Eq. 51 cannot tell a minimum from a short
 * step), and it ends in whatever local minimum it meets.
 *
 * @return natural coordinates in [-1,1]^2; those of the last step if it has not converged
 */
template <typename T>
inline NaturalPoint<T>
steepest_descent(const Bilinear<T> &f, const DescentControl &control)
{
  const T         one = splat<T>(1.), zero = splat<T>(0.), tiny = splat<T>(1e-300);
  NaturalPoint<T> x{zero, zero};
  T               moving = one;
  for (unsigned int iteration = 0; iteration < control.maximum_iterations; ++iteration)
    {
      const auto at = evaluate(f, x);
      const T    a = -dot(at.place, at.t_xi), b = -dot(at.place, at.t_eta), aa = a * a, bb = b * b,
              square_xi = dot(at.t_xi, at.t_xi), square_eta = dot(at.t_eta, at.t_eta);
      const T bound = control.angle * dot(at.place, at.place) * square_xi * square_eta;
      moving        = select(aa * square_eta + bb * square_xi <= bound, zero, moving); // Eq. 48
      if (sum(moving) == 0.)
        break;
      const T two_gamma = (aa + bb) / (aa * square_xi + bb * square_eta + tiny); // Eq. 46
      const T step      = control.relaxation * moving * two_gamma;
      const T xi        = clamp(T(x.xi + step * a), T(-one), one),
              eta       = clamp(T(x.eta + step * b), T(-one), one);
      const T move      = (xi - x.xi) * (xi - x.xi) + (eta - x.eta) * (eta - x.eta);
      x                 = {xi, eta};
      moving            = select(move < splat<T>(control.step), zero, moving); // Eq. 51
      if (sum(moving) == 0.)
        break;
    }
  return x;
}

/// The same in the plane, where the first step is exact.
NearestPoint<2> nearest_point_by_descent(const dealii::Point<2>                &x_p,
                                         const std::array<dealii::Point<2>, 2> &vertices);

/// Quadrilaterals only.
NearestPoint<3> nearest_point_by_descent(const dealii::Point<3>                &x_p,
                                         const std::array<dealii::Point<3>, 4> &vertices);
} // namespace coracle::contact
