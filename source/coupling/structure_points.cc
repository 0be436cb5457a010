// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/key_directory.h>
#include <coracle/contact/initial_overlaps.h>
#include <coracle/contact/messages.h>
#include <coracle/coupling/structure_points.h>

#include <limits>
#include <sstream>
#include <unordered_map>

namespace coracle
{
namespace
{
/// Radius of nodes of bodies without a thickness, and how much farther candidates of nodes reach
/// at least, in smallest edges.
constexpr double smallest_radius = 0.01, least_skin = 0.25;

/// Is there a body that another one or itself may touch?
bool
anything_to_meet(const std::vector<contact::SurfaceBody> &surfaces)
{
  bool movable = false, self = false;
  for (const auto &surface : surfaces)
    {
      movable = movable || surface.movable;
      self    = self || surface.self_contact;
    }
  return self || (movable && surfaces.back().part > 0);
}

/// Local searches that look at each facet for itself take neighbours for contacts.
void
refuse_self_contact_per_facet(const Parameters                        &root,
                              const std::vector<contact::SurfaceBody> &surfaces)
{
  const Parameters  section = root.section("Contact");
  const std::string search  = section.choice("Local search");
  for (const auto &surface : surfaces)
    if (surface.self_contact && search != "nearest on surface")
      throw section.error("Local search",
                          "self contact by a search that does not know the whole surface",
                          search,
                          "set Local search = nearest on surface, or leave out Self contact");
}

template <int dim>
double
smallest_edge_of(const contact::Surface<dim> &surface)
{
  double square = std::numeric_limits<double>::infinity();
  for (const auto &facet : surface.facets)
    for (unsigned int k = 0; k < facet.nodes.size(); ++k)
      {
        const unsigned int a = facet.nodes[k], b = facet.nodes[(k + 1) % facet.nodes.size()];
        if (a != b)
          square =
            std::min(square, surface.nodes[a].position.distance_square(surface.nodes[b].position));
      }
  return std::sqrt(square);
}

/// Each node that ranks have is given to one of them: its owner, or the lowest that has it.
template <int dim>
std::vector<bool>
assign_nodes(const contact::Surface<dim> &surface, MPI_Comm comm)
{
  const int                               n = contact::n_ranks(comm), me = contact::my_rank(comm);
  std::vector<std::vector<std::uint64_t>> keys(n);
  std::vector<std::vector<unsigned int>>  asked(n);
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    {
      keys[surface.nodes[i].owner].push_back(surface.nodes[i].key);
      asked[surface.nodes[i].owner].push_back(i);
    }
  const auto                             claims = contact::all_to_all(keys, comm);
  std::unordered_map<std::uint64_t, int> home;
  for (const auto key : claims[me])
    home.emplace(key, me);
  for (int r = 0; r < n; ++r)
    for (const auto key : claims[r])
      home.emplace(key, r);
  std::vector<std::vector<char>> answers(n);
  for (int r = 0; r < n; ++r)
    for (const auto key : claims[r])
      answers[r].push_back(home.at(key) == r);

  std::vector<bool> result(surface.nodes.size());
  const auto        mine = contact::all_to_all(answers, comm);
  for (int r = 0; r < n; ++r)
    for (unsigned int i = 0; i < asked[r].size(); ++i)
      result[asked[r][i]] = mine[r][i];
  return result;
}
} // namespace

template <int dim>
StructurePoints<dim>::StructurePoints(const bool            wanted,
                                      StructureSystem<dim> &structure,
                                      MPI_Comm              comm)
  : comm(comm)
{
  const auto &surface = structure.publish_surface();
  if (!wanted || surface.bodies.empty() || !anything_to_meet(surface.bodies))
    return;
  smallest_edge = mpi::min(smallest_edge_of(surface), comm);
  make_parts(structure, surface, assign_nodes(surface, comm));
}

template <int dim>
void
StructurePoints<dim>::structure_changed(StructureSystem<dim> &structure)
{
  if (parts.empty())
    return;
  parts.clear();
  n_steps             = 0;
  const auto &surface = structure.publish_surface();
  make_parts(structure, surface, assign_nodes(surface, comm));
}

template <int dim>
void
StructurePoints<dim>::shared_out(StructureSystem<dim> &structure)
{
  if (parts.empty())
    return;
  // Sides, then how many contacts were counted.
  const unsigned int n_sheets = structure.n_sheets();
  KeyDirectory       directory(n_sheets + 1, comm);
  for (const Part &part : parts)
    {
      Columns rows(n_sheets + 1);
      rows.resize(part.keys.size());
      for (unsigned int s = 0; s < n_sheets; ++s)
        std::copy(part.side[s].begin(), part.side[s].end(), rows[s]);
      std::copy(part.n_contacts.begin(), part.n_contacts.end(), rows[n_sheets]);
      directory.add(part.keys, rows);
    }
  parts.clear();
  const auto &surface = structure.publish_surface();
  make_parts(structure, surface, assign_nodes(surface, comm));
  for (Part &part : parts)
    {
      Columns rows(n_sheets + 1);
      rows.resize(part.keys.size());
      directory.find(part.keys, rows);
      for (unsigned int s = 0; s < n_sheets; ++s)
        std::copy_n(rows[s], rows.size(), part.side[s].begin());
      std::copy_n(rows[n_sheets], rows.size(), part.n_contacts.begin());
    }
}

template <int dim>
void
StructurePoints<dim>::count(const std::vector<contact::Contact<dim>> &contacts,
                            const unsigned int                        first_set)
{
  if (parts.empty())
    return;
  n_steps += 1;
  for (const auto &contact : contacts)
    if (contact.set >= first_set)
      parts[contact.set - first_set].n_contacts[contact.point] += 1;
}

template <int dim>
void
StructurePoints<dim>::fade()
{
  n_steps *= 0.5;
  for (Part &part : parts)
    for (double &number : part.n_contacts)
      number *= 0.5;
}

template <int dim>
void
StructurePoints<dim>::make_parts(const StructureSystem<dim>  &structure,
                                 const contact::Surface<dim> &surface,
                                 const std::vector<bool>     &is_mine)
{
  for (unsigned int b = 0; b < structure.n_bodies(); ++b)
    {
      parts.emplace_back();
      Part        &part      = parts.back();
      const double thickness = surface.bodies[structure.first_surface(b)].thickness;
      part.body              = structure.first_surface(b);
      part.first_node        = structure.begin_nodes(b);
      part.radius            = thickness > 0 ? 0.5 * thickness : smallest_radius * smallest_edge;
      for (unsigned int i = structure.begin_nodes(b); i < structure.begin_nodes(b + 1); ++i)
        if (is_mine[i] && !surface.nodes[i].hangs())
          {
            part.nodes.push_back(i);
            part.keys.push_back(surface.nodes[i].key);
          }
      for (int d = 0; d < dim; ++d)
        {
          part.position[d].resize(part.nodes.size());
          part.velocity[d].resize(part.nodes.size());
        }
      part.n_contacts.resize(part.nodes.size());
      part.side.assign(structure.n_sheets(), std::vector<double>(part.nodes.size()));
    }
}

template <int dim>
void
StructurePoints<dim>::fill(const contact::Surface<dim>                           &surface,
                           typename std::vector<contact::PointSet<dim>>::iterator set)
{
  for (auto &part : parts)
    {
      for (unsigned int i = 0; i < part.nodes.size(); ++i)
        for (int d = 0; d < dim; ++d)
          {
            part.position[d][i] = surface.nodes[part.nodes[i]].position[d];
            part.velocity[d][i] = surface.nodes[part.nodes[i]].velocity[d];
          }
      set->n_points        = part.nodes.size();
      set->ids             = part.keys.data();
      set->constant_radius = part.radius;
      set->body            = part.body;
      set->surface_node    = part.nodes.data();
      set->least_skin      = least_skin * smallest_edge;
      set->side.clear();
      for (auto &column : part.side)
        set->side.push_back(column.data());
      for (int d = 0; d < dim; ++d)
        {
          set->position[d] = part.position[d].data();
          set->velocity[d] = part.velocity[d].data();
        }
      ++set;
    }
}

template <int dim>
void
StructurePoints<dim>::refuse_initial_overlaps(const Parameters     &root,
                                              StructureSystem<dim> &structure)
{
  if (parts.empty())
    return;
  const auto &surface = structure.publish_surface();
  refuse_self_contact_per_facet(root, surface.bodies);
  std::vector<contact::PointSet<dim>> sets(parts.size());
  fill(surface, sets.begin());
  const auto          mine = contact::initial_overlaps(surface, sets, comm);
  const std::uint64_t n    = mpi::sum<std::uint64_t>(mine.size(), comm);
  if (n == 0)
    return;

  // All ranks must name the same one.
  std::array<double, 3 + dim> deepest{};
  for (const auto &overlap : mine)
    if (overlap.depth > deepest[0])
      {
        deepest[0] = overlap.depth;
        deepest[1] = sets[overlap.set].body;
        deepest[2] = overlap.body;
        for (int d = 0; d < dim; ++d)
          deepest[3 + d] = overlap.place[d];
      }
  for (const auto &other : dealii::Utilities::MPI::all_gather(comm, deepest))
    if (other[0] > deepest[0] || (other[0] == deepest[0] && other < deepest))
      deepest = other;

  const std::string  body = structure.body_name(deepest[1]), met = structure.body_name(deepest[2]);
  std::ostringstream found, cure;
  found << n << (n == 1 ? " surface node is" : " surface nodes are")
        << " in or too near to another surface; the deepest is one of '" << body << "' at (";
  for (int d = 0; d < dim; ++d)
    found << (d > 0 ? ", " : "") << deepest[3 + d];
  found << ") m, ";
  if (std::isfinite(deepest[0]))
    found << deepest[0] << " m nearer to '" << met << "' than the contact distance";
  else
    found << "deep inside '" << met << "'";
  if (body == met)
    cure << "leave more room between its surfaces, or make Thickness smaller";
  else if (std::isfinite(deepest[0]))
    cure << "move '" << body << "' and '" << met << "' apart by " << deepest[0]
         << " m, or make Thickness smaller";
  else
    cure << "move '" << body << "' out of '" << met << "'";
  cure << "; Contact/Structure contact = false lets structures pass through each other";
  throw root.section("Bodies").section(body).error("",
                                                   "structures start too near to each other",
                                                   found.str(),
                                                   cure.str());
}

template <int dim>
void
StructurePoints<dim>::serialize(Archive &archive)
{
  for (auto &part : parts)
    if (!part.side.empty())
      {
        Columns sides(part.side.size());
        sides.resize(part.keys.size());
        for (unsigned int s = 0; s < part.side.size(); ++s)
          std::copy(part.side[s].begin(), part.side[s].end(), sides[s]);
        archive.keyed(
          "sides of nodes " + std::to_string(part.body), part.keys, part.keys.size(), sides, {});
        for (unsigned int s = 0; s < part.side.size(); ++s)
          std::copy_n(sides[s], sides.size(), part.side[s].begin());
      }
  // Earlier checkpoints have not counted.
  if (parts.empty() || !archive.has("steps_of_counting"))
    return;
  archive.same("steps_of_counting", n_steps);
  for (auto &part : parts)
    {
      Columns numbers(1);
      numbers.resize(part.keys.size());
      std::copy(part.n_contacts.begin(), part.n_contacts.end(), numbers[0]);
      archive.keyed(
        "contacts of nodes " + std::to_string(part.body), part.keys, part.keys.size(), numbers, {});
      std::copy_n(numbers[0], numbers.size(), part.n_contacts.begin());
    }
}

template class StructurePoints<2>;
template class StructurePoints<3>;
} // namespace coracle
