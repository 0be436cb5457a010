// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/grid_participant.h>
#include <coracle/coupling/structure_system.h>

#include <functional>

namespace coracle
{
/**
 * Structures on the octree for grid contact: every node of a body, also inside
 * it, is mapped like a particle of its lumped mass; a node of a rigid body has
 * the share of the body's mass that the elements around it have in its volume.
 *
 * Nodes travel to the rank whose leaf they are in, their impulses travel back.
 * All functions but give_extent are collective.
 */
template <int dim>
class StructureOnGrid
{
public:
  using Vector = dealii::Tensor<1, dim>;

  StructureOnGrid(StructureSystem<dim> &structure, const Octree<dim> &octree, MPI_Comm comm);

  void octree_changed();

  unsigned int n_bodies() const { return node_mass.size(); }
  /// Of the body's surface [1], [m].
  double friction(const unsigned int body) const { return frictions[body]; }
  double radius(const unsigned int body) const { return radii[body]; }

  /**
   * Mass, velocity, inverse mass and mass gradient of all bodies.
   * @param is_near  of a leaf: is there anything that could meet a structure?
   * @param bodies   one participant per body, solids first
   */
  void give(StructureSystem<dim>                          &structure,
            const std::function<bool(const unsigned int)> &is_near,
            std::vector<GridParticipant<dim>>             &bodies);

  /// Calls action(position, leaf) for the nodes of a body in leaves of this rank.
  template <typename Action>
  void for_each_node(const unsigned int body, const Action &action) const
  {
    for (const auto &visitor : visitors)
      if (visitor.body == body)
        action(visitor.position, visitor.leaf);
  }

  /// The impulses of the participants, known on all local nodes, to the bodies.
  void take_back(const std::vector<GridParticipant<dim>> &bodies, StructureSystem<dim> &structure);

private:
  /// One node of a structure in a leaf of this rank.
  struct Visitor
  {
    unsigned int       body, node;
    int                home, leaf;
    double             mass;
    dealii::Point<dim> position;
    Vector             velocity, mobile_mass;
  };
  /// Its impulse on the way home.
  struct Impulse
  {
    unsigned int body, node;
    Vector       value;
  };

  void   invite(StructureSystem<dim>                          &structure,
                const std::function<bool(const unsigned int)> &is_near);
  Vector impulse_of(const Visitor &visitor, const GridParticipant<dim> &body) const;

  const Octree<dim>                    &octree;
  MPI_Comm                              comm;
  std::vector<dealii::BoundingBox<dim>> regions;
  std::vector<double>                   frictions, radii;
  /// Per body and node that this rank owns [kg].
  std::vector<std::vector<double>> node_mass;
  std::vector<Visitor>             visitors;
  std::vector<std::vector<Vector>> impulses;
};
} // namespace coracle
