// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/delassus.h>

#include <algorithm>

namespace coracle::contact
{
/**
 * The next impulse of one contact, everything else held fixed: the step that
 * brings its velocity to the target, then cut to what is
 * admissible (P_n >= 0, |P_t| <= mu P_n).
 * @param u relative velocity now [m/s]
 */
template <int dim>
dealii::Tensor<1, dim>
next_impulse(const typename Delassus<dim>::Row &row,
             const dealii::Tensor<1, dim>      &impulse,
             dealii::Tensor<1, dim>             u,
             const double                       target,
             const bool                         friction)
{
  const double old_normal = impulse * row.normal;
  const double normal =
    std::max(0., old_normal - (u * row.normal - target) / row.normal_inverse_mass);
  if (!friction || row.friction == 0 || normal == 0)
    return normal * row.normal;

  // Friction sees what the normal impulse has changed.
  u += (normal - old_normal) * row.normal_response;
  dealii::Tensor<1, dim> tangential = impulse - old_normal * row.normal;
  tangential -= (u - (u * row.normal) * row.normal) / row.tangential_inverse_mass;
  const double limit = row.friction * normal, size = tangential.norm();
  if (size > limit)
    tangential *= limit / size;
  return normal * row.normal + tangential;
}
} // namespace coracle::contact
