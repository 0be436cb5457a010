// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/coupling.h>

#include <sstream>

namespace coracle
{
namespace
{
/// What does not know how to be the same on any number of ranks.
void
refuse_irreproducible(const Parameters &root)
{
  const Parameters contact = root.section("Contact"), bodies = root.section("Bodies");
  if (contact.choice("Method") == "grid" || contact.choice("Between fields") == "grid")
    throw root.error("Reproducible",
                     "contact on the grid's nodes is not reproducible",
                     "Contact/Method or Contact/Between fields is grid",
                     "set Reproducible = false, or let bodies meet at surfaces");
  for (const std::string &name : bodies.section_names())
    if (bodies.section(name).choice("Kind") == "meshless fluid")
      throw root.error("Reproducible",
                       "the meshless fluid is not reproducible",
                       "'" + name + "' is one; its pressures are solved to a tolerance",
                       "set Reproducible = false");
}
} // namespace

template <int dim>
void
CouplingOptions<dim>::declare(Declaration &root)
{
  root.list("Gravity", "", "m/s^2", "g", "Acceleration of everything; empty is none.");
  root.flag("Reproducible",
            false,
            "Results are the same on any number of ranks, bit by bit, on machines that compute "
            "alike; steps take longer. Not with contact on the grid's nodes");
  Declaration &time = root.section("Time", "How long steps are.");
  time.quantity("Safety factor",
                "0.5",
                "1",
                "s_f",
                "Step over the smallest of the stable steps of elements and cells.",
                1e-6,
                1.);
  time.quantity("Largest step", "1e300", "s", "", "Steps are never longer.", 1e-300);
  time.quantity("Smallest share",
                "1e-3",
                "1",
                "",
                "The run fails where the step falls below this share of the first one.",
                0.,
                1.);
}

template <int dim>
CouplingOptions<dim>
CouplingOptions<dim>::read(const Parameters &root)
{
  CouplingOptions result;
  result.safety_factor  = root.section("Time").quantity("Safety factor");
  result.largest_step   = root.section("Time").quantity("Largest step");
  result.smallest_share = root.section("Time").quantity("Smallest share");
  result.reproducible   = root.flag("Reproducible");
  // Contact on the grid's nodes knows one record of each.
  const Parameters contact = root.section("Contact");
  result.split_fields = contact.flag("Split fields") && contact.choice("Method") == "surface" &&
                        contact.choice("Between fields") != "grid";
  if (result.reproducible)
    refuse_irreproducible(root);
  const auto gravity = root.list("Gravity");
  if (!gravity.empty() && gravity.size() != dim)
    throw root.error("Gravity",
                     "gravity has the wrong number of components",
                     std::to_string(gravity.size()) + " components",
                     "give " + std::to_string(dim) + ", one for each direction");
  for (unsigned int d = 0; d < gravity.size(); ++d)
    result.gravity[d] = gravity[d];
  return result;
}

template <int dim>
void
Coupling<dim>::declare(Declaration &root)
{
  CouplingOptions<dim>::declare(root);
  Declaration &grid =
    root.section("Grid", "The background grid of material points: a box of square or cubic cells.");
  OctreeDescription<dim>::declare(grid);
  BoxBoundary<dim>::declare(grid);
  Adaptivity<dim>::declare(grid);
  MaterialLibrary::declare(root);
  Declaration &body =
    root.named_sections("Bodies", "body", "Everything that moves, each with a name.");
  body.choice(
    "Kind",
    "material points",
    {"material points", "solid", "rigid", "meshless fluid"},
    "material points: fluid, or solid that deforms without limit; solid: finite elements; "
    "rigid: a mesh, or thin sheets, that keep their shape; meshless fluid: incompressible, points "
    "with finite elements between them that are found anew in each step.");
  MaterialPointBody<dim>::declare(body.when("Kind", "material points"));
  SolidBody<dim>::declare(body.when("Kind", "solid"));
  StructureAdaptivity<dim>::declare(body.when("Kind", "solid"), true);
  RigidBody<dim>::declare(body.when("Kind", "rigid"));
  StructureAdaptivity<dim>::declare(body.when("Kind", "rigid"), false);
  MeshlessSystem<dim>::declare(body.when("Kind", "meshless fluid"));
  Declaration &contact =
    root.section("Contact",
                 "Between material points and the surfaces of structures, and among structures.");
  contact::ContactOptions::declare(contact);
  contact.flag(
    "Split fields",
    true,
    "Grid nodes that a sheet cuts off from some particles have a velocity for each side, "
    "so that what is on one side does not feel the other through it");
  contact.flag(
    "Rigid half",
    true,
    "The half of a particle between its centre, where contact acts, and the surface that it "
    "touches does not deform, so that the pressure in what rests against a surface is right");
}

template <int dim>
Coupling<dim>::Coupling(const Parameters &root, MPI_Comm comm, Archive *saved_octree)
  : options(CouplingOptions<dim>::read(root))
  , materials(root)
  , structure(root, materials, options.gravity, options.reproducible, comm)
  , points(root, materials, options.gravity, met_surfaces(root), comm, saved_octree)
  , fluids(root, options.gravity, points.octree, structure, saved_octree == nullptr)
  , contacts(contact::ContactOptions(root.section("Contact"), options.reproducible),
             points,
             structure,
             comm)
  , adaptivity(root, structure, contact::ContactOptions(root.section("Contact")).method)
  , structure_adaptivity(root, points, structure)
  , comm(comm)
{
  if (options.reproducible)
    points.make_reproducible();
  if (saved_octree == nullptr)
    {
      projected = contacts.resolve_initial_overlaps(root, points, structure);
      structure_adaptivity.initialise(points, structure, contacts);
      adaptivity.initialise(points, structure, contacts);
      // What starts on a surface touches it in the first step already.
      contacts.find(points, structure, 0);
      if (adaptivity.balance(points, structure, contacts))
        contacts.find(points, structure, 0);
    }
}

template <int dim>
MetSurfaces
Coupling<dim>::met_surfaces(const Parameters &root) const
{
  const Parameters contact = root.section("Contact");
  return {static_cast<int>(structure.n_sheets()),
          structure.n_bodies() > 0 && contact.choice("Method") == "surface" &&
            contact.flag("Rigid half")};
}

template <int dim>
void
Coupling<dim>::serialize(Archive &archive)
{
  archive.same("time", current_time);
  archive.same("dt", current_dt);
  archive.same("first_dt", first_dt);
  archive.same("step", n_steps);
  if (structure.serialize(archive) && archive.loads())
    {
      contacts.structure_changed(structure);
      points.structure_changed();
    }
  points.serialize(archive);
  fluids.serialize(archive, structure);
  contacts.serialize(archive, points);
  adaptivity.state.serialize(archive);
  if (!archive.is_exact())
    share_out();
  archive.share("particle_steps", particle_steps);
  archive.same("contact_steps", contact_steps);
  archive.same("unconverged_contact_steps", unconverged_contact_steps);
  archive.same("worst_gap", worst_gap);
}

// Other ranks get leaves in even numbers first. The next step is as long as it would have been.
template <int dim>
void
Coupling<dim>::share_out()
{
  std::vector<StressSweep> sweeps;
  for (const auto &body : points.bodies)
    sweeps.push_back(body.sweep);
  adaptivity.balance(points, structure, contacts);
  auto sweep = sweeps.begin();
  for (auto &body : points.bodies)
    body.sweep = *sweep++;
}

template <int dim>
double
Coupling<dim>::choose_time_step() const
{
  const double stable = std::min(structure.stable_time_step(), points.stable_time_step());
  return std::min({options.largest_step, options.safety_factor * stable, fluids.step_limit()});
}

template <int dim>
void
Coupling<dim>::cut_points()
{
  const contact::Surface<dim> no_sheets;
  points.cut(options.split_fields ? structure.publish_surface() : no_sheets);
}

template <int dim>
void
Coupling<dim>::advance(const double end_time)
{
  double dt = timed("time step", [&] { return choose_time_step(); });
  check_time_step(dt);
  // No sliver of a step at the end: the last two share what is left.
  const double left = end_time - current_time;
  dt                = left <= dt ? left : std::min(dt, 0.5 * left);

  if (structure.n_bodies() > 0)
    timed("points at surfaces", [&] { cut_points(); });
  timed("particles to grid", [&] {
    points.gather(current_time, dt);
    timed.count("particle", points.n_particles());
  });
  timed("structure forces", [&] { structure.assemble_forces(current_time); });
  timed("predictor", [&] {
    points.predict(dt);
    structure.predict_velocities(dt);
  });

  timed("meshless fluid", [&] {
    fluids.advance(current_time, current_dt, dt, structure, timed);
    timed.count("point", fluids.n_points());
  });

  timed("contact search", [&] { contacts.find(points, structure, dt); });
  timed("contact solve", [&] { contacts.solve(points, structure, dt); });

  timed("move", [&] {
    points.move(dt);
    structure.move(dt);
    timed.count("particle", points.n_particles());
  });
  timed("continuous check", [&] { contacts.resolve_in_time(points, structure); });
  timed("penetration audit", [&] { contacts.audit(points, structure); });

  current_time += dt;
  current_dt = dt;
  ++n_steps;

  timed("particle stress", [&] {
    points.update_stresses(current_time, dt);
    timed.count("particle", points.n_particles());
  });
  timed("element stress", [&] {
    structure.update_stresses(dt);
    timed.count("element", structure.n_elements());
  });
  timed("locate", [&] {
    points.locate(current_time);
    timed.count("particle", points.n_particles());
  });
  timed("refill", [&] { fluids.refill(structure); });
  timed("tessellation", [&] {
    fluids.remesh();
    timed.count("point", fluids.n_points());
  });
  timed("adapt", [&] { adaptivity.update(points, structure, contacts, current_time, dt); });
  timed("adapt structures",
        [&] { structure_adaptivity.update(points, structure, contacts, n_steps); });
  timed("checks", [&] { check_state(); });
  count_work();
}

template <int dim>
std::string
Coupling<dim>::describe_limit() const
{
  const double structures = structure.stable_time_step(), particles = points.stable_time_step();
  if (fluids.step_limit() < options.safety_factor * std::min(structures, particles))
    return fluids.describe_limit();
  return structures < particles ? structure.describe_limit() : points.describe_limit();
}

template <int dim>
void
Coupling<dim>::check_time_step(const double dt)
{
  if (n_steps == 0)
    first_dt = dt;
  // Also where it is not a number.
  if (dt > 0 && dt >= options.smallest_share * first_dt)
    return;
  std::ostringstream details;
  details << "a step of " << dt << " s after one of " << current_dt << " s at t = " << current_time
          << " s (step " << n_steps << "), the first was " << first_dt << " s; "
          << describe_limit();
  throw RunFailure("the time step has collapsed",
                   details.str(),
                   "look at what happens there; if it is meant to, lower Time/Smallest share");
}

template <int dim>
void
Coupling<dim>::check_state() const
{
  mpi::agree(
    [&] {
      if (points.failure)
        throw *points.failure;
      if (structure.failure)
        throw *structure.failure;
      if (fluids.failure)
        throw *fluids.failure;
    },
    comm);
  const std::int64_t error = points.ledger_error();
  if (error != 0)
    throw RunFailure("particles were lost or made from nothing",
                     std::to_string(error) + " more created than accounted for at t = " +
                       std::to_string(current_time) + " s",
                     "this is an error of the program: please report it with the case");
}

template <int dim>
void
Coupling<dim>::count_work()
{
  particle_steps += points.n_particles() + fluids.n_points();
  const auto &report = contacts.report();
  if (report.n_contacts > 0)
    {
      ++contact_steps;
      unconverged_contact_steps += !report.solver.velocity.converged;
      worst_gap = std::min(worst_gap, report.worst_gap);
    }
}

template struct CouplingOptions<2>;
template struct CouplingOptions<3>;
template class Coupling<2>;
template class Coupling<3>;
} // namespace coracle
