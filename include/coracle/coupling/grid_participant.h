// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/grid_contact_law.h>
#include <coracle/grid/octree.h>

namespace coracle
{
/// One body, or one velocity field, as grid contact sees it on the nodes of the octree. Hanging
/// nodes have nothing: their parents take their share.
template <int dim>
struct GridParticipant
{
  /// Places in the records: mass [kg], velocity [m/s], inverse mass per direction [1/kg].
  struct Motion
  {
    static constexpr unsigned int mass = 0, velocity = 1, inverse_mass = 1 + dim;
  };
  /// Gradient of the mass, out of the body [kg/m]; impulse of this step [N s].
  struct Contact
  {
    static constexpr unsigned int gradient = 0, impulse = dim;
  };

  explicit GridParticipant(const unsigned int n_nodes) : motion(n_nodes), contact(n_nodes) {}

  NodeRecords motion, contact;

  double                 mass(const unsigned int node) const { return motion[node][Motion::mass]; }
  dealii::Tensor<1, dim> gradient(const unsigned int node) const
  {
    return vector(contact[node], Contact::gradient);
  }
  dealii::Tensor<1, dim> impulse(const unsigned int node) const
  {
    return vector(contact[node], Contact::impulse);
  }
  GridContactSide<dim> side(const unsigned int node) const
  {
    return {vector(motion[node], Motion::velocity), vector(motion[node], Motion::inverse_mass)};
  }

  /// The impulse acts on the node.
  void add_impulse(const unsigned int node, const dealii::Tensor<1, dim> &value)
  {
    for (int d = 0; d < dim; ++d)
      {
        contact[node][Contact::impulse + d] += value[d];
        motion[node][Motion::velocity + d] += value[d] * motion[node][Motion::inverse_mass + d];
      }
  }

  static dealii::Tensor<1, dim> vector(const NodeRecord &record, const unsigned int first)
  {
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = record[first + d];
    return result;
  }
};

/// Calls action(node, weight): a hanging node is replaced by its parents.
template <int dim, typename Action>
void
for_each_conforming_node(const Octree<dim> &octree,
                         const unsigned int node,
                         const double       weight,
                         const Action      &action)
{
  const int hanging = octree.hanging_index(node);
  if (hanging < 0)
    action(node, weight);
  else
    for (const auto &[parent, share] : octree.hanging_nodes()[hanging].parents)
      action(parent, share * weight);
}
} // namespace coracle
