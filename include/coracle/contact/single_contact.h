// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/delassus.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
/**
 * The next impulse of one contact, everything else held fixed: the step that
 * brings its velocity to the target, then cut to what is
 * admissible (P_n >= 0, |P_t| <= mu P_n).
 * @param slide what friction needs, or null for none
 * @param u     relative velocity now [m/s]
 */
template <int dim>
inline Lanes<dim>
next_impulse(const typename Delassus<dim>::Row           &row,
             const typename Delassus<dim>::Sliding *const slide,
             const Lanes<dim>                            &impulse,
             const Lanes<dim>                            &u,
             const double                                 target)
{
  const double old_normal = dot<dim>(impulse, row.normal);
  const double normal =
    std::max(0., old_normal - (dot<dim>(u, row.normal) - target) * row.normal_mass);
  if (slide == nullptr || normal == 0)
    return normal * row.normal;

  // Friction sees what the normal impulse has changed.
  const Lanes<dim> later      = u + (normal - old_normal) * slide->normal_response;
  Lanes<dim>       tangential = impulse - old_normal * row.normal;
  tangential -= (later - dot<dim>(later, row.normal) * row.normal) / slide->tangential_inverse_mass;
  const double limit = slide->friction * normal, square = dot<dim>(tangential, tangential);
  if (square > limit * limit)
    tangential *= limit / std::sqrt(square);
  return normal * row.normal + tangential;
}
} // namespace coracle::contact
