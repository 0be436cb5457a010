// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/tensor.h>

#include <coracle/base/pack.h>

namespace coracle::contact
{
/**
 * A vector in a register of its own: two or four doubles, of which the fourth is
 * zero. Sweeps over contacts meet nodes in no order that could be vectorised, so
 * the lanes are the directions.
 */
template <int dim>
using Lanes = Pack<dim == 2 ? 2 : 4>;

template <int dim>
inline Lanes<dim>
to_lanes(const dealii::Tensor<1, dim> &t)
{
  if constexpr (dim == 2)
    return Lanes<2>{t[0], t[1]};
  else
    return Lanes<3>{t[0], t[1], t[2], 0.};
}

template <int dim>
inline dealii::Tensor<1, dim>
to_tensor(const Lanes<dim> &v)
{
  dealii::Tensor<1, dim> result;
  for (int d = 0; d < dim; ++d)
    result[d] = v[d];
  return result;
}

/// Scalar product; the fourth lane is left out.
template <int dim>
inline double
dot(const Lanes<dim> &a, const Lanes<dim> &b)
{
  const Lanes<dim> product = a * b;
  if constexpr (dim == 2)
    return product[0] + product[1];
  else
    return (product[0] + product[1]) + product[2];
}
} // namespace coracle::contact
