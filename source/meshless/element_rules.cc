// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/element_rules.h>

#include <algorithm>
#include <numeric>

namespace coracle::meshless
{
namespace
{
/// Least share of its volume that an element keeps at each point when its points move.
constexpr double least_share = 0.1;
} // namespace

template <int dim>
void
ElementRules<dim>::reinit(const PointCloud<dim> &points, const Tessellation<dim> &tessellation)
{
  first_point.assign(1, 0);
  begin.clear();
  weight.clear();
  value.clear();
  gradient.clear();
  LaplaceShape<dim> shape;
  for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
    {
      shape.reinit(points, tessellation, e);
      for (unsigned int q = 0; q < shape.n_points(); ++q)
        {
          begin.push_back(value.size());
          weight.push_back(shape.weight(q));
          for (unsigned int i = 0; i < shape.n_nodes(); ++i)
            {
              value.push_back(shape.value(q, i));
              gradient.push_back(shape.gradient(q, i));
            }
        }
      first_point.push_back(weight.size());
    }
}

template <int dim>
unsigned int
ElementRules<dim>::set_moved(const ElementRules        &start,
                             const Tessellation<dim>   &tessellation,
                             const std::vector<Vector> &moved)
{
  *this                = start;
  unsigned int n_stays = 0;
  for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
    {
      const unsigned int  n     = tessellation.n_nodes(e);
      const unsigned int *nodes = tessellation.node.data() + tessellation.first_node[e];
      bool                stays = false;
      for (unsigned int q = first_point[e]; q < first_point[e + 1] && !stays; ++q)
        {
          dealii::Tensor<2, dim> F = dealii::unit_symmetric_tensor<dim>();
          for (unsigned int i = 0; i < n; ++i)
            F += outer_product(moved[nodes[i]], start.gradient[begin[q] + i]);
          const double share = determinant(F);
          stays              = !(share > least_share);
          if (stays)
            break;
          const dealii::Tensor<2, dim> to_moved = transpose(invert(F));
          weight[q]                             = share * start.weight[q];
          for (unsigned int i = 0; i < n; ++i)
            gradient[begin[q] + i] = to_moved * start.gradient[begin[q] + i];
        }
      if (!stays)
        continue;
      ++n_stays;
      for (unsigned int q = first_point[e]; q < first_point[e + 1]; ++q)
        {
          weight[q] = start.weight[q];
          std::copy_n(start.gradient.begin() + begin[q], n, gradient.begin() + begin[q]);
        }
    }
  return n_stays;
}

template <int dim>
double
ElementRules<dim>::volume() const
{
  return std::accumulate(weight.begin(), weight.end(), 0.);
}

template <int dim>
std::vector<double>
ElementRules<dim>::flatness() const
{
  std::vector<double> result(first_point.size() - 1, 0.);
  for (unsigned int e = 0; e + 1 < first_point.size(); ++e)
    for (unsigned int q = first_point[e]; q < first_point[e + 1]; ++q)
      {
        const std::size_t end     = q + 1 < begin.size() ? begin[q + 1] : gradient.size();
        double            largest = 0;
        for (std::size_t k = begin[q]; k < end; ++k)
          largest = std::max(largest, gradient[k].norm_square());
        result[e] += weight[q] * largest;
      }
  return result;
}

template class ElementRules<2>;
template class ElementRules<3>;
} // namespace coracle::meshless
