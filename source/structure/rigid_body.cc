// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/mesh/sheet_mesh.h>
#include <coracle/mesh/structure_mesh.h>
#include <coracle/structure/rigid_body.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace coracle
{
namespace
{
/// An arm in the plane or in space as a vector in space.
template <int dim>
dealii::Tensor<1, 3>
in_space(const dealii::Tensor<1, dim> &v)
{
  dealii::Tensor<1, 3> result;
  for (int d = 0; d < dim; ++d)
    result[d] = v[d];
  return result;
}
} // namespace

template <int dim>
typename RigidBody<dim>::Shape
RigidBody<dim>::read_shape(const Parameters &section, MPI_Comm comm)
{
  const std::string type = section.choice("Type");
  if (std::find(sheet_types.begin(), sheet_types.end(), type) != sheet_types.end())
    {
      auto       mesh      = std::make_unique<SheetMesh<dim>>(section, comm);
      const auto integrals = sheet_integrals(*mesh);
      return {std::move(mesh), integrals};
    }
  auto       mesh      = std::make_unique<StructureMesh<dim>>(section, comm);
  const auto integrals = volume_integrals(*mesh);
  return {std::move(mesh), integrals};
}

template <int dim>
RigidBody<dim>::RigidBody(const Parameters &body, const Vector &gravity, MPI_Comm comm)
  : RigidBody(body, gravity, read_shape(body.section("Mesh"), comm))
{}

template <int dim>
RigidBody<dim>::RigidBody(const Parameters &body, const Vector &gravity, Shape &&shape)
  : StructuralBody<dim>(body, std::move(shape.mesh)), gravity(gravity)
{
  read_mass(body, shape.integrals);
  read_motion(body);
  read_initial_motion(body);
  set_node_velocities();
}

template <int dim>
void
RigidBody<dim>::read_mass(const Parameters &body, const VolumeIntegrals<dim> &integrals)
{
  const double mass = body.quantity("Mass"), density = body.quantity("Density");
  if ((mass > 0) == (density > 0))
    throw body.error("Mass",
                     "mass of a rigid body is not clear",
                     mass > 0 ? "both Mass and Density" : "neither Mass nor Density",
                     "set one of them");
  const double volume = integrals.volume * (this->mesh().n_sheets() > 0 ? this->thickness() : 1.);
  body_mass           = mass > 0 ? mass : density * volume;
  if (body_mass == 0)
    throw body.error("Density", "body without mass", "a sheet of thickness zero", "give its Mass");
  inertia          = (body_mass / integrals.volume) * integrals.inertia();
  reference_centre = body_centre = integrals.centre;
}

template <int dim>
void
RigidBody<dim>::assemble_forces(const double now)
{
  time = now;
}

template <int dim>
void
RigidBody<dim>::prescribe(const double dt)
{
  Vector prescribed;
  if (velocity_function)
    {
      velocity_function->set_time(time + dt / 2);
      for (int d = 0; d < dim; ++d)
        prescribed[d] = velocity_function->value(body_centre, d);
    }
  else if (displacement_function)
    {
      displacement_function->set_time(time + dt);
      for (int d = 0; d < dim; ++d)
        prescribed[d] = (displacement_function->value(reference_centre, d) + reference_centre[d] -
                         body_centre[d]) /
                        dt;
    }
  for (int d = 0; d < dim; ++d)
    if (inverse_mass_of_body[d] == 0)
      body_velocity[d] = prescribed[d];

  if (spin_function)
    {
      Vector3 spin;
      spin_function->set_time(time + dt / 2);
      for (int d = (dim == 2 ? 2 : 0); d < 3; ++d)
        spin[d] = spin_function->value(body_centre, dim == 2 ? 0 : d);
      rotation.prescribe(spin);
    }
}

template <int dim>
void
RigidBody<dim>::predict_velocities(const double dt)
{
  const double before = kinetic_energy(), duration = 0.5 * (last_dt + dt);
  for (int d = 0; d < dim; ++d)
    if (inverse_mass_of_body[d] > 0)
      body_velocity[d] += duration * gravity[d];
  prescribe(dt);
  // Gravity does it, or the supports do whatever the motion needs.
  external_work += kinetic_energy() - before;
  last_dt = dt;
  set_node_velocities();
  start_centre      = body_centre;
  start_orientation = rotation.orientation();
}

template <int dim>
void
RigidBody<dim>::add(Push &push, const unsigned int node, const Vector &value) const
{
  push.sum += value;
  push.moment += moment_of<dim>(this->position(node) - body_centre, value);
}

template <int dim>
void
RigidBody<dim>::add_contact_impulse(const unsigned int node, const Vector &value)
{
  add(impulse, node, value);
  this->add_vector(Node::impulse, node, value);
}

template <int dim>
void
RigidBody<dim>::add_correction(const unsigned int node, const Vector &value)
{
  add(correction, node, value);
}

template <int dim>
typename RigidBody<dim>::Push
RigidBody<dim>::total(Push &push) const
{
  std::vector<double> sums(dim + 3);
  for (int d = 0; d < dim; ++d)
    sums[d] = push.sum[d];
  for (int d = 0; d < 3; ++d)
    sums[dim + d] = push.moment[d];
  push = {};
  dealii::Utilities::MPI::sum(sums, this->mesh().communicator(), sums);
  Push result;
  for (int d = 0; d < dim; ++d)
    result.sum[d] = sums[d];
  for (int d = 0; d < 3; ++d)
    result.moment[d] = sums[dim + d];
  return result;
}

template <int dim>
void
RigidBody<dim>::apply_contact_impulses()
{
  const Push    all             = total(impulse);
  const double  before          = kinetic_energy();
  const Vector  velocity_before = body_velocity;
  const Vector3 spin_before     = spin();
  for (int d = 0; d < dim; ++d)
    body_velocity[d] += inverse_mass_of_body[d] * all.sum[d];
  rotation.add_angular_impulse(all.moment);

  const double work =
    0.5 * (all.sum * (velocity_before + body_velocity) + all.moment * (spin_before + spin()));
  contact_work += work;
  // What does not become kinetic energy went into the supports.
  external_work += kinetic_energy() - before - work;
  last_force  = all.sum / last_dt;
  last_moment = all.moment / last_dt;

  Columns &nodes = this->node_columns;
  this->mesh().exchange.sum_to_owners(nodes, Node::impulse, dim);
  for (int d = 0; d < dim; ++d)
    for (unsigned int n = 0; n < nodes.size(); ++n)
      {
        nodes[Node::contact_force + d][n] = nodes[Node::impulse + d][n] / last_dt;
        nodes[Node::impulse + d][n]       = 0;
      }
  set_node_velocities();
}

template <int dim>
void
RigidBody<dim>::apply_corrections()
{
  const Push all = total(correction);
  for (int d = 0; d < dim; ++d)
    body_centre[d] += inverse_mass_of_body[d] * all.sum[d];
  rotation.turn(rotation.inverse_inertia() * all.moment);
}

template <int dim>
void
RigidBody<dim>::move(const double dt)
{
  body_centre += dt * body_velocity;
  rotation.advance(dt);
  set_node_positions();
}

template <int dim>
bool
RigidBody<dim>::shorten_step(const double part)
{
  bool result = false;
  for (int d = 0; d < dim; ++d)
    if (inverse_mass_of_body[d] > 0 && body_centre[d] != start_centre[d])
      {
        // Exactly there for 0.
        body_centre[d] = start_centre[d] + part * (body_centre[d] - start_centre[d]);
        result         = true;
      }
  result = rotation.turn_back(start_orientation, part) || result;
  if (!result)
    return false;
  for (unsigned int n = 0; n < this->mesh().n_nodes(); ++n)
    this->add_vector(Node::position, n, -this->vector(Node::increment, n));
  set_node_positions();
  return true;
}

template <int dim>
void
RigidBody<dim>::update_stress(const double)
{
  if (std::isfinite(body_centre.norm_square() + body_velocity.norm_square() + spin().norm_square()))
    return;
  std::ostringstream details;
  details << "t = " << time + last_dt << " s, centre at (" << body_centre << ") m, velocity ("
          << body_velocity << ") m/s, spin (" << spin() << ") rad/s";
  throw RunFailure("the motion of a rigid body is not a number",
                   details.str(),
                   "look at functions that move it, and at what it meets");
}

template <int dim>
void
RigidBody<dim>::set_node_velocities()
{
  const Vector3 now = spin();
  for (unsigned int n = 0; n < this->mesh().n_nodes(); ++n)
    this->set_vector(Node::velocity,
                     n,
                     body_velocity + velocity_from_spin<dim>(now, this->position(n) - body_centre));
}

template <int dim>
void
RigidBody<dim>::set_node_positions()
{
  for (unsigned int n = 0; n < this->mesh().n_nodes(); ++n)
    {
      const Vector3 arm = rotation.turned(in_space<dim>(this->mesh().nodes[n] - reference_centre));
      dealii::Point<dim> x = body_centre;
      for (int d = 0; d < dim; ++d)
        x[d] += arm[d];
      this->set_vector(Node::increment, n, x - this->position(n));
      this->set_vector(Node::position, n, x);
    }
}

template <int dim>
double
RigidBody<dim>::kinetic_energy() const
{
  return 0.5 * body_mass * body_velocity.norm_square() + rotation.kinetic_energy();
}

template <int dim>
Energies
RigidBody<dim>::energies() const
{
  Energies result;
  result.kinetic       = kinetic_energy();
  result.contact_work  = contact_work;
  result.external_work = external_work;
  return result;
}

template <int dim>
BodySummary<dim>
RigidBody<dim>::summary() const
{
  return {body_mass, body_centre, body_velocity, last_force, last_moment, spin()};
}

template <int dim>
bool
RigidBody<dim>::refine(const std::vector<bool> &wanted)
{
  // Only owners know it.
  this->mesh().exchange.update_ghosts(this->node_columns, Node::contact_force, dim);
  Columns           no_elements;
  CarriedState<dim> state{this->node_columns, no_elements, {}};
  if (!dynamic_cast<StructureMesh<dim> &>(*this->body_mesh).refine(wanted, state))
    return false;
  this->find_surface_nodes();
  for (int d = 0; d < dim; ++d)
    for (unsigned int n = 0; n < this->mesh().n_nodes(); ++n)
      if (state.is_new_node[n])
        this->node_columns[Node::contact_force + d][n] = 0;
  return true;
}

template <int dim>
void
RigidBody<dim>::share_out()
{
  auto *const mesh = dynamic_cast<StructureMesh<dim> *>(this->body_mesh.get());
  if (mesh == nullptr)
    return;
  mesh->exchange.update_ghosts(this->node_columns, Node::contact_force, dim);
  Columns           no_elements;
  CarriedState<dim> state{this->node_columns, no_elements, {}};
  mesh->share_out(state);
  this->find_surface_nodes();
}

template <int dim>
unsigned int
RigidBody<dim>::n_mesh_changes() const
{
  const auto *const mesh = dynamic_cast<const StructureMesh<dim> *>(&this->mesh());
  return mesh == nullptr ? 0 : mesh->n_changes();
}

template <int dim>
void
RigidBody<dim>::serialize(Archive &archive)
{
  const Archive::Section section(archive, "body " + this->name());
  if (auto *const mesh = dynamic_cast<StructureMesh<dim> *>(this->body_mesh.get()))
    if (this->serialize_mesh(archive, *mesh))
      {
        this->node_columns = Columns(Node::n_columns);
        this->node_columns.resize(mesh->n_nodes());
        this->find_surface_nodes();
      }
  this->serialize_nodes(archive, {});
  archive.same("centre", body_centre);
  archive.same("velocity", body_velocity);
  rotation.serialize(archive);
  archive.same("last_force", last_force);
  archive.same("last_moment", last_moment);
  archive.same("time", time);
  archive.same("last_dt", last_dt);
  archive.same("external_work", external_work);
  archive.same("contact_work", contact_work);
}

template class RigidBody<2>;
template class RigidBody<3>;
} // namespace coracle
