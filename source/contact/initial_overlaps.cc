// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/facet_exchange.h>
#include <coracle/contact/initial_overlaps.h>
#include <coracle/contact/local_search.h>

#include <algorithm>
#include <limits>
#include <map>

namespace coracle::contact
{
namespace
{
/// Bodies whose every edge (in 2-D: node) belongs to two facets.
template <int dim>
std::vector<bool>
find_watertight(const Surface<dim> &surface)
{
  std::vector<bool> result(surface.bodies.size(), true);
  std::map<std::array<unsigned int, 3>, std::pair<unsigned, unsigned>> count;
  for (const auto &facet : surface.facets)
    for (unsigned int k = 0; k < n_corners(facet); ++k)
      {
        const unsigned int a = facet.nodes[k],
                           b = (dim == 2 ? a : facet.nodes[(k + 1) % n_corners(facet)]);
        ++count[{{facet.body, std::min(a, b), std::max(a, b)}}].first;
      }
  for (const auto &edge : count)
    if (edge.second.first != 2)
      result[edge.first[0]] = false;
  return result;
}

/// Does the ray from p in direction x meet the segment or triangle? Along the ray, coordinates y
/// and z decide.
bool
ray_meets(const dealii::Point<2> &p, const dealii::Point<2> &a, const dealii::Point<2> &b)
{
  if ((a[1] > p[1]) == (b[1] > p[1]))
    return false;
  return a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > p[0];
}

bool
ray_meets(const dealii::Point<3> &p, const std::array<dealii::Point<3>, 3> &x)
{
  std::array<double, 3> area;
  for (unsigned int k = 0; k < 3; ++k)
    {
      const auto a = x[(k + 1) % 3] - p, b = x[(k + 2) % 3] - p;
      area[k] = a[1] * b[2] - a[2] * b[1];
    }
  if (!((area[0] > 0 && area[1] > 0 && area[2] > 0) || (area[0] < 0 && area[1] < 0 && area[2] < 0)))
    return false;
  const double sum = area[0] + area[1] + area[2];
  return (area[0] * x[0][0] + area[1] * x[1][0] + area[2] * x[2][0]) / sum > p[0];
}

unsigned int
n_meetings(const Surface<2> &surface, const Facet<2> &facet, const dealii::Point<2> &p)
{
  return ray_meets(p,
                   surface.nodes[facet.nodes[0]].position,
                   surface.nodes[facet.nodes[1]].position);
}

unsigned int
n_meetings(const Surface<3> &surface, const Facet<3> &facet, const dealii::Point<3> &p)
{
  const auto   x = [&](const unsigned int k) { return surface.nodes[facet.nodes[k]].position; };
  unsigned int n = ray_meets(p, {{x(0), x(1), x(2)}});
  if (n_corners(facet) == 4)
    n += ray_meets(p, {{x(0), x(2), x(3)}});
  return n;
}

/// Is the point a surface node that cannot move, where the surface cannot either?
template <int dim>
bool
is_held(const FacetExchange<dim> &exchange, const PointSet<dim> &points, Contact<dim> &contact)
{
  if (points.body < 0)
    return false;
  contact.point_body = points.body;
  contact.point_node = exchange.local_node(points.surface_node[contact.point]);
  return !anything_moves(contact, exchange.surface());
}

/// Can the point be inside this body, and be told so? Not if it is a surface node of it, or held
/// like the body.
template <int dim>
bool
may_be_inside(const FacetExchange<dim> &exchange,
              const PointSet<dim>      &points,
              const unsigned int        i,
              const unsigned int        body)
{
  const auto &surface = exchange.surface();
  return surface.bodies[body].kind == SurfaceKind::closed &&
         (points.body < 0 ||
          (surface.bodies[points.body].part != surface.bodies[body].part &&
           (surface.bodies[body].movable ||
            surface.can_move(points.body, exchange.local_node(points.surface_node[i])))));
}

/// Points within R of a facet, or behind it.
template <int dim>
void
overlaps_near(const FacetExchange<dim>         &exchange,
              const std::vector<PointSet<dim>> &points,
              std::vector<Overlap<dim>>        &result)
{
  const auto       &surface = exchange.surface();
  GlobalSearch<dim> search;
  search.rebuild(surface, points, 0.);
  LocalSearch<dim> local_search;
  local_search.reinit(surface);
  local_search.update();
  std::vector<Contact<dim>> contacts;
  for (unsigned int s = 0; s < points.size(); ++s)
    local_search.find(points[s], s, search.candidates(s), {}, contacts);
  for (auto &c : contacts)
    if (c.gap < (1 - 1e-6) * c.distance && !is_held(exchange, points[c.set], c))
      result.push_back({c.set,
                        c.point,
                        points[c.set].id(c.point),
                        points[c.set].point(c.point),
                        c.distance - c.gap,
                        surface.facets[c.facet].body,
                        surface.facets[c.facet].key});
}

/// Points inside a body without holes that are not in the list yet.
template <int dim>
void
overlaps_inside(const FacetExchange<dim>         &exchange,
                const std::vector<PointSet<dim>> &points,
                std::vector<Overlap<dim>>        &result)
{
  const auto      &surface    = exchange.surface();
  const auto       watertight = find_watertight(surface);
  std::vector<Box> boxes;
  Box              all;
  all.lower.fill(std::numeric_limits<double>::max());
  all.upper.fill(std::numeric_limits<double>::lowest());
  for (const auto &facet : surface.facets)
    {
      boxes.push_back(facet_box(surface, facet, 0.));
      for (int d = 0; d < 3; ++d)
        {
          all.lower[d] = std::min(all.lower[d], boxes.back().lower[d]);
          all.upper[d] = std::max(all.upper[d], boxes.back().upper[d]);
        }
    }
  BoxTree tree;
  tree.build(boxes);
  // Rays that run exactly through nodes of an aligned mesh would have to be decided by round-off.
  const double                                    jitter = 1e-7 * (all.upper[0] - all.lower[0]);
  std::vector<unsigned int>                       found, meetings(surface.bodies.size());
  std::vector<std::pair<unsigned, std::uint64_t>> known;
  for (const auto &overlap : result)
    known.emplace_back(overlap.set, overlap.id);
  std::sort(known.begin(), known.end());
  for (unsigned int s = 0; s < points.size(); ++s)
    for (unsigned int i = 0; i < points[s].n_points; ++i)
      {
        auto p = points[s].point(i);
        for (int d = 1; d < dim; ++d)
          p[d] += (1 + 0.377 * d) * jitter;
        Box ray = all;
        for (int d = 0; d < dim; ++d)
          ray.lower[d] = p[d];
        for (int d = 1; d < dim; ++d)
          ray.upper[d] = p[d];
        if (!overlap(ray, all) || ray.lower[0] > ray.upper[0])
          continue;
        tree.find(ray, found);
        std::fill(meetings.begin(), meetings.end(), 0);
        for (const unsigned int f : found)
          meetings[surface.facets[f].body] += n_meetings(surface, surface.facets[f], p);
        for (unsigned int b = 0; b < meetings.size(); ++b)
          if (meetings[b] % 2 == 1 && watertight[b] && may_be_inside(exchange, points[s], i, b) &&
              !std::binary_search(known.begin(), known.end(), std::make_pair(s, points[s].id(i))))
            result.push_back({s,
                              i,
                              points[s].id(i),
                              points[s].point(i),
                              std::numeric_limits<double>::infinity(),
                              b,
                              surface.facets[found.front()].key});
      }
}
} // namespace

template <int dim>
std::vector<Overlap<dim>>
initial_overlaps(const Surface<dim>               &owned,
                 const std::vector<PointSet<dim>> &points,
                 MPI_Comm                          communicator)
{
  FacetExchange<dim> exchange(communicator);
  std::vector<Box>   everywhere(1);
  everywhere[0].lower.fill(std::numeric_limits<double>::lowest());
  everywhere[0].upper.fill(std::numeric_limits<double>::max());
  exchange.rebuild(owned, everywhere, points);

  std::vector<Overlap<dim>> result;
  if (!exchange.surface().facets.empty())
    {
      overlaps_near(exchange, points, result);
      overlaps_inside(exchange, points, result);
    }
  return result;
}

template std::vector<Overlap<2>>
initial_overlaps(const Surface<2> &, const std::vector<PointSet<2>> &, MPI_Comm);
template std::vector<Overlap<3>>
initial_overlaps(const Surface<3> &, const std::vector<PointSet<3>> &, MPI_Comm);
} // namespace coracle::contact
