// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/tessellation.h>

#include <deal.II/base/tensor.h>

namespace coracle::meshless
{
/**
 * Laplace (non-Sibsonian) shape functions of one element and their gradients at
 * its quadrature points. An object is set to one element after the other and
 * allocates only for the largest.
 *
 * On a simplex they are the linear functions, gradients are the same at all
 * points, and there is one quadrature point (is_constant()).
 *
 * Source: Del Pin, Idelsohn, Onate & Calvo (2003), section 2; Belikov and
 * others (1997), The non-Sibsonian interpolation.
 */
template <int dim>
class LaplaceShape
{
public:
  void reinit(const PointCloud<dim>   &points,
              const Tessellation<dim> &tessellation,
              const unsigned int       element);

  unsigned int n_nodes() const { return n; }
  unsigned int n_points() const { return weights.size(); }
  /// Quadrature weight: the weights of an element add up to its volume [m^dim].
  double weight(const unsigned int q) const { return weights[q]; }
  /// Where [m].
  const dealii::Point<dim> &point(const unsigned int q) const { return quadrature[q]; }
  /// Shape function of the i-th node of the element.
  double value(const unsigned int q, const unsigned int i) const { return values[q * n + i]; }
  /// Its gradient [1/m].
  const dealii::Tensor<1, dim> &gradient(const unsigned int q, const unsigned int i) const
  {
    return gradients[q * n + i];
  }

private:
  unsigned int                        n = 0;
  std::vector<double>                 weights, values;
  std::vector<dealii::Point<dim>>     quadrature;
  std::vector<dealii::Tensor<1, dim>> gradients;
};
} // namespace coracle::meshless
