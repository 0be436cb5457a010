// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of structures on their way past facets of structures.
#include <coracle/contact/continuous_check.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// What a later pass asks for of the whole clearance: less than what moving aside may leave.
constexpr double later_clearance = 0.02;
/// A rigid body keeps this part of what is free of its motion.
constexpr double free_part = 0.9;
/// A direction is out of reach if less than this part of it is free; a facet cannot be pushed where
/// nodes that cannot be moved have all but this part of the squares of weights.
constexpr double least_part = 0.05;

template <int dim>
bool
can_move_by_itself(const Surface<dim> &surface, const int body, const unsigned int node)
{
  return surface.bodies[body].rigid_body < 0 && surface.can_move(body, node);
}

/// Leaves a rigid body so much of its motion; false if the body is none, or moves as prescribed.
template <int dim>
bool
shorten(const Surface<dim> &surface, const int body, const double part, EndChanges<dim> &changes)
{
  const auto &b = surface.bodies[body];
  if (b.rigid_body < 0 || !b.movable)
    return false;
  changes.rigid_part[b.rigid_body] = std::min(changes.rigid_part[b.rigid_body], part);
  return true;
}

/// Holds a facet where the step began; false if it moves as prescribed.
template <int dim>
bool
hold(const Surface<dim> &surface, const Facet<dim> &facet, EndChanges<dim> &changes)
{
  bool result = shorten(surface, facet.body, changes.held_part, changes);
  for (const unsigned int node : facet.nodes)
    if (can_move_by_itself(surface, facet.body, node))
      {
        changes.hold(node);
        result = true;
      }
  return result;
}
} // namespace

template <int dim>
typename ContinuousCheck<dim>::Plane
ContinuousCheck<dim>::within_reach(Plane plane, const dealii::Point<dim> &wanted) const
{
  if (std::find(fixed.begin(), fixed.end(), true) == fixed.end())
    return plane;
  for (int d = 0; d < dim; ++d)
    if (fixed[d])
      {
        plane.bound -= plane.normal[d] * wanted[d];
        plane.normal[d] = 0;
      }
  const double length = plane.normal.norm();
  if (length < least_part)
    return {Vector(), std::numeric_limits<double>::lowest()};
  return {plane.normal / length, plane.bound / length};
}

template <int dim>
bool
ContinuousCheck<dim>::go_aside(const Surface<dim> &surface,
                               Node               &node,
                               const PointOfSet   &point,
                               const NodePass     &pass,
                               EndChanges<dim>    &changes)
{
  for (int d = 0; d < dim; ++d)
    fixed[d] = (surface.nodes[node.index].inverse_mass[d] == 0);
  const auto wanted = node.end;
  const bool free   = find_free_end(surface, node.begin, node.end, point);
  Vector     way    = node.end - wanted;
  for (int d = 0; d < dim; ++d)
    way[d] = pass.grid.round(way[d]);
  node.end = wanted + way;
  changes.move(node.index, way);
  return free;
}

// By the weights of the place that is met, so that this place moves as far as it must.
template <int dim>
bool
ContinuousCheck<dim>::push(const Surface<dim> &surface,
                           const Node         &node,
                           const Near         &pair,
                           const Meeting      &meeting,
                           const NodePass     &pass,
                           EndChanges<dim>    &changes) const
{
  const auto &facet = surface.facets[pair.facet];
  double      sum = 0, all = 0;
  for (unsigned int k = 0; k < n_vertices; ++k)
    {
      const double square = meeting.nearest.weights[k] * meeting.nearest.weights[k];
      all += square;
      if (can_move_by_itself(surface, facet.body, facet.nodes[k]))
        sum += square;
    }
  if (sum < least_part * all || sum == 0)
    return false;
  Plane  plane = plane_at_end(pair, meeting);
  double depth = plane.bound - plane.normal * node.end;
  // It is past the facet only on the way.
  if (depth <= 0)
    {
      plane = plane_on_the_way(pair, meeting, node.begin);
      depth = plane.bound - plane.normal * node.end;
    }
  depth = pass.growth * (std::max(0., depth) + pair.greatest_clearance);
  for (unsigned int k = 0; k < n_vertices; ++k)
    if (can_move_by_itself(surface, facet.body, facet.nodes[k]) && meeting.nearest.weights[k] > 0)
      {
        Vector way = -(depth * meeting.nearest.weights[k] / sum) * plane.normal;
        for (int d = 0; d < dim; ++d)
          way[d] = pass.grid.round(way[d]);
        changes.move(facet.nodes[k], way);
      }
  return true;
}

template <int dim>
bool
ContinuousCheck<dim>::respond(const Surface<dim> &surface,
                              Node                node,
                              const PointOfSet   &point,
                              const NodePass     &pass,
                              EndChanges<dim>    &changes)
{
  const bool movable = can_move_by_itself(surface, node.body, node.index);
  if (movable && !pass.holds && go_aside(surface, node, point, pass, changes))
    return true;
  // The others must give way.
  bool helped = movable && !pass.holds, against_prescribed = false;
  for (auto &pair : near)
    {
      Meeting meeting{};
      pair.clearance = later_clearance * pair.greatest_clearance;
      if (!meets(node.begin, node.end, pair, meeting))
        continue;
      const auto &facet = surface.facets[pair.facet];
      if (pass.holds)
        {
          const bool held    = hold(surface, facet, changes);
          against_prescribed = against_prescribed || !held;
          helped = shorten(surface, node.body, changes.held_part, changes) || held || helped;
        }
      else if (push(surface, node, pair, meeting, pass, changes))
        helped = true;
      else
        {
          const double part = free_part * meeting.time;
          // Both.
          const bool facet_is_free = shorten(surface, facet.body, part, changes);
          helped = shorten(surface, node.body, part, changes) || facet_is_free || helped;
        }
    }
  if (!pass.holds || !movable)
    return helped;
  // What comes to a node whatever happens must find it gone.
  if (!against_prescribed || !go_aside(surface, node, point, pass, changes))
    changes.hold(node.index);
  return true;
}

template <int dim>
unsigned long
ContinuousCheck<dim>::follow_nodes(const Surface<dim>                    &surface,
                                   const std::vector<PointSet<dim>>      &points,
                                   const std::vector<const Candidates *> &candidates,
                                   const std::vector<Contact<dim>>       &contacts,
                                   const NodePass                        &pass,
                                   EndChanges<dim>                       &changes)
{
  unsigned long n = 0;
  find_extents(surface);
  auto contact = contacts.begin();
  for (unsigned int s = 0; s < points.size(); ++s)
    for (std::size_t i = 0; points[s].body >= 0 && i < candidates[s]->point.size(); ++i)
      {
        const unsigned int p       = candidates[s]->point[i];
        const Vector       outward = look_at_contacts(surface, s, p, contact, contacts.end());
        Node               node;
        node.index                 = pass.local_nodes[points[s].surface_node[p]];
        node.body                  = points[s].body;
        node.begin                 = points[s].point(p);
        node.end                   = surface.nodes[node.index].position;
        const unsigned int *facets = candidates[s]->facet.data();
        const PointOfSet    point  = {facets + candidates[s]->begin[i],
                                      facets + candidates[s]->begin[i + 1],
                                      points[s].radius(p)};
        if (outward.norm_square() > 0)
          {
            const Vector way = way_off_surface(surface, node.begin, point) * outward;
            node.begin += way;
            // One that is held stays as it was.
            if (pass.holds)
              node.end += way;
          }
        near.clear();
        if (!collect(surface, node.begin, node.end, point))
          continue;
        if (!pass.is_first)
          for (auto &pair : near)
            pair.clearance = later_clearance * pair.greatest_clearance;
        Meeting      meeting{};
        unsigned int which = 0;
        if (first_meeting(node.begin, node.end, meeting, which))
          n += respond(surface, node, point, pass, changes);
      }
  return n;
}

#define INSTANTIATE(dim)                                                   \
  template ContinuousCheck<dim>::Plane ContinuousCheck<dim>::within_reach( \
    Plane, const dealii::Point<dim> &) const;                              \
  template unsigned long ContinuousCheck<dim>::follow_nodes(               \
    const Surface<dim> &,                                                  \
    const std::vector<PointSet<dim>> &,                                    \
    const std::vector<const Candidates *> &,                               \
    const std::vector<Contact<dim>> &,                                     \
    const NodePass &,                                                      \
    EndChanges<dim> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace coracle::contact
