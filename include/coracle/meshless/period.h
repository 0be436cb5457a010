// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>

#include <array>
#include <cmath>
#include <vector>

namespace coracle::meshless
{
/**
 * Directions in which the fluid goes on beyond one face of its box with what is
 * inside the opposite one. By default none.
 *
 * Coordinates along them are kept as multiples of a power of two, small enough
 * to be no error and large enough that a period more or less has none: an
 * element at the face is then found alike, to the last bit, on both sides.
 */
template <int dim>
class Period
{
public:
  using Vector = dealii::Tensor<1, dim>;

  Period() = default;
  Period(const dealii::BoundingBox<dim> &box, const std::array<bool, dim> &along)
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (along[d])
        {
          const double low = box.lower_bound(d), high = box.upper_bound(d);
          // The largest coordinate of an image has 53 digits.
          const double reach = std::max(std::fabs(low), std::fabs(high)) + 2 * (high - low);
          unit[d]            = std::ldexp(1., std::ilogb(reach) - 51);
          start[d]           = low;
          length[d]          = rounded(high - low, d);
        }
  }

  bool along(const unsigned int d) const { return length[d] > 0; }
  bool any() const { return length.norm_square() > 0; }
  /// The shortest of all, infinite if there is none [m].
  double shortest() const
  {
    double result = std::numeric_limits<double>::infinity();
    for (unsigned int d = 0; d < dim; ++d)
      if (along(d))
        result = std::min(result, length[d]);
    return result;
  }

  /// The same place in the box.
  dealii::Point<dim> wrapped(dealii::Point<dim> x) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (along(d))
        {
          x[d] = rounded(x[d], d);
          x[d] -= length[d] * std::floor((x[d] - start[d]) / length[d]);
        }
    return x;
  }

  /// Of all places that differ by periods, what leads to the nearest one.
  Vector nearest(Vector way) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (along(d))
        way[d] -= length[d] * std::round(way[d] / length[d]);
    return way;
  }

  /// From a point to its images beside the box; first zero.
  std::vector<Vector> shifts() const
  {
    std::vector<Vector> result(1);
    for (unsigned int d = 0; d < dim; ++d)
      for (std::size_t i = 0, n = along(d) ? result.size() : 0; i < n; ++i)
        for (const double sign : {-1., 1.})
          {
            Vector shift = result[i];
            shift[d]     = sign * length[d];
            result.push_back(shift);
          }
    return result;
  }

private:
  double rounded(const double x, const unsigned int d) const
  {
    return std::nearbyint(x / unit[d]) * unit[d];
  }

  Vector length, start, unit;
};
} // namespace coracle::meshless
