// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <cstdint>
#include <vector>

namespace coracle::contact
{
/**
 * Vector unknowns whose velocity has one inverse mass per direction: grid nodes
 * and structure nodes.
 */
template <int dim>
struct Unknown
{
  /// Predicted velocity, without contact [m/s].
  dealii::Tensor<1, dim> velocity;
  /// 1/m per direction, 0 where the motion is prescribed [1/kg].
  dealii::Tensor<1, dim> inverse_mass;
  /// The same unknown has the same key on every rank; `owner` sums its impulses.
  std::uint64_t key   = 0;
  int           owner = 0;
};

/**
 * A rigid body: the same on all ranks. Spin is about z in 2-D (component 2 of
 * the pseudo-vector).
 */
template <int dim>
struct RigidUnknown
{
  /// Centre of mass [m].
  dealii::Point<dim> centre;
  /// Predicted velocity of the centre [m/s] and spin [rad/s], without contact.
  dealii::Tensor<1, dim> velocity;
  dealii::Tensor<1, 3>   spin;
  /// 1/M per direction, 0 where not free [1/kg].
  dealii::Tensor<1, dim> inverse_mass;
  /// Inverse inertia about the centre in the current frame; in 2-D only entry (2,2) is used [1/(kg
  /// m^2)].
  dealii::Tensor<2, 3> inverse_inertia;
};

/**
 * Sides of the contacts as rows: velocity of a side = sum of weight *
 * velocity[unknown], or the motion of a rigid body at the point. Side 0 is the
 * point (a material point, or a surface node of a structure), side 1 the facet.
 * An unknown may be on either side of different contacts.
 */
struct Rows
{
  struct Entry
  {
    unsigned int unknown;
    double       weight;
  };
  /// Entries of side s of contact c: begin[2 * c + s] up to begin[2 * c + s + 1].
  std::vector<std::size_t> begin = {0};
  std::vector<Entry>       entries;
  /// Rigid body of each side, or -1.
  std::vector<std::array<int, 2>> rigid_body;

  std::size_t n_contacts() const { return rigid_body.size(); }

  void clear()
  {
    begin.assign(1, 0);
    entries.clear();
    rigid_body.clear();
  }
};

/// What the solver gives back, per contact, as acting on the point (the facet gets the opposite).
template <int dim>
struct Impulses
{
  /// Impulse P, normal and friction [N s].
  std::vector<dealii::Tensor<1, dim>> impulse;
  /// "Mass times displacement" of the position solve [kg m]; moves positions, never velocities.
  std::vector<dealii::Tensor<1, dim>> correction;
};

/// Velocities of unknowns and rigid bodies with contact, in the order they were given.
template <int dim>
struct Velocities
{
  std::vector<dealii::Tensor<1, dim>> nodes;
  std::vector<dealii::Tensor<1, dim>> rigid;
  std::vector<dealii::Tensor<1, 3>>   spin;
};
} // namespace coracle::contact
