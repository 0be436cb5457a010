// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/audit.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// The surface is thought this far, in facet sizes, from the side that the point belongs to.
constexpr double thickness_of_nothing = 1e-9;
/// Meetings nearer in time than this part of the step are one.
constexpr double same_time = 1e-7;

/// Do the boxes of the path and of the moving facet miss each other?
template <int dim>
bool
far_apart(const std::array<dealii::Point<dim>, 2>                                      &p,
          const std::array<std::array<dealii::Point<dim>, vertices_per_facet<dim>>, 2> &x)
{
  bool result = false;
  for (int d = 0; d < dim; ++d)
    {
      double lower = x[0][0][d], upper = x[0][0][d];
      for (const auto &vertices : x)
        for (const auto &v : vertices)
          {
            lower = std::min(lower, v[d]);
            upper = std::max(upper, v[d]);
          }
      const double room = 1e-6 * (upper - lower) + 1e-6 * std::abs(p[1][d] - p[0][d]);
      result |=
        (std::max(p[0][d], p[1][d]) < lower - room) | (std::min(p[0][d], p[1][d]) > upper + room);
    }
  return result;
}

void
meet_facet(const std::array<dealii::Point<2>, 2>                &p,
           const std::array<std::array<dealii::Point<2>, 2>, 2> &x,
           const bool,
           const double            shift,
           const unsigned int      facet,
           std::vector<PathEvent> &events)
{
  meet_simplex<2>(p, x, shift, facet, events);
}

void
meet_facet(const std::array<dealii::Point<3>, 2>                &p,
           const std::array<std::array<dealii::Point<3>, 4>, 2> &x,
           const bool                                            triangle,
           const double                                          shift,
           const unsigned int                                    facet,
           std::vector<PathEvent>                               &events)
{
  if (triangle)
    {
      meet_simplex<3>(
        p, {{{{x[0][0], x[0][1], x[0][2]}}, {{x[1][0], x[1][1], x[1][2]}}}}, shift, facet, events);
      return;
    }
  std::array<dealii::Point<3>, 2> middle;
  for (unsigned int t = 0; t < 2; ++t)
    for (const auto &v : x[t])
      middle[t] += 0.25 * v;
  for (unsigned int k = 0; k < 4; ++k)
    {
      const unsigned int next = (k + 1) % 4;
      meet_simplex<3>(p,
                      {{{{x[0][k], x[0][next], middle[0]}}, {{x[1][k], x[1][next], middle[1]}}}},
                      shift,
                      facet,
                      events);
    }
}

/// Meetings at one time are one, and count by their sum; returns what is left.
void
unite(std::vector<PathEvent> &events)
{
  std::sort(events.begin(), events.end(), [](const PathEvent &a, const PathEvent &b) {
    return a.time < b.time;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < events.size();)
    {
      PathEvent   event = events[i];
      int         sum   = 0;
      std::size_t j     = i;
      for (; j < events.size() && events[j].time - events[i].time < same_time; ++j)
        sum += events[j].direction;
      i = j;
      if (sum == 0)
        continue;
      event.direction = (sum > 0 ? 1 : -1);
      events[kept++]  = event;
    }
  events.resize(kept);
}
} // namespace

template <int dim>
void
Audit<dim>::start(const Surface<dim>                    &surface,
                  const std::vector<PointSet<dim>>      &points,
                  const std::vector<const Candidates *> &list)
{
  candidates = list;
  nodes.resize(surface.nodes.size());
  for (unsigned int i = 0; i < nodes.size(); ++i)
    nodes[i] = surface.nodes[i].position;
  starts.resize(points.size());
  for (unsigned int s = 0; s < points.size(); ++s)
    {
      starts[s].clear();
      for (const unsigned int p : candidates[s]->point)
        starts[s].push_back(points[s].point(p));
    }
}

template <int dim>
unsigned int
Audit<dim>::finish(const Surface<dim> &surface, const std::vector<PointSet<dim>> &points)
{
  unsigned int           n_found = 0;
  std::vector<PathEvent> events;
  for (unsigned int s = 0; s < points.size(); ++s)
    for (std::size_t i = 0; i < starts[s].size(); ++i)
      {
        const unsigned int                      point = candidates[s]->point[i];
        const std::array<dealii::Point<dim>, 2> p     = {{starts[s][i], points[s].point(point)}};
        const CandidateRange                    range{candidates[s]->facet.data(),
                                   candidates[s]->begin[i],
                                   candidates[s]->begin[i + 1]};
        for (unsigned int b = 0; b < surface.bodies.size(); ++b)
          {
            const auto &body = surface.bodies[b];
            events.clear();
            meet_body(surface, b, p, side_of(body, points[s], point), range, events);
            unite(events);
            for (const auto &event : events)
              if (body.kind == SurfaceKind::sheet || event.direction > 0)
                {
                  ++n_found;
                  if (first.size() < n_kept)
                    first.push_back({points[s].id(point),
                                     p[0] + event.time * (p[1] - p[0]),
                                     event.time,
                                     b,
                                     surface.facets[event.facet].key});
                }
          }
      }
  total += n_found;
  return n_found;
}

template <int dim>
int
Audit<dim>::side_of(const SurfaceBody &body, const PointSet<dim> &points, const unsigned int point)
{
  if (body.kind == SurfaceKind::closed)
    return 1;
  const double side = points.side[body.sheet][point];
  return side > 0 ? 1 : (side < 0 ? -1 : 0);
}

template <int dim>
void
Audit<dim>::meet_body(const Surface<dim>                      &surface,
                      const unsigned int                       body,
                      const std::array<dealii::Point<dim>, 2> &p,
                      const int                                side,
                      const CandidateRange                    &range,
                      std::vector<PathEvent>                  &events) const
{
  for (std::size_t k = range.begin; k < range.end; ++k)
    {
      const auto &facet = surface.facets[range.facet[k]];
      if (facet.body != body)
        continue;
      std::array<std::array<dealii::Point<dim>, vertices_per_facet<dim>>, 2> x;
      for (unsigned int v = 0; v < facet.nodes.size(); ++v)
        {
          x[0][v] = nodes[facet.nodes[v]];
          x[1][v] = surface.nodes[facet.nodes[v]].position;
        }
      if (far_apart<dim>(p, x))
        continue;
      const bool triangle =
        (facet.nodes[facet.nodes.size() - 1] == facet.nodes[facet.nodes.size() - 2]);
      meet_facet(p, x, triangle, side * thickness_of_nothing, range.facet[k], events);
    }
}

template class Audit<2>;
template class Audit<3>;
} // namespace coracle::contact
