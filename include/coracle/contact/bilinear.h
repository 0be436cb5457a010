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

/// Natural coordinates on a facet.
template <typename T>
struct NaturalPoint
{
  T xi, eta;
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

/// Place on the facet relative to the point, and the tangents along xi and eta there.
template <typename T>
struct PlaceAndTangents
{
  Vector<3, T> place, t_xi, t_eta;
};

template <typename T>
inline PlaceAndTangents<T>
evaluate(const Bilinear<T> &f, const NaturalPoint<T> &x)
{
  PlaceAndTangents<T> result;
  for (int d = 0; d < 3; ++d)
    {
      result.t_xi[d]  = f.b[d] + x.eta * f.h[d];
      result.t_eta[d] = f.c[d] + x.xi * f.h[d];
      result.place[d] = f.r[d] + x.xi * f.b[d] + x.eta * result.t_eta[d];
    }
  return result;
}

/// The same facet with xi and eta exchanged.
template <typename T>
inline Bilinear<T>
transposed(const Bilinear<T> &f)
{
  return {f.r, f.c, f.b, f.h};
}
} // namespace coracle::contact
