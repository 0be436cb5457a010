// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

/// How often a point enters a body that moves on a lattice: exact integer arithmetic.
namespace lattice
{
__extension__ typedef __int128 Whole;
/// Wide enough for all values below.
using Wide = boost::multiprecision::int256_t;

/// Places on a lattice, at the start and at the end of the step.
template <int dim>
using Lattice = std::array<std::array<long, dim>, 2>;

/// Point and body of one step: dim vectors from a corner span a simplex or a parallelepiped.
template <int dim>
struct Step
{
  Lattice<dim>                  point, corner;
  std::array<Lattice<dim>, dim> edge;
  bool                          box;
};

/// A time in the step: k / 2^bits.
struct Time
{
  long k;
  int  bits;

  explicit Time(const long double t, const int b = 50) : k(std::lround(std::ldexp(t, b))), bits(b)
  {}
  long double value() const { return std::ldexp(static_cast<long double>(k), -bits); }
};

/// A polynomial in time of degree dim with whole coefficients.
template <int dim>
using Polynomial = std::array<Whole, dim + 1>;

/// Sign of the polynomial's value.
template <int dim>
int
sign_at(const Polynomial<dim> &c, const Time &time)
{
  // Where the value is far from 0, floating point numbers know its sign.
  const long double t   = time.value();
  long double       sum = 0, bound = 0;
  for (int i = dim; i >= 0; --i)
    {
      sum   = sum * t + static_cast<long double>(c[i]);
      bound = bound + std::abs(static_cast<long double>(c[i]));
    }
  if (std::abs(sum) > 1e-17l * bound)
    return sum > 0 ? 1 : -1;
  Wide exact = 0, power = 1;
  for (int i = 0; i <= dim; ++i)
    {
      exact += (Wide(c[i]) * power) << (time.bits * (dim - i));
      power *= time.k;
    }
  return exact.sign();
}

/// Determinant of vectors that change linearly in time.
template <int dim>
Polynomial<dim>
determinant(const std::array<Lattice<dim>, dim> &v)
{
  Polynomial<dim> result{};
  const auto      add = [&](const std::array<int, dim> &order, const int sign) {
    Polynomial<dim> product{};
    product[0] = sign;
    for (int i = 0; i < dim; ++i)
      {
        const Whole a = v[i][0][order[i]], b = v[i][1][order[i]] - a;
        for (int j = dim; j >= 0; --j)
          product[j] = product[j] * a + (j > 0 ? product[j - 1] * b : 0);
      }
    for (int j = 0; j <= dim; ++j)
      result[j] += product[j];
  };
  if constexpr (dim == 2)
    {
      add({{0, 1}}, 1);
      add({{1, 0}}, -1);
    }
  else
    {
      add({{0, 1, 2}}, 1);
      add({{1, 2, 0}}, 1);
      add({{2, 0, 1}}, 1);
      add({{0, 2, 1}}, -1);
      add({{2, 1, 0}}, -1);
      add({{1, 0, 2}}, -1);
    }
  return result;
}

template <int dim>
Lattice<dim>
difference(const Lattice<dim> &a, const Lattice<dim> &b)
{
  auto result = a;
  for (unsigned int t = 0; t < 2; ++t)
    for (int d = 0; d < dim; ++d)
      result[t][d] -= b[t][d];
  return result;
}

/// What decides where the point is: the whole volume, and the volume between the point and each
/// face.
template <int dim>
std::vector<Polynomial<dim>>
volumes(const Step<dim> &s)
{
  std::vector<Polynomial<dim>> result = {determinant<dim>(s.edge)};
  const auto                   p      = difference<dim>(s.point, s.corner);
  Polynomial<dim>              rest   = result[0];
  for (int i = 0; i < dim; ++i)
    {
      auto v = s.edge;
      v[i]   = p;
      result.push_back(determinant<dim>(v));
      Polynomial<dim> other = result[0];
      for (int j = 0; j <= dim; ++j)
        {
          rest[j] -= result.back()[j];
          other[j] -= result.back()[j];
        }
      if (s.box)
        result.push_back(other);
    }
  if (!s.box)
    result.push_back(rest);
  return result;
}

/// Times where one of the polynomials may change its sign.
template <int dim>
void
add_times(const Polynomial<dim> &c, std::vector<long double> &times)
{
  const auto f = [&c](const long double t) {
    long double sum = 0;
    for (int i = dim; i >= 0; --i)
      sum = sum * t + static_cast<long double>(c[i]);
    return sum;
  };
  std::vector<long double> parts = {0.l};
  const long double        C = c[1], B = 2.l * static_cast<long double>(c[2]),
                    A    = (dim == 3 ? 3.l * static_cast<long double>(c[dim]) : 0.l),
                    root = B * B - 4 * A * C;
  for (const int sign : {-1, 1})
    {
      const long double t = (A == 0      ? (B != 0 ? -C / B : -1.l)
                             : root >= 0 ? (-B + sign * std::sqrt(root)) / (2 * A)
                                         : -B / (2 * A));
      if (t > 0 && t < 1)
        parts.push_back(t);
    }
  parts.push_back(1.l);
  std::sort(parts.begin(), parts.end());
  for (std::size_t i = 0; i + 1 < parts.size(); ++i)
    {
      times.push_back(parts[i]);
      long double a = parts[i], b = parts[i + 1];
      if ((f(a) > 0) == (f(b) > 0))
        continue;
      const bool rising = f(b) > f(a);
      for (unsigned int k = 0; k < 62; ++k)
        {
          const long double m            = 0.5l * (a + b);
          ((f(m) > 0) == rising ? b : a) = m;
        }
      times.push_back(a);
    }
}

/// +1 inside, -1 inside a body turned inside out, else 0. On the surface a point is still where the
/// normal points.
template <int dim>
int
winding(const std::vector<Polynomial<dim>> &v, const Time &time)
{
  const int all    = sign_at<dim>(v[0], time);
  bool      inside = (all != 0);
  for (std::size_t i = 1; inside && i < v.size(); ++i)
    {
      const int part = sign_at<dim>(v[i], time);
      inside         = (all > 0 ? part > 0 : part <= 0);
    }
  return inside ? all : 0;
}

/// Is the point on an edge or vertex then?
template <int dim>
bool
on_edge(const std::vector<Polynomial<dim>> &v, const Time &time)
{
  return std::count_if(v.begin() + 1, v.end(), [&time](const auto &part) {
           return sign_at<dim>(part, time) == 0;
         }) > 1;
}

template <int dim>
bool
is_zero(const Polynomial<dim> &c)
{
  return std::all_of(c.begin(), c.end(), [](const Whole a) { return a == 0; });
}

/// Distance from the nearest plane of a face.
template <int dim>
double
depth(const Step<dim> &s, const std::vector<Polynomial<dim>> &v, const Time &time)
{
  using Vector = std::array<long double, dim>;
  std::array<Vector, dim + 1> e;
  for (int i = 0; i < dim; ++i)
    for (int d = 0; d < dim; ++d)
      e[i][d] = s.edge[i][0][d] + time.value() * (s.edge[i][1][d] - s.edge[i][0][d]);
  const auto minus = [](const Vector &a, const Vector &b) {
    Vector c;
    for (int d = 0; d < dim; ++d)
      c[d] = a[d] - b[d];
    return c;
  };
  // Area of the face that two edges span (2-D: length of the one edge).
  const auto area = [](const Vector &a, const Vector &b) {
    if constexpr (dim == 2)
      return std::hypot(a[0], a[1]);
    else
      return std::hypot(a[1] * b[2] - a[2] * b[1],
                        a[2] * b[0] - a[0] * b[2],
                        a[0] * b[1] - a[1] * b[0]);
  };
  double            result = 1e300;
  const long double t      = time.value();
  for (std::size_t i = 1; i < v.size(); ++i)
    {
      // See the order in volumes().
      const int   face = (s.box ? (i - 1) / 2 : i - 1);
      long double size, part = 0;
      if (face < dim)
        size = area(e[(face + 1) % dim], e[(face + 2) % dim]);
      else
        size = area(minus(e[1], e[0]), minus(e[dim - 1], e[0]));
      for (int j = dim; j >= 0; --j)
        part = part * t + static_cast<long double>(v[i][j]);
      result = std::min(result, double(std::abs(part) / size));
    }
  return result;
}

/// Extent of the body and length of the point's path, the larger.
template <int dim>
std::array<double, 2>
sizes(const Step<dim> &s)
{
  long size = 0, path = 0;
  for (const auto &e : s.edge)
    for (const auto &x : e)
      for (const long c : x)
        size = std::max(size, std::abs(c));
  for (int d = 0; d < dim; ++d)
    path = std::max(path, std::abs(s.point[1][d] - s.point[0][d]));
  return {{double(size), double(path)}};
}

/// What the oracle finds.
struct Answer
{
  /// How often the point goes in deeper than `tolerance`, at least.
  unsigned int entries = 0;
  /// And no matter how deep.
  unsigned int all = 0;
  /// A body that keeps its volume, and a point that starts and ends off the planes of its faces by
  /// more than `tolerance`: the number of entries is no matter of definition.
  bool ordinary = true;
};

/// Enters as often as the winding number grows; excursions into the body or out of it no farther
/// than `tolerance` are none.
template <int dim>
unsigned int
times_in(const Step<dim>                    &s,
         const std::vector<Polynomial<dim>> &v,
         const std::vector<Time>            &between,
         const double                        tolerance)
{
  const Time   start(0), end(1);
  unsigned int result = 0;
  int          old    = winding<dim>(v, start);
  // On an edge of a body that is inside out both is right.
  if (old < 0 && on_edge<dim>(v, start))
    old = 0;
  bool was_positive = sign_at<dim>(v[0], start) > 0;
  for (const auto &time : between)
    {
      if (tolerance > 0 && depth<dim>(s, v, time) < tolerance)
        continue;
      const int now = winding<dim>(v, time);
      // In the moment in which the body has no volume and turns inside out, nothing is inside.
      const bool positive = sign_at<dim>(v[0], time) > 0;
      result += (now > old && positive == was_positive);
      old          = now;
      was_positive = positive;
    }
  const int last = winding<dim>(v, end);
  if ((old >= 0 || !on_edge<dim>(v, end)) && !(tolerance > 0 && depth<dim>(s, v, end) < tolerance))
    result += (last > old);
  return result;
}

template <int dim>
Answer
answer(const Step<dim> &s, const std::vector<Polynomial<dim>> &v, const double tolerance)
{
  std::vector<long double> times = {0.l, 1.l};
  for (const auto &polynomial : v)
    add_times<dim>(polynomial, times);
  std::sort(times.begin(), times.end());
  // Between two times at which the point is in the plane of a face nothing changes.
  std::vector<Time> between;
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    if (times[i + 1] - times[i] > 1e-14l)
      between.emplace_back(0.5l * (times[i] + times[i + 1]));
  Answer result;
  result.all     = times_in<dim>(s, v, between, 0);
  result.entries = std::min(result.all, times_in<dim>(s, v, between, tolerance));
  for (const auto &time : between)
    result.ordinary = result.ordinary && sign_at<dim>(v[0], time) > 0;
  // Also where it is smallest.
  long double largest = 0;
  for (const Whole c : v[0])
    largest = std::max(largest, std::abs(static_cast<long double>(c)));
  for (const long double t : times)
    {
      long double volume = 0;
      for (int i = dim; i >= 0; --i)
        volume = volume * t + static_cast<long double>(v[0][i]);
      result.ordinary = result.ordinary && volume > 1e-9l * largest;
    }
  for (const long t : {0, 1})
    result.ordinary = result.ordinary && depth<dim>(s, v, Time(t)) > tolerance;
  return result;
}
} // namespace lattice
