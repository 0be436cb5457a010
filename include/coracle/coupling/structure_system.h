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
  /// On any rank? Collective.
  bool has_failed() const;

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

  /// Work of the elements, by body (solids first) and element.
  using Work = std::vector<std::vector<double>>;

  /// Between steps: halves elements of some bodies, by body and element; none given
  /// for a body: it stays. True if anything has changed, then the surface is another one.
  /// Collective; throws RunFailure, on all ranks.
  /// @param work by which changed bodies are shared out; none: as before
  bool refine(const std::vector<std::vector<bool>> &wanted, const Work &work = {});

  /// Between steps: some of the bodies are shared out among the ranks anew by the work of their
  /// elements. All stays as it is, also keys of nodes and facets, but local numbers. Collective.
  void share_out(const std::vector<bool> &bodies, const Work &work);

  /// Between steps. Collective. True if meshes have changed since the start of the case.
  bool serialize(Archive &archive);

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
  std::vector<dealii::Tensor<1, dim>> received;
};
} // namespace coracle
