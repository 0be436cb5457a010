// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/rows.h>
#include <coracle/contact/surface.h>

#include <mpi.h>

namespace coracle::meshless
{
/**
 * The surfaces of structures and rigid bodies as the fluid meets them: their
 * nodes are points of the fluid that move with the body, without slip, and the
 * fluid's pressure gives them impulses.
 */
template <int dim>
class StructureWalls
{
public:
  using Vector  = dealii::Tensor<1, dim>;
  using Vector3 = dealii::Tensor<1, 3>;

  /// A node that this rank owns.
  struct Node
  {
    dealii::Point<dim> position;
    Vector             velocity, inverse_mass;
    std::uint64_t      key;
    /// Number among the nodes of the published surface, and of the rigid body or -1.
    unsigned int place;
    int          rigid;
  };

  /// Impulse and its moment about the centre, of a rigid body [N s, N m s].
  struct Push
  {
    Vector  impulse;
    Vector3 moment;
  };

  /**
   * Take over what is published now. Collective.
   * @param rigid_of_node by node of the surface, -1: deformable
   */
  void update(const contact::Surface<dim>                   &surface,
              const std::vector<int>                        &rigid_of_node,
              const std::vector<contact::RigidUnknown<dim>> &rigid_unknowns,
              const MPI_Comm                                 comm);

  bool empty() const { return facets.empty(); }

  /// Is the point inside a closed body, by the angle that the facets fill as seen from it?
  bool contains(const dealii::Point<dim> &x) const;
  /// Is a facet of a closed body nearer to the point than this [m]?
  bool is_nearer(const dealii::Point<dim> &x, const double reach) const;
  /// Longest edge of a facet [m].
  double longest_edge() const;

  /// Sum over ranks of p a and its moment for each rigid body. Collective.
  std::vector<Push>
  sum_of_pressures(const double *p, const std::vector<Vector> &area, const MPI_Comm comm) const;
  /// Velocity of a node that impulses of the bodies bring about [m/s].
  Vector velocity_of(const unsigned int node, const std::vector<Push> &push) const;

  std::vector<Node>                       nodes;
  std::vector<contact::RigidUnknown<dim>> rigids;

private:
  /// A simplex of a facet of any rank.
  using Simplex = std::array<dealii::Point<dim>, dim>;
  std::vector<Simplex> facets;
  dealii::Point<dim>   low, high;
};
} // namespace coracle::meshless
