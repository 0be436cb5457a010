// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact_system.h>
#include <coracle/contact/initial_overlaps.h>
#include <coracle/coupling/grid_contact.h>
#include <coracle/coupling/leaf_contacts.h>
#include <coracle/coupling/structure_points.h>

namespace coracle
{
/**
 * Contact between material points and structures, and among structures: translates the bodies of
 * both sides into points, facets and rows of unknowns, and impulses back.
 *
 * A particle is a point whose velocity is the grid's at its place, because that
 * is what moves it (Song, Liu & Zhang 2020, Eqs. 29-33): its row are the shape
 * functions of the grid's nodes, hanging nodes replaced by their parents.
 */
template <int dim>
class ContactCoupling
{
public:
  ContactCoupling(const contact::ContactOptions &options,
                  MaterialPointSystem<dim>      &points,
                  StructureSystem<dim>          &structure,
                  MPI_Comm                       comm);

  /// Contacts at the start of the step. Collective.
  void find(MaterialPointSystem<dim> &points, StructureSystem<dim> &structure, const double dt);
  /// Impulses that keep particles out, given to both sides. Collective.
  void solve(MaterialPointSystem<dim> &points, StructureSystem<dim> &structure, const double dt);
  /// Ends of nodes of structures, then of particles, that would come too near to a surface on their
  /// way are changed. Collective.
  void resolve_in_time(MaterialPointSystem<dim> &points, StructureSystem<dim> &structure);
  /// Independent check of all particles near the surface over the step just moved. Collective.
  void audit(const MaterialPointSystem<dim> &points, StructureSystem<dim> &structure);

  /// The octree has new leaves and nodes. Collective.
  void octree_changed(const MaterialPointSystem<dim> &points);

  /// Meshes of structures have new elements and nodes. Collective.
  void structure_changed(StructureSystem<dim> &structure);

  /// Meshes of structures have the same elements and nodes on other ranks. Collective.
  void structure_shared_out(StructureSystem<dim> &structure);

  /// Surface nodes as points, and how many contacts they have.
  const StructurePoints<dim> &structure_points() const { return surface_nodes; }
  /// What was counted so far counts half from now on.
  void fade_structure_points() { surface_nodes.fade(); }

  /// What contact did in the leaves of this rank since the octree changed or this was last
  /// forgotten.
  const LeafContacts &leaf_contacts() const { return in_leaves; }
  void                forget_leaf_contacts(const MaterialPointSystem<dim> &points)
  {
    in_leaves.reinit(points.octree.n_owned_leaves());
  }

  /// Contacts of particles with facets, or pairs of bodies at nodes.
  const contact::ContactReport &report() const
  {
    return on_grid.is_used() ? report_with_grid : system.report();
  }
  std::uint64_t n_penetrations() const { return penetrations; }

  /// Momentum that contact has given to each material point body so far; this rank's share [N s].
  const std::vector<dealii::Tensor<1, dim>> &contact_momentum() const { return received; }

  /// What Contact/Initial overlap = project did: particles moved, and the longest way [m].
  struct Projected
  {
    std::uint64_t n_particles = 0;
    double        farthest    = 0;
  };

  /**
   * Particles that lie in a body or nearer to it than the contact distance are a UserError, or are
   * moved out if the options say so; then it is a UserError if they have nowhere to go. Velocities,
   * densities and stresses stay as they are. Collective.
   */
  Projected resolve_initial_overlaps(const Parameters         &root,
                                     MaterialPointSystem<dim> &points,
                                     StructureSystem<dim>     &structure);

  /// Between steps, after the points.
  void serialize(Archive &archive, MaterialPointSystem<dim> &points);

private:
  /// Which particles touch a surface now, for their shape functions in the next step.
  void note_touched(MaterialPointSystem<dim> &points) const;
  void solve_on_grid(MaterialPointSystem<dim> &points, StructureSystem<dim> &structure);
  void solve_on_surface(MaterialPointSystem<dim> &points,
                        StructureSystem<dim>     &structure,
                        const double              dt);
  /// At the start: those of this rank's particles, and their number on all ranks.
  std::vector<contact::Overlap<dim>> find_overlaps(MaterialPointSystem<dim> &points,
                                                   StructureSystem<dim>     &structure,
                                                   std::uint64_t            &n_particles);
  /// Moves overlapping particles towards their places, less than a cell. Returns the longest way
  /// left.
  double            project(const std::vector<contact::Overlap<dim>> &overlaps,
                            MaterialPointSystem<dim>                 &points,
                            StructureSystem<dim>                     &structure);
  [[noreturn]] void refuse(const Parameters                         &root,
                           const std::vector<contact::Overlap<dim>> &overlaps,
                           const std::uint64_t                       n_particles,
                           const MaterialPointSystem<dim>           &points,
                           const StructureSystem<dim>               &structure) const;
  void              make_point_sets(MaterialPointSystem<dim> &points, const bool renumbered);
  /// Grid nodes and weights of one particle, hanging nodes replaced.
  template <typename Action>
  void for_each_node(const MaterialPointSystem<dim> &points,
                     const unsigned int              set,
                     const unsigned int              row,
                     const Action                   &action) const;

  const contact::InitialOverlap initial_overlap;
  MPI_Comm                      comm;
  const contact::Method         method;
  const bool                    reproducible;
  GridContact<dim>              on_grid;
  contact::ContactReport        report_with_grid;
  contact::ContactSystem<dim>   system;
  StructurePoints<dim>          surface_nodes;
  /// Material point bodies, then bodies with surface nodes as points.
  std::vector<contact::PointSet<dim>>     sets;
  std::vector<std::vector<std::uint64_t>> ids;
  std::vector<std::vector<double>>        radii;
  std::vector<dealii::Tensor<1, dim>>     impulse, correction, received;
  LeafContacts                            in_leaves;
  std::uint64_t                           penetrations = 0;
};
} // namespace coracle
