// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/tensor.h>

namespace coracle
{
/// What grid contact knows of one body at one node.
template <int dim>
struct GridContactSide
{
  /// Without this contact [m/s].
  dealii::Tensor<1, dim> velocity;
  /// 1/m per direction, 0 where the motion is prescribed [1/kg].
  dealii::Tensor<1, dim> inverse_mass;
};

/**
 * Impulse on s of two bodies r and s that meet at a grid node, the opposite on
 * r [N s]; zero if they part.
 *
 * Bodies approach where (v_r - v_s) n > 0 with n out of r (Eq. 22; Bardenhagen,
 * Brackbill & Sulsky 2000). The impulse that makes both velocities equal (stick,
 * Eq. 28) is taken if its tangential part is within Coulomb's cone; otherwise
 * its tangential part has mu times the size of the normal one and the normal
 * velocities become equal (slip, Eqs. 29-32). Never adds energy.
 *
 * Equations of Chen, Qiu, Zhang, Lian & Liu (2015), here for inverse masses
 * that may differ by direction.
 *
 * @param normal   out of r, unit length
 * @param friction Coulomb coefficient [1]
 */
template <int dim>
dealii::Tensor<1, dim>
grid_contact_impulse(const GridContactSide<dim>   &r,
                     const GridContactSide<dim>   &s,
                     const dealii::Tensor<1, dim> &normal,
                     const double                  friction)
{
  using Vector          = dealii::Tensor<1, dim>;
  const Vector relative = s.velocity - r.velocity, mobility = r.inverse_mass + s.inverse_mass;
  const double approach = -(relative * normal);
  if (approach <= 0)
    return Vector();

  Vector stick;
  for (int d = 0; d < dim; ++d)
    stick[d] = mobility[d] > 0 ? -relative[d] / mobility[d] : 0.;
  const double pressing   = stick * normal;
  const Vector tangential = stick - pressing * normal;
  const double holding    = tangential.norm();
  if (pressing > 0 && holding <= friction * pressing)
    return stick;

  // The impulse along a direction that ends the approach, none if it does not end it or brings
  // energy.
  const auto along = [&](const Vector &direction) {
    Vector change;
    for (int d = 0; d < dim; ++d)
      change[d] = mobility[d] * direction[d];
    const double response = change * normal;
    if (response <= 0)
      return Vector();
    const double size = approach / response;
    return direction * (2. * relative + size * change) <= 0 ? size * direction : Vector();
  };
  // With directions prescribed, friction may press as much as it holds: then it is left out.
  if (holding > 0 && friction > 0)
    {
      const Vector slip = along(normal + (friction / holding) * tangential);
      if (slip.norm_square() > 0)
        return slip;
    }
  return along(normal);
}
} // namespace coracle
