// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/contact/surface_distance.h>
#include <coracle/coupling/structure_adaptivity.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace coracle
{
namespace
{
const char *const contact_distance = "contact distance", *const error_estimator = "error estimator",
                  *const refine_nearer   = "Refine nearer than",
                  *const coarsen_farther = "Coarsen farther than",
                  *const refine_above    = "Refine above stress jump",
                  *const coarsen_below   = "Coarsen below stress jump";

template <int dim>
const StructuralBody<dim> &
body_of(const StructureSystem<dim> &structure, const unsigned int body)
{
  if (body < structure.solids.size())
    return *std::next(structure.solids.begin(), body);
  return *std::next(structure.rigids.begin(), body - structure.solids.size());
}

template <int dim>
const StructureMesh<dim> &
mesh_of(const StructureSystem<dim> &structure, const unsigned int body)
{
  return static_cast<const StructureMesh<dim> &>(body_of(structure, body).mesh());
}

/// Middle of a facet and the distance of its farthest corner, as they are now.
template <int dim>
std::pair<dealii::Point<dim>, double>
ball_around(const StructuralBody<dim> &body, const BoundaryFacet<dim> &facet)
{
  dealii::Point<dim> centre;
  for (const unsigned int node : facet.nodes)
    centre += body.position(node) / double(facet.nodes.size());
  double radius = 0;
  for (const unsigned int node : facet.nodes)
    radius = std::max(radius, centre.distance(body.position(node)));
  return {centre, radius};
}

/// A box around what there is, or none if there is nothing.
template <int dim>
void
extend(std::vector<contact::Box> &box, const dealii::Point<dim> &x, const double margin)
{
  if (box.empty())
    {
      box.emplace_back();
      for (int d = 0; d < dim; ++d)
        {
          box[0].lower[d] = x[d] - margin;
          box[0].upper[d] = x[d] + margin;
        }
    }
  for (int d = 0; d < dim; ++d)
    {
      box[0].lower[d] = std::min(box[0].lower[d], x[d] - margin);
      box[0].upper[d] = std::max(box[0].upper[d], x[d] + margin);
    }
}
} // namespace

template <int dim>
void
StructureAdaptivity<dim>::declare(Declaration &body, const bool is_deformable)
{
  Declaration &section = body.section(
    "Adaptivity",
    "Elements that are halved while the run goes on; it is on if there is any criterion. Meshes of "
    "structures never become coarser.");
  section.integer("Interval in steps", 50, "Steps between adaptations.", 1);
  Declaration             &criterion = section.named_sections("Criteria",
                                                  "criterion",
                                                  "What makes elements finer while the run goes "
                                                              "on: an element is halved if any asks for it.");
  std::vector<std::string> kinds     = {contact_distance};
  if (is_deformable)
    kinds.push_back(error_estimator);
  criterion.choice("Kind", contact_distance, kinds, "The number that is looked at.");
  Declaration &distance = criterion.when("Kind", contact_distance);
  distance.quantity(
    refine_nearer,
    "0",
    "m",
    "",
    "Distance between a facet of the element and the nearest particle, or the nearest "
    "surface of another structure. Elements are halved on this side of the threshold.",
    0.);
  distance.quantity(
    coarsen_farther, "0", "m", "", "Must be 0: meshes of structures do not become coarser.", 0.);
  distance.text("Bodies",
                "",
                "Names of the structures and bodies of material points that count, with commas; "
                "empty: all others.");
  if (is_deformable)
    {
      Declaration &estimator = criterion.when("Kind", error_estimator);
      estimator.quantity(
        refine_above,
        "0",
        "Pa",
        "",
        "Norm of the difference between the element's mean stress and the one that "
        "means over the elements at its nodes give for it (Zienkiewicz & Zhu 1987). "
        "Elements are halved on this side of the threshold.",
        0.);
      estimator.quantity(
        coarsen_below, "0", "Pa", "", "Must be 0: meshes of structures do not become coarser.", 0.);
    }
  criterion.integer(
    "Highest level",
    1,
    "This criterion makes elements no finer than this: halvings since Mesh/Refinements.",
    1,
    StructureMesh<dim>::deepest_level);
}

template <int dim>
typename StructureAdaptivity<dim>::Criterion
StructureAdaptivity<dim>::read(const Parameters &section)
{
  Criterion         result;
  const bool        by_distance = section.choice("Kind") == contact_distance;
  const std::string refine      = by_distance ? refine_nearer : refine_above,
                    coarsen     = by_distance ? coarsen_farther : coarsen_below;
  result.kind                   = by_distance ? Kind::contact_distance : Kind::error_estimator;
  result.threshold              = section.quantity(refine);
  result.highest_level          = section.integer("Highest level");
  if (!section.is_set(refine))
    throw section.error("",
                        "a criterion has no threshold",
                        "'" + refine + "' is not set",
                        "set it, or remove the criterion");
  if (section.quantity(coarsen) > 0)
    throw section.error(coarsen,
                        "meshes of structures do not become coarser",
                        coarsen + " is set",
                        "leave it out");
  return result;
}

template <int dim>
void
StructureAdaptivity<dim>::refuse_impossible(const Parameters          &body,
                                            const Parameters          &root,
                                            const StructuralBody<dim> &mesh_of,
                                            const Plan                &plan)
{
  const Parameters section = body.section("Adaptivity"), bodies = root.section("Bodies");
  if (mesh_of.mesh().n_sheets() > 0)
    throw section.error("",
                        "sheets do not adapt",
                        "'" + mesh_of.name() + "' is a sheet",
                        "leave out its criteria, or make it of elements");
  if (root.section("Contact").choice("Method") == "grid")
    throw section.error("",
                        "meshes do not adapt with contact on the grid",
                        "Contact/Method = grid",
                        "set Contact/Method = surface, or leave out the criteria");
  for (const std::string &name : bodies.section_names())
    if (bodies.section(name).choice("Kind") == "meshless fluid")
      throw section.error(
        "",
        "meshes do not adapt in a meshless fluid",
        "'" + name + "' is one",
        "leave out the criteria; Mesh/Refined region makes elements small from the "
        "start");
  unsigned int highest = 0;
  for (const Criterion &criterion : plan.criteria)
    highest = std::max(highest, plan.first_level + criterion.highest_level);
  if (highest > StructureMesh<dim>::deepest_level)
    throw section.error("",
                        "elements are halved too often",
                        std::to_string(highest) + " times, with Mesh/Refinements",
                        "stay at " + std::to_string(StructureMesh<dim>::deepest_level) +
                          ", or make the mesh finer by its subdivisions");
}

template <int dim>
void
StructureAdaptivity<dim>::read_bodies(const Parameters               &section,
                                      const MaterialPointSystem<dim> &points,
                                      const StructureSystem<dim>     &structure,
                                      const unsigned int              body,
                                      Criterion                      &criterion)
{
  std::vector<std::string> names;
  std::istringstream       words(section.text("Bodies"));
  for (std::string word; std::getline(words, word, ',');)
    {
      word.erase(0, word.find_first_not_of(' '));
      word.erase(word.find_last_not_of(' ') + 1);
      names.push_back(word);
    }
  const auto counts = [&](const std::string &name) {
    const auto found = std::find(names.begin(), names.end(), name);
    const bool named = found != names.end();
    if (named)
      names.erase(found);
    return named;
  };
  const bool  all = names.empty();
  std::string known;
  for (unsigned int b = 0; b < structure.n_bodies(); ++b)
    if (b != body)
      {
        const std::string &name = body_of(structure, b).name();
        known += (known.empty() ? "" : ", ") + name;
        criterion.surfaces.resize(structure.first_surface(b));
        criterion.surfaces.resize(structure.first_surface(b + 1), all || counts(name));
      }
  criterion.surfaces.resize(structure.first_surface(structure.n_bodies()));
  for (const auto &other : points.bodies)
    {
      known += (known.empty() ? "" : ", ") + other.name();
      criterion.particles.push_back(all || counts(other.name()));
    }
  if (!names.empty())
    throw section.error("Bodies",
                        "a body that could come near is not known",
                        "'" + names.front() + "'",
                        known.empty() ? "add another body, or leave out the criterion"
                                      : "choose among: " + known);
}

template <int dim>
StructureAdaptivity<dim>::StructureAdaptivity(const Parameters               &root,
                                              const MaterialPointSystem<dim> &points,
                                              StructureSystem<dim>           &structure)
  : work(root)
  , by_work(work.may_share_out() &&
            root.section("Grid").section("Load balance").quantity("Largest imbalance") > 0)
{
  bool any = false;
  for (unsigned int b = 0; b < structure.n_bodies(); ++b)
    {
      const auto      &mesh_body = body_of(structure, b);
      const Parameters body      = root.section("Bodies").section(mesh_body.name()),
                       section = body.section("Adaptivity"), criteria = section.section("Criteria");
      Plan plan;
      plan.interval    = section.integer("Interval in steps");
      plan.first_level = body.section("Mesh").integer("Refinements");
      for (const std::string &name : criteria.section_names())
        {
          plan.criteria.push_back(read(criteria.section(name)));
          if (plan.criteria.back().kind == Kind::contact_distance)
            read_bodies(criteria.section(name), points, structure, b, plan.criteria.back());
        }
      if (!plan.criteria.empty())
        refuse_impossible(body, root, mesh_body, plan);
      any = any || !plan.criteria.empty();
      plans.push_back(plan);
    }
  if (!any)
    plans.clear();
}

template <int dim>
std::vector<bool>
StructureAdaptivity<dim>::near_others(const Criterion                &criterion,
                                      const unsigned int              body,
                                      const MaterialPointSystem<dim> &points,
                                      StructureSystem<dim>           &structure)
{
  const auto       &own     = body_of(structure, body);
  const auto       &mesh    = mesh_of(structure, body);
  const auto       &surface = structure.publish_surface();
  std::vector<bool> result(mesh.n_elements());

  // Other surfaces come to where this one's facets are.
  contact::SurfaceDistance<dim> to_surfaces(mesh.communicator());
  std::vector<contact::Box>     places;
  for (const auto &facet : mesh.facets)
    {
      const auto [centre, radius] = ball_around(own, facet);
      extend(places, centre, radius);
    }
  to_surfaces.reinit(surface, places, criterion.threshold);
  for (const auto &facet : mesh.facets)
    {
      const auto [centre, radius] = ball_around(own, facet);
      const double limit          = criterion.threshold + radius;
      if (to_surfaces.distance(centre, limit, criterion.surfaces) < limit)
        result[facet.element] = true;
    }

  // This surface comes to where particles are.
  std::vector<bool> mine(surface.bodies.size());
  for (unsigned int s = structure.first_surface(body); s < structure.first_surface(body + 1); ++s)
    mine[s] = true;
  std::vector<contact::Box> occupied;
  const auto                for_each_particle = [&](const auto &action) {
    auto counts = criterion.particles.begin();
    for (const auto &other : points.bodies)
      if (*counts++)
        for (std::size_t row = 0; row < other.points.n_rows(); ++row)
          if (!other.points.is_hole(row))
            action(other.points.position(row));
  };
  for_each_particle([&](const dealii::Point<dim> &x) { extend(occupied, x, 0.); });
  contact::SurfaceDistance<dim> to_particles(mesh.communicator());
  to_particles.reinit(surface, occupied, criterion.threshold);
  for_each_particle(
    [&](const dealii::Point<dim> &x) { to_particles.note_near(x, criterion.threshold, mine); });
  const auto noted = to_particles.noted_nodes(surface.nodes.size());

  // One rank is told of each node.
  Columns marks(1);
  marks.resize(mesh.n_nodes());
  unsigned int i = structure.begin_nodes(body);
  for (const unsigned int node : own.surface_nodes())
    marks[0][node] = noted[i++];
  mesh.exchange.sum_to_owners(marks, 0, 1);
  mesh.exchange.update_ghosts(marks, 0, 1);
  for (const auto &facet : mesh.facets)
    if (std::all_of(facet.nodes.begin(), facet.nodes.end(), [&](const unsigned int node) {
          return marks[0][node] > 0;
        }))
      result[facet.element] = true;
  return result;
}

template <int dim>
std::vector<bool>
StructureAdaptivity<dim>::wanted(const Plan                     &plan,
                                 const unsigned int              body,
                                 const MaterialPointSystem<dim> &points,
                                 StructureSystem<dim>           &structure) const
{
  const auto       &mesh = mesh_of(structure, body);
  std::vector<bool> result(mesh.n_elements());
  for (const Criterion &criterion : plan.criteria)
    {
      std::vector<bool> asked;
      if (criterion.kind == Kind::contact_distance)
        asked = near_others(criterion, body, points, structure);
      else
        for (const double jump : std::next(structure.solids.begin(), body)->stress_jumps())
          asked.push_back(jump > criterion.threshold);
      for (unsigned int e = 0; e < result.size(); ++e)
        if (asked[e] && mesh.level(e) < plan.first_level + criterion.highest_level)
          result[e] = true;
    }
  return result;
}

template <int dim>
bool
StructureAdaptivity<dim>::adapt(MaterialPointSystem<dim> &points,
                                StructureSystem<dim>     &structure,
                                ContactCoupling<dim>     &contacts,
                                const std::uint64_t       step) const
{
  std::vector<std::vector<bool>> all(structure.n_bodies());
  bool                           any = false;
  for (unsigned int b = 0; b < plans.size(); ++b)
    if (!plans[b].criteria.empty() && step % plans[b].interval == 0)
      {
        all[b] = wanted(plans[b], b, points, structure);
        any    = true;
      }
  if (!any || !structure.refine(all,
                                by_work ? work.of_elements(structure, contacts)
                                        : typename StructureWork<dim>::ByBody()))
    return false;
  contacts.structure_changed(structure);
  points.structure_changed();
  return true;
}

template <int dim>
void
StructureAdaptivity<dim>::initialise(MaterialPointSystem<dim> &points,
                                     StructureSystem<dim>     &structure,
                                     ContactCoupling<dim>     &contacts) const
{
  for (unsigned int level = 0; level < StructureMesh<dim>::deepest_level; ++level)
    if (!adapt(points, structure, contacts, 0))
      return;
}

template <int dim>
void
StructureAdaptivity<dim>::update(MaterialPointSystem<dim> &points,
                                 StructureSystem<dim>     &structure,
                                 ContactCoupling<dim>     &contacts,
                                 const std::uint64_t       step) const
{
  // What went wrong in the step is to be told of the mesh that it went wrong in.
  if (!plans.empty() && !structure.has_failed())
    adapt(points, structure, contacts, step);
}

template class StructureAdaptivity<2>;
template class StructureAdaptivity<3>;
} // namespace coracle
