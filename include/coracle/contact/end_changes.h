// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/tensor.h>

#include <vector>

namespace coracle::contact
{
/**
 * What is to become of the ends of structures' paths within a step, see
 * ContinuousCheck. Velocities do not change.
 *
 * Entries of a node that several ranks have are summed over these; those of a
 * hanging node go to its parents.
 */
template <int dim>
struct EndChanges
{
  /// Per node of the surface: sum of the displacements that it is asked for [m].
  std::vector<dealii::Tensor<1, dim>> shift;
  /// Per node: how many displacements are in that sum, and how often it is asked to be held. A node
  /// that is held takes no displacement, others take the mean.
  std::vector<dealii::Tensor<1, dim>> count;
  /// The part of the way since the start of the step that held nodes keep [1].
  double held_part = 0;
  /// The part of the motion since the start of the step that each rigid body keeps [1].
  std::vector<double> rigid_part;

  void reinit(const std::size_t n_nodes, const std::size_t n_rigid_bodies, const double part)
  {
    shift.assign(n_nodes, {});
    count.assign(n_nodes, {});
    rigid_part.assign(n_rigid_bodies, 1.);
    held_part = part;
  }
  void move(const unsigned int node, const dealii::Tensor<1, dim> &way)
  {
    shift[node] += way;
    count[node][0] += 1;
  }
  void hold(const unsigned int node) { count[node][1] += 1; }
};
} // namespace coracle::contact
