// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace coracle
{
/// Columns of a body's nodes; vectors take dim neighbouring ones. All state of a node is here.
template <int dim>
struct NodeColumns
{
  enum : unsigned int
  {
    /// Unloaded position [m].
    reference = 0,
    /// [m]
    position = dim,
    /// At half steps [m/s].
    velocity = 2 * dim,
    /// Displacement of the last step [m].
    increment = 3 * dim,
    /// Forces on the node: minus the divergence of the stress, then loads [N].
    internal = 4 * dim,
    external = 5 * dim,
    /// 1/m, 0 in a direction that a boundary condition prescribes [1/kg].
    inverse_mass = 6 * dim,
    /// Sum of contact impulses of this step [N s].
    impulse = 7 * dim,
    /// Sum of position impulses of this step [kg m].
    correction = 8 * dim,
    /// Contact force of the last step, mean over it [N].
    contact_force = 9 * dim,
    /// Lumped mass [kg].
    mass      = 10 * dim,
    n_columns = 10 * dim + 1
  };
};
} // namespace coracle
