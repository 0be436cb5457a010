// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/laplace.h>

namespace coracle::meshless
{
/**
 * Quadrature points of all elements of this rank with shape functions and
 * gradients, in the order of elements: what every integral of a step needs,
 * whether an element is a simplex or not. Plain columns.
 */
template <int dim>
class ElementRules
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// Of the elements where they are.
  void reinit(const PointCloud<dim> &points, const Tessellation<dim> &tessellation);

  /**
   * Of the elements after their points have moved, which are the same functions of the points'
   * labels: with F = I + sum_j d_j grad N_j, gradients become F^-T grad N and weights w det F.
   * Exact for simplices. An element that would turn over or nearly so stays as it is.
   *
   * @param moved displacement of every point [m]
   * @return elements that stay
   */
  unsigned int set_moved(const ElementRules        &start,
                         const Tessellation<dim>   &tessellation,
                         const std::vector<Vector> &moved);

  /// Calls action(nodes, n_nodes, weight, values, gradients) at each quadrature point.
  template <typename Action>
  void for_each(const Tessellation<dim> &tessellation, const Action &action) const
  {
    for_each(tessellation, {}, action);
  }

  /// The same with weights times a factor of the element; no factors: 1.
  template <typename Action>
  void for_each(const Tessellation<dim>   &tessellation,
                const std::vector<double> &factor,
                const Action              &action) const
  {
    for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
      {
        const unsigned int  n     = tessellation.n_nodes(e);
        const unsigned int *nodes = tessellation.node.data() + tessellation.first_node[e];
        const double        times = factor.empty() ? 1. : factor[e];
        for (unsigned int q = first_point[e]; q < first_point[e + 1]; ++q)
          action(nodes, n, times * weight[q], value.data() + begin[q], gradient.data() + begin[q]);
      }
  }

  /// The same for some elements.
  template <typename Action>
  void for_each_of(const std::vector<unsigned int> &elements,
                   const Tessellation<dim>         &tessellation,
                   const Action                    &action) const
  {
    for (const unsigned int e : elements)
      {
        const unsigned int  n     = tessellation.n_nodes(e);
        const unsigned int *nodes = tessellation.node.data() + tessellation.first_node[e];
        for (unsigned int q = first_point[e]; q < first_point[e + 1]; ++q)
          action(nodes, n, weight[q], value.data() + begin[q], gradient.data() + begin[q]);
      }
  }

  /// Of all elements here [m^dim].
  double volume() const;

  /// By element, integral of the largest |grad N_i|^2 [m^(dim-2)]: large where it is flat.
  std::vector<double> flatness() const;

private:
  /// By element.
  std::vector<unsigned int> first_point = {0};
  /// By quadrature point: first value and gradient, and weight.
  std::vector<std::size_t> begin;
  std::vector<double>      weight;
  /// By quadrature point and node.
  std::vector<double> value;
  std::vector<Vector> gradient;
};
} // namespace coracle::meshless
