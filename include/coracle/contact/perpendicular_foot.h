// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/nearest_point.h>

namespace coracle::contact
{
/// Foot of the perpendicular, and whether there is one.
template <typename T>
struct Foot
{
  NaturalPoint<T> place;
  /// 1 if the iteration converged, wherever it did; else 0.
  T found;
};

/**
 * Foot of the perpendicular from the point on the facet's surface, continued
 * beyond its edges: Newton-Raphson from the centre on t_xi.(x_p - x) = 0 and
 * t_eta.(x_p - x) = 0. Chen et al. (2015), Eqs. 36-39.
 *
 * For comparison. Only a foot inside the facet is a contact (Song 2020, Eq. 19), so that
 * beside the joint of two facets there may be none: the crack through which particles pass. On a
 * warped facet the foot found may be a saddle or the farther one of several.
 */
template <typename T>
inline Foot<T>
perpendicular_foot(const Bilinear<T> &f)
{
  constexpr unsigned int maximum_iterations = 30;
  const T                one = splat<T>(1.), zero = splat<T>(0.);
  Foot<T>                foot{{zero, zero}, zero};
  NaturalPoint<T>       &x      = foot.place;
  T                      moving = one;
  for (unsigned int iteration = 0; iteration < maximum_iterations; ++iteration)
    {
      const auto at   = evaluate(f, x);
      const T    r_xi = dot(at.place, at.t_xi), r_eta = dot(at.place, at.t_eta);
      const T    xi_xi = dot(at.t_xi, at.t_xi), eta_eta = dot(at.t_eta, at.t_eta),
              xi_eta      = dot(at.t_xi, at.t_eta) + dot(at.place, f.h);
      const T determinant = xi_xi * eta_eta - xi_eta * xi_eta;
      const T inverse     = select(determinant == zero, zero, T(one / determinant));
      const T d_xi        = inverse * (xi_eta * r_eta - eta_eta * r_xi),
              d_eta       = inverse * (xi_eta * r_xi - xi_xi * r_eta);
      x.xi += moving * d_xi;
      x.eta += moving * d_eta;
      const T step     = d_xi * d_xi + d_eta * d_eta;
      const T arrived  = moving * select(step < splat<T>(1e-20), one, zero);
      foot.found       = foot.found + arrived * select(determinant == zero, zero, one);
      const T far      = x.xi * x.xi + x.eta * x.eta;
      const T hopeless = select(far < splat<T>(1e6), select(determinant == zero, one, zero), one);
      moving           = moving * (one - max(arrived, hopeless));
      if (sum(moving) == 0.)
        break;
    }
  return foot;
}

/**
 * Where the foot lies inside the facet or on its edge, it is written to `foot`;
 * otherwise the result is false.
 */
bool perpendicular_foot(const dealii::Point<2>                &x_p,
                        const std::array<dealii::Point<2>, 2> &vertices,
                        NearestPoint<2>                       &foot);

bool perpendicular_foot(const dealii::Point<3>                &x_p,
                        const std::array<dealii::Point<3>, 4> &vertices,
                        NearestPoint<3>                       &foot);
} // namespace coracle::contact
