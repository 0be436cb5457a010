// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/audit_path.h>

#include <algorithm>

namespace coracle::contact::audit_cut
{
/// How far triangles may be from a bilinear facet, in facet sizes.
constexpr double tolerance = 1e-9;
/// Facets are cut into four, again and again, at most this often.
constexpr unsigned int most_cuts = 12;
/// Room in facet sizes for what a path may be thought moved by.
constexpr double room = 3e-6;

/// Smallest and largest coordinates of the vertices at one time.
template <int dim>
struct Extent
{
  dealii::Point<dim> lower, upper;

  template <std::size_t n>
  explicit Extent(const std::array<dealii::Point<dim>, n> &x) : lower(x[0]), upper(x[0])
  {
    for (unsigned int k = 1; k < n; ++k)
      for (int d = 0; d < dim; ++d)
        {
          lower[d] = std::min(lower[d], x[k][d]);
          upper[d] = std::max(upper[d], x[k][d]);
        }
  }

  bool holds(const dealii::Point<dim> &p, const double room) const
  {
    bool result = true;
    for (int d = 0; d < dim; ++d)
      result &= (p[d] >= lower[d] - room) & (p[d] <= upper[d] + room);
    return result;
  }
};

/// Do the boxes of the path and of the moving facet miss each other by more than `room` [m]?
template <int dim>
inline bool
far_apart(const Path<dim> &p, const Extent<dim> &start, const Extent<dim> &end, const double room)
{
  bool result = false;
  for (int d = 0; d < dim; ++d)
    result |= (std::max(p[0][d], p[1][d]) < std::min(start.lower[d], end.lower[d]) - room) |
              (std::min(p[0][d], p[1][d]) > std::max(start.upper[d], end.upper[d]) + room);
  return result;
}

using MovingQuad = std::array<std::array<dealii::Point<3>, 4>, 2>;

/// The quarter of a bilinear facet at corner k, whose corner k that is.
inline MovingQuad
quarter(const MovingQuad &x, const unsigned int k)
{
  MovingQuad result;
  for (unsigned int t = 0; t < 2; ++t)
    {
      const unsigned int next = (k + 1) % 4, opposite = (k + 2) % 4, previous = (k + 3) % 4;
      result[t][k]        = x[t][k];
      result[t][next]     = x[t][k] + 0.5 * (x[t][next] - x[t][k]);
      result[t][previous] = x[t][k] + 0.5 * (x[t][previous] - x[t][k]);
      result[t][opposite] =
        dealii::Point<3>(0.25 * (x[t][0] + x[t][1]) + 0.25 * (x[t][2] + x[t][3]));
    }
  return result;
}

/// Calls action(triangle) for the parts of a bilinear facet that are near the path.
template <typename Action>
void
cut_quad(const Path<3>     &p,
         const MovingQuad  &x,
         const double       size,
         const unsigned int cuts,
         const Action      &action)
{
  if (cuts > 0 && far_apart<3>(p, Extent<3>(x[0]), Extent<3>(x[1]), room * size))
    return;
  // The triangles around the middle are off by a quarter of the corners' offset from a
  // parallelogram.
  double warp = 0;
  for (const auto &v : x)
    warp = std::max(warp, 0.25 * ((v[0] - v[1]) + (v[2] - v[3])).norm());
  if (0.25 * warp > tolerance * size && cuts < most_cuts)
    {
      for (unsigned int k = 0; k < 4; ++k)
        cut_quad(p, quarter(x, k), size, cuts + 1, action);
      return;
    }
  Path<3> middle;
  for (unsigned int t = 0; t < 2; ++t)
    middle[t] = dealii::Point<3>(0.25 * (x[t][0] + x[t][1]) + 0.25 * (x[t][2] + x[t][3]));
  for (unsigned int k = 0; k < 4; ++k)
    {
      const unsigned int next = (k + 1) % 4;
      action(
        MovingSimplex<3>{{{{x[0][k], x[0][next], middle[0]}}, {{x[1][k], x[1][next], middle[1]}}}});
    }
}

/// Calls action(simplex) for the simplices of a facet that are near the path.
template <typename Action>
void
for_each_simplex(const Path<2> &, const MovingFacet<2> &facet, const Action &action)
{
  action(facet.x);
}

template <typename Action>
void
for_each_simplex(const Path<3> &p, const MovingFacet<3> &facet, const Action &action)
{
  const auto &x = facet.x;
  if (facet.nodes[2] == facet.nodes[3])
    action(MovingSimplex<3>{{{{x[0][0], x[0][1], x[0][2]}}, {{x[1][0], x[1][1], x[1][2]}}}});
  else
    cut_quad(p, x, std::min(facet.size[0], facet.size[1]), 0, action);
}
} // namespace coracle::contact::audit_cut
