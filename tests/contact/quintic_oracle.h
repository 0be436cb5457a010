// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

/**
 * Nearest distance from a point to a bilinear facet, by another way than the
 * code that is tested: with x = a(eta) + xi b(eta) relative to the point and q = -a.b, the
 * stationary points inside are real roots in [-1,1] of the quintic
 *   (|a|^2)' |b|^4 - 2 q q' |b|^2 + q^2 (|b|^2)' = 0,  xi = q/|b|^2,
 * and the four edges are added.
 */
namespace quintic_oracle
{
using Vector3 = std::array<double, 3>;
using Corners = std::array<Vector3, 4>;

inline double
dot(const Vector3 &a, const Vector3 &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Polynomial of degree n, lowest power first.
template <std::size_t n>
using Polynomial = std::array<double, n + 1>;

template <std::size_t n, std::size_t m>
auto
product(const std::array<double, n> &a, const std::array<double, m> &b)
{
  std::array<double, n + m - 1> c{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j)
      c[i + j] += a[i] * b[j];
  return c;
}

template <std::size_t n>
auto
derivative(const std::array<double, n> &a)
{
  std::array<double, n - 1> c{};
  for (std::size_t i = 1; i < n; ++i)
    c[i - 1] = i * a[i];
  return c;
}

template <std::size_t n>
double
value(const std::array<double, n> &a, const double x)
{
  double result = 0;
  for (std::size_t i = n; i-- > 0;)
    result = result * x + a[i];
  return result;
}

/// A few places in ascending order.
struct Places
{
  std::array<double, 24> at;
  unsigned int           n = 0;
  void                   add(const double x) { at[n++] = x; }
};

/// Real roots in [-1, 1], and the zeros of all derivatives with them, between which each change of
/// sign is bisected.
template <std::size_t n>
Places
roots(const std::array<double, n> &a)
{
  if constexpr (n < 2)
    return {};
  else
    {
      Places stops, result = roots(derivative(a));
      stops.add(-1);
      for (unsigned int i = 0; i < result.n; ++i)
        stops.add(result.at[i]);
      stops.add(1);
      for (unsigned int i = 0; i + 1 < stops.n; ++i)
        {
          double       low = stops.at[i], high = stops.at[i + 1];
          const double at_low = value(a, low), at_high = value(a, high);
          if (at_low * at_high >= 0)
            continue;
          for (unsigned int k = 0; k < 52; ++k)
            {
              const double middle                                    = 0.5 * (low + high);
              ((value(a, middle) > 0) == (at_high > 0) ? high : low) = middle;
            }
          result.add(0.5 * (low + high));
        }
      std::sort(result.at.begin(), result.at.begin() + result.n);
      return result;
    }
}

inline double
square_to_segment(const Vector3 &a, const Vector3 &b)
{
  Vector3 t, x;
  for (int d = 0; d < 3; ++d)
    t[d] = b[d] - a[d];
  const double length = dot(t, t);
  const double s      = length > 0 ? std::max(0., std::min(1., -dot(a, t) / length)) : 0.;
  for (int d = 0; d < 3; ++d)
    x[d] = a[d] + s * t[d];
  return dot(x, x);
}

/// @param x corners relative to the point
inline double
distance(const Corners &x)
{
  Vector3 a0, a1, b0, b1;
  for (int d = 0; d < 3; ++d)
    {
      a0[d] = 0.25 * (x[0][d] + x[1][d] + x[2][d] + x[3][d]);
      a1[d] = 0.25 * ((x[2][d] - x[0][d]) + (x[3][d] - x[1][d]));
      b0[d] = 0.25 * ((x[1][d] - x[0][d]) + (x[2][d] - x[3][d]));
      b1[d] = 0.25 * ((x[0][d] - x[1][d]) + (x[2][d] - x[3][d]));
    }
  const Polynomial<2> A = {dot(a0, a0), 2 * dot(a0, a1), dot(a1, a1)},
                      B = {dot(b0, b0), 2 * dot(b0, b1), dot(b1, b1)},
                      q = {-dot(a0, b0), -dot(a0, b1) - dot(a1, b0), -dot(a1, b1)};
  Polynomial<5> quintic = product(derivative(A), product(B, B));
  const auto    second  = product(product(q, derivative(q)), B),
             third      = product(product(q, q), derivative(B));
  for (unsigned int i = 0; i < quintic.size(); ++i)
    quintic[i] += third[i] - 2 * second[i];

  double best = 1e300;
  for (unsigned int k = 0; k < 4; ++k)
    best = std::min(best, square_to_segment(x[k], x[(k + 1) % 4]));
  const auto etas = roots(quintic);
  for (unsigned int i = 0; i < etas.n; ++i)
    {
      // Any point of the line of this eta is a point of the facet: nothing is lost by its nearest.
      const double eta = etas.at[i];
      Vector3      low, high;
      for (int d = 0; d < 3; ++d)
        {
          low[d]  = a0[d] + eta * a1[d] - (b0[d] + eta * b1[d]);
          high[d] = a0[d] + eta * a1[d] + (b0[d] + eta * b1[d]);
        }
      best = std::min(best, square_to_segment(low, high));
    }
  return std::sqrt(best);
}

/// Corners of random facets around the origin, none of them larger than a few units.
enum class Shape
{
  quadrants,      // one corner in each quadrant, any height: Song et al. (2020), section 5.1
  flat,           // parallelogram
  lightly_warped, // unit square, corners moved by up to 0.05 in each direction
  warped,         // ... 0.3
  badly_warped,   // ... 1
  any,            // four points
  sliver,         // 1:1000, warped
  needle,         // two neighbouring corners equal
  pinched,        // two opposite corners equal
  edge,           // collapsed to an edge
  nearly_edge,    // ... but for 1e-9
  point           // collapsed to a point
};
constexpr unsigned int n_shapes = 12;

inline const char *
name(const Shape shape)
{
  constexpr std::array<const char *, n_shapes> names = {{"one corner in each quadrant",
                                                         "flat",
                                                         "slightly warped",
                                                         "warped",
                                                         "badly warped",
                                                         "any four points",
                                                         "sliver 1:1000",
                                                         "two equal corners",
                                                         "opposite corners equal",
                                                         "collapsed to an edge",
                                                         "nearly collapsed to an edge",
                                                         "collapsed to a point"}};
  return names[static_cast<unsigned int>(shape)];
}

class Random
{
public:
  explicit Random(const unsigned int seed) : generator(seed) {}

  double  operator()() { return uniform(generator); }
  Vector3 point() { return {{(*this)(), (*this)(), (*this)()}}; }

  Corners facet(const Shape shape)
  {
    const auto square = [this](const double warp, const double width = 1) {
      Corners x;
      for (unsigned int k = 0; k < 4; ++k)
        {
          const Vector3 shift = point();
          x[k]                = {{(k == 1 || k == 2 ? 0.5 : -0.5) + warp * shift[0],
                                  width * ((k >= 2 ? 0.5 : -0.5) + warp * shift[1]),
                                  (width < 1 ? width : 1) * warp * shift[2]}};
        }
      return x;
    };
    Corners x = square(0.3);
    switch (shape)
      {
        case Shape::quadrants:
          for (unsigned int k = 0; k < 4; ++k)
            {
              x[k]    = point();
              x[k][0] = (k == 1 || k == 2 ? 1 : -1) * std::abs(x[k][0]);
              x[k][1] = (k >= 2 ? 1 : -1) * std::abs(x[k][1]);
            }
          return x;
        case Shape::flat:
          for (int d = 0; d < 3; ++d)
            x[3][d] = x[0][d] + x[2][d] - x[1][d];
          return x;
        case Shape::lightly_warped:
          return square(0.05);
        case Shape::warped:
          return x;
        case Shape::badly_warped:
          return square(1);
        case Shape::any:
          return {{point(), point(), point(), point()}};
        case Shape::sliver:
          return square(0.3, 0.001);
        case Shape::needle:
          x[2] = x[1];
          return x;
        case Shape::pinched:
          x[2] = x[0];
          return x;
        case Shape::edge:
        case Shape::nearly_edge:
          x[3] = x[0];
          x[2] = x[1];
          if (shape == Shape::nearly_edge)
            for (unsigned int k = 2; k < 4; ++k)
              for (int d = 0; d < 3; ++d)
                x[k][d] += 1e-9 * (*this)();
          return x;
        case Shape::point:
          x[1] = x[2] = x[3] = x[0];
          return x;
      }
    return x;
  }

private:
  std::mt19937_64                  generator;
  std::uniform_real_distribution<> uniform{-1, 1};
};
} // namespace quintic_oracle
