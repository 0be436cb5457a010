// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/material/library.h>
#include <coracle/mesh/structure_mesh.h>
#include <coracle/structure/boundary_conditions.h>
#include <coracle/structure/elements.h>
#include <coracle/structure/loads.h>
#include <coracle/structure/structural_body.h>

namespace coracle
{
/**
 * A deformable body of quadrilaterals or hexahedra, explicit with lumped mass:
 * central differences, velocities at half steps. The first step's kick is half
 * as long, so that the initial velocity counts at time zero.
 *
 * One step, in this order (each collective over the ranks, also those without
 * elements):
 *
 *   assemble_forces(t)  predict_velocities(dt)
 *   [add_contact_impulse ... apply_contact_impulses()] [add_correction ... apply_corrections()]
 *   move(dt)  update_stress(dt)
 *
 * Forces that ranks share are summed at the owner of a node; every rank then
 * has the same velocities. Hanging nodes hand their forces to their parents and
 * move as these do.
 */
template <int dim>
class SolidBody : public StructuralBody<dim>
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// Entries of a body of the kind `solid`.
  static void declare(Declaration &body_section);

  /// @param gravity [m/s^2]
  /// @param reproducible sums on nodes do not depend on the ranks, bit by bit
  /// Throws UserError. Collective.
  SolidBody(const Parameters             &body,
            const MaterialLibrary        &materials,
            const dealii::Tensor<1, dim> &gravity,
            MPI_Comm                      comm,
            const bool                    reproducible = false);

  /// Of this rank's elements as they are now, infinite without any [s]. Multiply by a safety
  /// factor.
  double stable_time_step() const { return elements.stable_time_step(); }

  /// Loads at `time`, and sums over ranks of them and of the internal force.
  void assemble_forces(const double time);
  /// Velocities of the step of length dt, without contact.
  void predict_velocities(const double dt);

  /// Contact may touch all nodes, also inside, from now on.
  void contact_through_volume();

  /// Contact impulse on a node of surface_nodes() [N s], from any rank that has it.
  void add_contact_impulse(const unsigned int node, const Vector &impulse);
  /// Sum the impulses of all ranks and change the velocities.
  void apply_contact_impulses();

  /// Push a node by correction/m in `move`, leaving its velocity [kg m].
  void add_correction(const unsigned int node, const Vector &correction);
  void apply_corrections();

  void move(const double dt);

  /**
   * After move(): changes where a node of surface_nodes() ends, from any rank that has it; see
   * contact::EndChanges.
   * @param shift sum of displacements [m], @param count how many, and how often it is to be held
   */
  void add_end_change(const unsigned int node, const Vector &shift, const Vector &count);
  /// Velocities stay as they are. Collective.
  /// @param held_part of their way that held nodes keep; @return whether a node of this rank moves
  bool apply_end_changes(const double held_part);

  /// Stresses, and internal forces for the next step. Throws RunFailure, on the rank concerned
  /// only.
  void update_stress(const double dt);

  /**
   * Between steps: halves elements (see StructureMesh::refine). Nothing moves, and what is new
   * moves with the elements that it is in; the whole mass and momentum stay, also the angular
   * momentum where nodes are free; the kinetic energy that this takes goes into the books as
   * strain. Collective; throws RunFailure, on all ranks.
   *
   * @param wanted by element of mesh()
   * @return has anything changed?
   */
  bool refine(const std::vector<bool> &wanted);

  /// Between steps: the same elements on other ranks, by the weights they were given; all of the
  /// state goes with them as it is. Collective.
  void share_out();

  /// How often the mesh has changed, or has been shared out anew, since the start of the case.
  unsigned int n_mesh_changes() const { return mesh().n_changes(); }

  /// Of each element: how far its mean stress is from what means over the elements at its nodes
  /// give for it, a norm [Pa]. Collective. Source: Zienkiewicz & Zhu, Int. J. Numer. Meth. Engng 24
  /// (1987) 337, with lumped means.
  std::vector<double> stress_jumps() const;

  void serialize(Archive &archive);

  /// Collective sums.
  Energies         energies() const;
  BodySummary<dim> summary() const;

  const StructureMesh<dim> &mesh() const
  {
    return static_cast<const StructureMesh<dim> &>(*this->body_mesh);
  }

  /// May the body's surface touch itself?
  bool self_contact() const { return touches_itself; }

  unsigned int n_points_per_element() const { return elements.n_points(); }
  /// Mean over the points of an element of mesh().elements [Pa].
  Symmetric<dim, double> stress(const unsigned int element) const
  {
    return elements.stress(element);
  }

private:
  using Node = NodeColumns<dim>;

  /// Momentum, angular momentum about the origin, kinetic energy. Collective.
  struct Motion
  {
    Vector               momentum;
    dealii::Tensor<1, 3> angular_momentum;
    double               kinetic = 0;
  };
  Motion motion() const;
  /// All that is made from the mesh but for masses, which the state may bring.
  void take_mesh(const CarriedState<dim> &state);
  /// The same with masses.
  void follow_mesh(const CarriedState<dim> &state);
  /// The same, for a state that is loaded next.
  void make_room();
  /// Gives the nodes of refined elements the momentum that is missing, as the least change of their
  /// velocities, a rigid motion.
  void                restore_motion(const Motion &before, const CarriedState<dim> &state);
  std::vector<double> rigid_change(const std::vector<unsigned int> &nodes, const Motion &missing);

  StructureMesh<dim> &changing_mesh()
  {
    return static_cast<StructureMesh<dim> &>(*this->body_mesh);
  }

  void   set_mass();
  void   find_contact_nodes();
  void   kick(const double duration, const double dt);
  double damping_at(const double time) const;
  /// What rounds summands of at most this size on any rank, if sums are to be reproducible.
  SumGrid sum_grid(const double largest_here) const;
  /// Rounds columns whose sums on nodes follow.
  void round(const unsigned int first_column, const unsigned int n_columns);
  /// Forces of hanging nodes go to their parents.
  void condense(const unsigned int first_column, const unsigned int n_columns);
  /// Ghosts as their owners, then hanging nodes as the mean of their parents.
  void distribute(const unsigned int first_column);

  const Parameters        section;
  const bool              touches_itself, reproducible;
  Elements<dim>           elements;
  BoundaryConditions<dim> boundary_conditions;
  Loads<dim>              loads;
  const Vector            gravity;
  /// 1/s, from and to which time [s].
  const double damping, damping_start, damping_end;

  double time = 0, last_dt = 0, kick_duration = 0;
  /// Owned nodes that contact may touch, also through hanging nodes.
  std::vector<unsigned int> contact_nodes;
  bool                      is_corrected = false, is_met_in_volume = false;
  /// This rank's part of all books but `kinetic` and `hourglass`; strain includes hourglass.
  Energies books;
};

extern template class SolidBody<2>;
extern template class SolidBody<3>;
} // namespace coracle
