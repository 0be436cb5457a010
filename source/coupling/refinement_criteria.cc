// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/surface_distance.h>
#include <coracle/coupling/refinement_criteria.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace coracle
{
namespace
{
/// Which pair of thresholds belongs to a kind, and their defaults for `Coarsen`.
struct KindEntries
{
  const char *kind, *refine, *coarsen, *unit, *meaning;
  bool        fine_below;
};

const std::vector<KindEntries> kinds = {
  {"distance to surfaces",
   "Refine nearer than",
   "Coarsen farther than",
   "m",
   "Distance between the cell and the nearest surface of a structure.",
   true},
  {"contact force",
   "Refine above contact pressure",
   "Coarsen below contact pressure",
   "Pa",
   "Mean force of the contacts of the cell's particles since the last adaptation over the area of "
   "a face of the cell.",
   false},
  {"free surface",
   "Refine within layers",
   "Coarsen beyond layers",
   "1",
   "Layers of cells to the nearest cell with particles that has an empty neighbour; 0 is that cell "
   "itself.",
   true},
  {"velocity gradient",
   "Refine above velocity jump",
   "Coarsen below velocity jump",
   "m/s",
   "Norm of the velocity's gradient times the size of the cell.",
   false},
  {"pressure gradient",
   "Refine above pressure jump",
   "Coarsen below pressure jump",
   "Pa",
   "Largest difference between the mean pressures of the cell's particles and those of a "
   "neighbour's.",
   false},
  {"function",
   "Refine above",
   "Coarsen below",
   "1",
   "Value of the function in the cell's middle.",
   false}};
} // namespace

template <int dim>
void
RefinementCriteria<dim>::declare(Declaration &adaptivity)
{
  Declaration &criterion =
    adaptivity.named_sections("Criteria",
                              "criterion",
                              "What makes cells finer and coarser while the run goes on. A cell "
                              "becomes finer if any criterion asks "
                              "for it, and coarser if all let it. There is none for plastic "
                              "strain, as no material is plastic yet.");
  std::vector<std::string> names;
  for (const auto &kind : kinds)
    names.push_back(kind.kind);
  criterion.choice("Kind", names.front(), names, "The number that is looked at.");
  for (const auto &kind : kinds)
    {
      Declaration &entries = criterion.when("Kind", kind.kind);
      entries.quantity(kind.refine,
                       "0",
                       kind.unit,
                       "",
                       std::string(kind.meaning) +
                         " Cells are refined on this side of the threshold.");
      entries.quantity(kind.coarsen,
                       "0",
                       kind.unit,
                       "",
                       std::string("Cells may become coarser on that side; 0: ") +
                         (kind.fine_below ? "twice" : "half") + " the other threshold.");
      if (std::string(kind.kind) == "distance to surfaces")
        entries.text("Surfaces of", "", "Names of structures, with commas; empty: all.");
      if (std::string(kind.kind) == "function")
        entries.function("Function", "0", "1", "Of place and time.");
    }
  criterion.integer(
    "Lowest level", 0, "Cells are nowhere coarser than this: bisections of the base cell.", 0, 12);
  criterion.integer("Highest level", 1, "This criterion makes cells no finer than this.", 0, 12);
}

template <int dim>
typename RefinementCriteria<dim>::Criterion
RefinementCriteria<dim>::read(const Parameters &section)
{
  const auto entries = std::find_if(kinds.begin(), kinds.end(), [&](const KindEntries &k) {
    return section.choice("Kind") == k.kind;
  });
  Criterion  result;
  result.kind    = static_cast<Kind>(entries - kinds.begin());
  result.refine  = section.quantity(entries->refine);
  result.coarsen = section.quantity(entries->coarsen);
  result.lowest  = section.integer("Lowest level");
  result.highest = section.integer("Highest level");
  if (result.coarsen == 0)
    result.coarsen = (entries->fine_below ? 2. : 0.5) * result.refine;
  if (!section.is_set(entries->refine))
    throw section.error("",
                        "a criterion has no threshold",
                        "'" + std::string(entries->refine) + "' is not set",
                        "set it, or remove the criterion");
  if (entries->fine_below ? result.coarsen <= result.refine : result.coarsen >= result.refine)
    {
      std::ostringstream found;
      found << entries->refine << " = " << result.refine << ", " << entries->coarsen << " = "
            << result.coarsen;
      throw section.error(entries->coarsen,
                          "cells would be refined and coarsened in turn",
                          found.str(),
                          "leave a gap between the thresholds, or leave the second one out");
    }
  if (result.highest < result.lowest)
    throw section.error("Highest level",
                        "the highest level is below the lowest",
                        std::to_string(result.highest) + " < " + std::to_string(result.lowest),
                        "exchange them");
  if (result.kind == Kind::function)
    result.function = section.template function<dim>("Function", 1);
  return result;
}

template <int dim>
void
RefinementCriteria<dim>::read_surfaces(const Parameters           &section,
                                       const StructureSystem<dim> &structure,
                                       Criterion                  &criterion)
{
  if (structure.empty())
    throw section.error("Kind",
                        "a criterion looks for surfaces that are not there",
                        "the case has no structures",
                        "add a structure, or remove the criterion");
  std::vector<std::string> known, names;
  for (unsigned int b = 0; b < structure.n_bodies(); ++b)
    known.push_back(structure.body_name(structure.first_surface(b)));
  std::istringstream words(section.text("Surfaces of"));
  for (std::string word; std::getline(words, word, ',');)
    {
      word.erase(0, word.find_first_not_of(' '));
      word.erase(word.find_last_not_of(' ') + 1);
      if (std::find(known.begin(), known.end(), word) == known.end())
        {
          std::string all;
          for (const auto &name : known)
            all += (all.empty() ? "" : ", ") + name;
          throw section.error("Surfaces of",
                              "a structure is not known",
                              "'" + word + "'",
                              "choose among: " + all);
        }
      names.push_back(word);
    }
  if (names.empty())
    return;
  for (unsigned int b = 0; b < structure.n_bodies(); ++b)
    criterion.surfaces.resize(structure.first_surface(b + 1),
                              std::find(names.begin(), names.end(), known[b]) != names.end());
}

template <int dim>
RefinementCriteria<dim>::RefinementCriteria(const Parameters           &root,
                                            const StructureSystem<dim> &structure,
                                            const bool                  contact_on_surface)
{
  const Parameters section = root.section("Grid").section("Adaptivity").section("Criteria");
  for (const std::string &name : section.section_names())
    {
      const Parameters item = section.section(name);
      criteria.push_back(read(item));
      if (criteria.back().kind == Kind::surface)
        read_surfaces(item, structure, criteria.back());
      if (criteria.back().kind == Kind::contact_pressure && !contact_on_surface)
        throw item.error("Kind",
                         "contact on the grid tells no forces of places",
                         "Contact/Method = grid",
                         "set Contact/Method = surface, or choose another criterion");
    }
}

template <int dim>
unsigned int
RefinementCriteria<dim>::highest_level() const
{
  int result = 0;
  for (const Criterion &criterion : criteria)
    result = std::max(result, criterion.highest);
  return result;
}

template <int dim>
bool
RefinementCriteria<dim>::uses_contacts() const
{
  return std::any_of(criteria.begin(), criteria.end(), [](const Criterion &criterion) {
    return criterion.kind == Kind::contact_pressure;
  });
}

template <int dim>
typename RefinementCriteria<dim>::Values
RefinementCriteria<dim>::evaluate(const Criterion            &criterion,
                                  const RefinementScene<dim> &scene) const
{
  const auto        &octree = scene.points.octree;
  const unsigned int n      = octree.n_owned_leaves();
  Values             result;
  // At the middles of leaves and of their parents.
  const auto at_places = [&](const auto &value) {
    for (unsigned int leaf = 0; leaf < n; ++leaf)
      {
        dealii::Point<dim> centre = octree.lower(leaf);
        for (unsigned int d = 0; d < dim; ++d)
          centre[d] += 0.5 * octree.size(leaf);
        result.leaf.push_back(value(centre, octree.size(leaf)));
        // Of use only where the leaf may become coarser.
        result.parent.push_back(octree.level(leaf) > 0 && criterion.coarsens(result.leaf.back())
                                  ? value(parent_centre(octree, leaf), 2 * octree.size(leaf))
                                  : result.leaf.back());
      }
  };
  switch (criterion.kind)
    {
        case Kind::surface: {
          const double                  limit = 1.01 * criterion.coarsen;
          contact::SurfaceDistance<dim> distance(octree.triangulation.get_communicator());
          std::vector<contact::Box>     places;
          const auto                    region = octree.owned_region();
          if (n > 0)
            {
              places.emplace_back();
              for (unsigned int d = 0; d < dim; ++d)
                {
                  // Parents reach beyond, by less than the largest cell.
                  places.back().lower[d] = region.lower_bound(d);
                  places.back().upper[d] = region.upper_bound(d);
                }
            }
          const double reach = limit + std::sqrt(double(dim)) * octree.largest_cell_size();
          distance.reinit(scene.structure.publish_surface(), places, reach);
          at_places([&](const dealii::Point<dim> &centre, const double size) {
            // Of the ball around the cell.
            const double half = 0.5 * std::sqrt(double(dim)) * size;
            return std::max(0., distance.distance(centre, limit + half, criterion.surfaces) - half);
          });
          break;
        }
      case Kind::function:
        criterion.function->set_time(scene.time);
        at_places([&](const dealii::Point<dim> &centre, const double) {
          return criterion.function->value(centre);
        });
        break;
      case Kind::contact_pressure:
        for (unsigned int leaf = 0; leaf < n; ++leaf)
          result.leaf.push_back(scene.contacts.force(leaf) / std::pow(octree.size(leaf), dim - 1));
        break;
      case Kind::free_surface:
        result.leaf =
          layers_from_free_surface(scene.points,
                                   static_cast<unsigned int>(std::ceil(criterion.coarsen)));
        break;
      case Kind::velocity_jump:
        result.leaf = velocity_jump(scene.points);
        break;
      case Kind::pressure_jump:
        result.leaf = pressure_jump(scene.points);
        break;
    }
  return result;
}

template <int dim>
std::vector<int>
RefinementCriteria<dim>::wanted_levels(const RefinementScene<dim> &scene) const
{
  const auto      &octree = scene.points.octree;
  std::vector<int> result(octree.n_owned_leaves(), 0);
  for (const Criterion &criterion : criteria)
    {
      const Values values = evaluate(criterion, scene);
      for (unsigned int leaf = 0; leaf < result.size(); ++leaf)
        {
          int level = octree.level(leaf);
          if (criterion.refines(values.leaf[leaf]))
            ++level;
          else if (criterion.coarsens(values.leaf[leaf]) &&
                   (values.parent.empty() || !criterion.refines(values.parent[leaf])))
            --level;
          result[leaf] =
            std::max(result[leaf], std::min(std::max(level, criterion.lowest), criterion.highest));
        }
    }
  return result;
}

template class RefinementCriteria<2>;
template class RefinementCriteria<3>;
} // namespace coracle
