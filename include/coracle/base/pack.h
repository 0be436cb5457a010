// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

/**
 * SIMD packs: n doubles that are computed with as one value.
 *
 * A pack is the compiler's own vector type, so that +, -, *, /, comparisons and
 * mask ? a : b work lane by lane and a machine without wide registers gets the
 * same results from narrower ones. Functions here have the same name for packs
 * and for plain doubles, so that a material or kernel is written once for both.
 */
namespace coracle
{
template <int n>
struct PackType
{
  using type [[gnu::vector_size(n * sizeof(double))]] = double;
  using mask [[gnu::vector_size(n * sizeof(double))]] = long;
};

template <int n>
using Pack = typename PackType<n>::type;

/// Lanes of a mask are 0 (false) or -1 (true).
template <int n>
using Mask = typename PackType<n>::mask;

/// Particles, elements or contacts handled together in the hot loops.
constexpr int pack_size = 8;

using Pack8 = Pack<pack_size>;
using Mask8 = Mask<pack_size>;

template <typename T>
struct PackTraits
{
  static constexpr int size = sizeof(T) / sizeof(double);
};

/// The same value in all lanes.
template <typename T>
inline T
splat(const double value)
{
  return T{} + value;
}

/// n consecutive doubles from any address.
template <typename T>
inline T
load(const double *const address)
{
  T result;
  std::memcpy(&result, address, sizeof(T));
  return result;
}

template <typename T>
inline void
store(double *const address, const T &value)
{
  std::memcpy(address, &value, sizeof(T));
}

/// Store only the first n_lanes lanes, for the tail of a column.
template <typename T>
inline void
store_first(double *const address, const T &value, const int n_lanes)
{
  std::memcpy(address, &value, n_lanes * sizeof(double));
}

/// The first n lanes.
inline Mask8
first_lanes(const int n)
{
  const Mask8 lane = {0, 1, 2, 3, 4, 5, 6, 7};
  return lane < n;
}

/// Largest lane.
template <typename T>
inline double
largest(const T &value)
{
  double result = value[0];
  for (int l = 1; l < PackTraits<T>::size; ++l)
    result = std::max(result, value[l]);
  return result;
}

inline double
sum(const double value)
{
  return value;
}

template <typename T>
inline double
sum(const T &value)
{
  double result = 0;
  for (int l = 0; l < PackTraits<T>::size; ++l)
    result += value[l];
  return result;
}

/// mask ? a : b, lane by lane.
inline double
select(const bool mask, const double a, const double b)
{
  return mask ? a : b;
}

template <typename M, typename T>
inline T
select(const M &mask, const T &a, const T &b)
{
  return mask ? a : b;
}

template <typename T>
inline T
max(const T &a, const T &b)
{
  return select(a > b, a, b);
}

template <typename T>
inline T
min(const T &a, const T &b)
{
  return select(a < b, a, b);
}

template <typename T>
inline T
abs(const T &a)
{
  return max(a, T(-a));
}

/// Apply a scalar function to every lane.
template <typename F>
inline double
each_lane(const double value, const F &function)
{
  return function(value);
}

template <typename T, typename F>
inline T
each_lane(const T &value, const F &function)
{
  T result{};
  for (int l = 0; l < PackTraits<T>::size; ++l)
    result[l] = function(value[l]);
  return result;
}

template <typename T>
inline T
sqrt(const T &a)
{
  return each_lane(a, [](const double x) { return std::sqrt(x); });
}

template <typename T>
inline T
log(const T &a)
{
  return each_lane(a, [](const double x) { return std::log(x); });
}

template <typename T>
inline T
pow(const T &a, const double exponent)
{
  return each_lane(a, [exponent](const double x) { return std::pow(x, exponent); });
}
} // namespace coracle
