// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <array>

namespace coracle::contact
{
/// Part t of the way from a to b.
template <int dim>
inline dealii::Point<dim>
between(const dealii::Point<dim> &a, const dealii::Point<dim> &b, const double t)
{
  return a + t * (b - a);
}

/// The same for the corners of a facet.
template <int dim, std::size_t n>
inline std::array<dealii::Point<dim>, n>
between(const std::array<dealii::Point<dim>, n> &a,
        const std::array<dealii::Point<dim>, n> &b,
        const double                             t)
{
  std::array<dealii::Point<dim>, n> result;
  for (std::size_t k = 0; k < n; ++k)
    result[k] = between(a[k], b[k], t);
  return result;
}
} // namespace coracle::contact
