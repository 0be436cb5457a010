// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact_system.h>
#include <coracle/structure/rigid_body.h>
#include <coracle/structure/solid_body.h>

#include <algorithm>
#include <list>
#include <optional>

namespace coracle
{
/**
 * All structural bodies of a run: each function is one line of the step, and
 * their surfaces together are what contact meets.
 */
template <int dim>
class StructureSystem
{
public:
  /// Section `Bodies`. Collective.
  /// @param reproducible sums on nodes do not depend on the ranks, bit by bit
  StructureSystem(const Parameters             &root,
                  const MaterialLibrary        &materials,
                  const dealii::Tensor<1, dim> &gravity,
                  const bool                    reproducible,
                  MPI_Comm                      comm);

  /// Over all ranks [s].
  double stable_time_step() const;
  /// Whose step that is, for messages. Collective.
  std::string describe_limit() const;

  void assemble_forces(const double time);
  void predict_velocities(const double dt);
  void move(const double dt);
  void update_stresses(const double dt);

  /// The first thing that went wrong in update_stresses on this rank, see MaterialPointSystem.
  std::optional<RunFailure> failure;

  /// The facets this rank owns, nodes at their places with their predicted velocities.
  const contact::Surface<dim> &publish_surface();
  /// In the order of SurfaceBody::rigid_body.
  std::vector<contact::RigidUnknown<dim>> rigid_unknowns() const;

  /**
   * What contact found, to the bodies. Collective.
   * @param impulse, correction one per node of the published surface [N s, kg m]
   * @param rigid one per rigid body, the same on all ranks
   */
  void apply_contact(const std::vector<dealii::Tensor<1, dim>> &impulse,
                     const std::vector<dealii::Tensor<1, dim>> &correction,
                     const std::vector<typename contact::ContactSystem<dim>::RigidImpulse> &rigid);

  /// After move(): changes where nodes of the published surface and rigid bodies end. Collective.
  /// @return whether any of this rank's does
  bool change_ends(const contact::EndChanges<dim> &changes);

  /**
   * Impulses on any nodes, also inside bodies. Collective.
   * @param impulse per body, solids first, and node that this rank owns [N s]
   */
  void apply_node_impulses(const std::vector<std::vector<dealii::Tensor<1, dim>>> &impulse);

  /// Momentum that contact has given to each body so far, solids first; this rank's share [N s].
  const std::vector<dealii::Tensor<1, dim>> &contact_momentum() const { return received; }

  /// Between steps.
  void serialize(Archive &archive);

  /// Elements of deformable bodies on this rank.
  unsigned int n_elements() const
  {
    unsigned int n = 0;
    for (const auto &body : solids)
      n += body.mesh().n_elements();
    return n;
  }

  /// Name of a body by its number among contact's surfaces.
  const std::string &body_name(const unsigned int surface_body) const
  {
    const unsigned int body = body_of_surface[surface_body];
    return body < solids.size() ? std::next(solids.begin(), body)->name()
                                : std::next(rigids.begin(), body - solids.size())->name();
  }

  /// Surfaces with particles on both sides, of all bodies together; each has a column of sides.
  unsigned int n_sheets() const { return sheets; }

  unsigned int n_bodies() const { return first_node.size(); }
  /// First surface of a body, and first of its nodes on the published surface: they are in order.
  unsigned int first_surface(const unsigned int body) const
  {
    return std::lower_bound(body_of_surface.begin(), body_of_surface.end(), body) -
           body_of_surface.begin();
  }
  unsigned int begin_nodes(const unsigned int body) const
  {
    return body < first_node.size() ? first_node[body] : surface.nodes.size();
  }
  /// Of a deformable body, and on an edge or face of a larger neighbour.
  bool is_hanging(const unsigned int surface_node) const { return hanging[surface_node]; }

  bool empty() const { return solids.empty() && rigids.empty(); }

  std::list<SolidBody<dim>> solids;
  std::list<RigidBody<dim>> rigids;

private:
  void make_surface();
  /// What contact knows of the body: one surface, or one for each of its sheets.
  void describe_surfaces(const StructuralBody<dim> &body,
                         const unsigned int         index,
                         const int                  rigid_body);
  /// Calls action(body, number of the body) for all bodies, solids first.
  template <typename Action>
  void for_each_surface(const Action &action);

  MPI_Comm                            comm;
  const bool                          reproducible;
  contact::Surface<dim>               surface;
  std::vector<unsigned int>           first_node, body_of_surface;
  unsigned int                        sheets = 0;
  std::vector<bool>                   hanging;
  std::vector<dealii::Tensor<1, dim>> received;
};
} // namespace coracle
