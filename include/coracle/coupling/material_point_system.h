// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/field_split.h>
#include <coracle/grid/box_boundary.h>
#include <coracle/grid/locate.h>
#include <coracle/grid/nodal_field.h>

#include <list>
#include <optional>
#include <vector>

namespace coracle
{
/**
 * All material point bodies of a run with the octree they move through and the
 * velocity fields they share: each function is one line of the step.
 */
template <int dim>
class MaterialPointSystem
{
public:
  /// Sections `Grid` and `Bodies`; with a saved octree (see Octree) there are no particles until
  /// they are loaded. Collective.
  MaterialPointSystem(const Parameters             &root,
                      const MaterialLibrary        &materials,
                      const dealii::Tensor<1, dim> &gravity,
                      const MetSurfaces            &met,
                      MPI_Comm                      comm,
                      Archive                      *saved_octree = nullptr);

  /// Between steps. Collective.
  void serialize(Archive &archive);

  /// Bound on the step from wave speed, particle speed and viscosity in the cells, on all ranks
  /// [s].
  double stable_time_step() const;
  /// The body that asks for the shortest step, and its fastest particle, for messages. Collective.
  std::string describe_limit() const;

  /// Particles with shape functions of their own in this step: those that a sheet of this surface
  /// cuts off from nodes, and those that touch a surface. Collective.
  void cut(const contact::Surface<dim> &surface);
  /// Results do not depend on the ranks from now on, bit by bit: particles are sorted in every
  /// step, and sums on nodes are exact. Before the first step.
  void make_reproducible();

  /// Mass, momentum, internal and external force to the nodes of each field.
  void gather(const double time, const double dt);
  /// Velocities of nodes without contact.
  void predict(const double dt);
  /// Contact impulses that were added to the fields.
  void apply_impulses();
  /// New velocities and next positions of particles; MUSL gives momenta back in the same sweep.
  void move(const double dt);
  /// Strain increments and stresses from the velocities at the end of the step.
  void update_stresses(const double time, const double dt);
  /// Positions are taken; strays, migration, open faces; sorting when due. Collective.
  void locate(const double time);

  /// All particles are sorted now, whether that is due or not.
  void sort();
  /// The octree has new leaves and nodes: what is kept by their numbers starts afresh, particles go
  /// to their new owners. Between steps; collective.
  void octree_changed();
  /// Particles have come and gone: they go to their owners and are sorted. Collective.
  void redistribute_particles();
  /// Kinetic energy that splitting and merging took on this rank becomes internal [J]. Collective.
  void book_split_merge(MaterialPointBody<dim> &body, const ExactSum &lost);

  /// The first thing that went wrong on this rank in gather, update_stresses or locate. They go on
  /// to their end, because other ranks wait for this one; the step looks here afterwards.
  std::optional<RunFailure> failure;

  /// Did rows change their places, or new ones arrive, since the last call?
  bool take_renumbered();

  std::uint64_t n_particles() const;
  /// What the ledger expects less what is present, over all ranks. Collective.
  std::int64_t ledger_error() const;
  std::size_t  memory_consumption() const;

  /// What this rank's particles and nodes did to energy so far [J]; kinetic is the present value.
  struct Books
  {
    double kinetic = 0, internal = 0, damping = 0, transfer = 0, boundary = 0, contact = 0,
           external_work = 0;
  };
  const Books &books() const { return energy; }

  Octree<dim>                       octree;
  BoxBoundary<dim>                  boundary;
  NodeSplit<dim>                    split;
  std::list<MaterialPointBody<dim>> bodies;
  std::list<NodalField<dim>>        fields;
  std::vector<std::string>          field_names;
  const dealii::Tensor<1, dim>      gravity;

private:
  /// What is given per stable step of the body's cells, for a step of length dt. Collective.
  double
       share_of_step(const MaterialPointBody<dim> &body, const double share, const double dt) const;
  void make_fields();
  NodalField<dim> &field(const MaterialPointBody<dim> &body);
  bool             shares_musl_field(const MaterialPointBody<dim> &body) const;
  void             update_stress(MaterialPointBody<dim> &body,
                                 const NodeRecords      &velocity,
                                 const unsigned int      place,
                                 const double            time,
                                 const double            dt);
  /// For sums on nodes that are to be reproducible: of what particles have, and of what they take
  /// from nodes that have moved. Collective.
  void bound_sums(const double time, const bool after_nodes_moved);
  /// What all ranks have together, on rank 0, and zero elsewhere. Collective.
  double on_first_rank(const ExactSum &sum) const;
  double kinetic_energy(const MaterialPointBody<dim> &body) const
  {
    return on_first_rank(body.points.exact_kinetic_energy());
  }
  void add_body_forces(MaterialPointBody<dim> &body, const double time, const double dt);

  FieldSplit<dim> sides;
  Books           energy;
  bool            reproducible     = false;
  unsigned int    steps_since_sort = 0;
  bool            renumbered       = true;
};
} // namespace coracle
