// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/function.h>

#include <coracle/structure/inertia.h>
#include <coracle/structure/rigid_rotation.h>
#include <coracle/structure/structural_body.h>

#include <limits>
#include <memory>

namespace coracle
{
/**
 * A rigid body: the shape and inertia of a mesh or of a thin sheet, free in some
 * directions and moved by functions of time in the others. Its state is the same
 * on all ranks; its mesh and surface are distributed. The steps are those of
 * SolidBody.
 */
template <int dim>
class RigidBody : public StructuralBody<dim>
{
public:
  using Vector  = dealii::Tensor<1, dim>;
  using Vector3 = dealii::Tensor<1, 3>;

  /// Entries of a body of the kind `rigid`.
  static void declare(Declaration &body_section);

  /// @param gravity [m/s^2]; throws UserError. Collective.
  RigidBody(const Parameters &body, const Vector &gravity, MPI_Comm comm);

  double stable_time_step() const { return std::numeric_limits<double>::infinity(); }

  void assemble_forces(const double time);
  void predict_velocities(const double dt);

  /// Contact impulse on a node [N s]; its moment is taken about the centre.
  void add_contact_impulse(const unsigned int node, const Vector &impulse);
  /// Impulse and its moment about the centre [N s, N m s], from one rank only.
  void add_contact_impulse(const Vector &value, const Vector3 &moment)
  {
    impulse.sum += value;
    impulse.moment += moment;
  }
  /// Sum over ranks, change velocity and spin. Collective.
  void apply_contact_impulses();

  /// Push the body at a node by what the correction does to its centre and orientation [kg m].
  void add_correction(const unsigned int node, const Vector &correction);
  void add_correction(const Vector &value, const Vector3 &moment)
  {
    correction.sum += value;
    correction.moment += moment;
  }
  void apply_corrections();

  void move(const double dt);
  /**
   * After move(): takes back all but a part of the free motion since the start of the step, of
   * prescribed motion nothing; the body turns back unless a prescribed spin turns it. Velocities
   * stay as they are.
   * @return whether there was anything to take back
   */
  bool shorten_step(const double part);
  /// Throws RunFailure, on all ranks, where the motion is not a number.
  void update_stress(const double);

  /// Halves elements of a mesh that is none of sheets, see SolidBody::refine: the surface gets more
  /// facets and nodes, the body stays what it is. Collective.
  bool refine(const std::vector<bool> &wanted);
  /// The same elements on other ranks, see SolidBody::share_out; sheets stay where they are.
  /// Collective.
  void         share_out();
  unsigned int n_mesh_changes() const;

  Energies         energies() const;
  BodySummary<dim> summary() const;

  void serialize(Archive &archive);

  // What contact solves for (RigidUnknown of contact/contact.h).
  const dealii::Point<dim> &centre() const { return body_centre; }
  const Vector             &centre_velocity() const { return body_velocity; }
  Vector3                   spin() const { return rotation.spin(); }
  /// 1/M in each direction, 0 where not free [1/kg].
  const Vector        &body_inverse_mass() const { return inverse_mass_of_body; }
  dealii::Tensor<2, 3> inverse_inertia() const { return rotation.inverse_inertia(); }

  double               mass() const { return body_mass; }
  const RigidRotation &orientation() const { return rotation; }

private:
  using Node = NodeColumns<dim>;

  /// Force and moment impulses, or corrections, of this rank's contacts.
  struct Push
  {
    Vector  sum;
    Vector3 moment;
  };

  /// The mesh that the section `Mesh` describes, and its integrals.
  struct Shape
  {
    std::unique_ptr<BodyMesh<dim>> mesh;
    VolumeIntegrals<dim>           integrals;
  };
  static Shape read_shape(const Parameters &mesh, MPI_Comm comm);
  RigidBody(const Parameters &body, const Vector &gravity, Shape &&shape);

  void read_mass(const Parameters &body, const VolumeIntegrals<dim> &integrals);
  void read_motion(const Parameters &body);
  void read_initial_motion(const Parameters &body);
  void prescribe(const double dt);
  void set_node_velocities();
  void set_node_positions();
  void add(Push &push, const unsigned int node, const Vector &value) const;
  /// Sum over ranks, and reset.
  Push   total(Push &push) const;
  double kinetic_energy() const;

  double               body_mass = 0;
  dealii::Tensor<2, 3> inertia;
  dealii::Point<dim>   reference_centre, body_centre;
  Vector               body_velocity, inverse_mass_of_body;
  RigidRotation        rotation;
  const Vector         gravity;

  /// Of the directions that are not free; null if these stand still.
  std::unique_ptr<dealii::Function<dim>> velocity_function, displacement_function, spin_function;

  Push    impulse, correction;
  Vector  last_force;
  Vector3 last_moment;
  double  time = 0, last_dt = 0, external_work = 0, contact_work = 0;

  /// Where the step began.
  dealii::Point<dim>    start_centre;
  std::array<double, 4> start_orientation{{1, 0, 0, 0}};
};

extern template class RigidBody<2>;
extern template class RigidBody<3>;
} // namespace coracle
