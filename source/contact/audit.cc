// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/audit.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// So near, in facet sizes, a point is on the surface, and is then thought off it by so much.
constexpr double thickness_of_nothing = 1e-9, step_off = 1e-8;
/// How far triangles may be from a bilinear facet, in facet sizes.
constexpr double tolerance = 1e-9;
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

/// Calls action(simplex) for the simplices of a facet that are near the path.
template <typename Action>
void
for_each_simplex(const std::array<dealii::Point<2>, 2> &,
                 const std::array<std::array<dealii::Point<2>, 2>, 2> &x,
                 const double,
                 const Action &action)
{
  action(x);
}

using Quads = std::array<std::array<dealii::Point<3>, 4>, 2>;

/// Facets are cut into four, again and again, at most this often.
constexpr unsigned int most_cuts = 12;

/// The quarter of a bilinear facet at corner k, whose corner k that is.
Quads
quarter(const Quads &x, const unsigned int k)
{
  Quads result;
  for (unsigned int t = 0; t < 2; ++t)
    {
      const unsigned int next = (k + 1) % 4, opposite = (k + 2) % 4, previous = (k + 3) % 4;
      result[t][k]        = x[t][k];
      result[t][next]     = x[t][k] + 0.5 * (x[t][next] - x[t][k]);
      result[t][previous] = x[t][k] + 0.5 * (x[t][previous] - x[t][k]);
      result[t][opposite] =
        dealii::Point<3>(0.25 * (x[t][0] + x[t][1]) + 0.25 * (x[t][2] + x[t][3]));
    }
  return result;
}

template <typename Action>
void
cut_quad(const std::array<dealii::Point<3>, 2> &p,
         const Quads                           &x,
         const double                           tolerance,
         const unsigned int                     cuts,
         const Action                          &action)
{
  if (far_apart<3>(p, x))
    return;
  // The triangles around the middle are off by a quarter of the corners' offset from a
  // parallelogram.
  double warp = 0;
  for (const auto &v : x)
    warp = std::max(warp, 0.25 * ((v[0] - v[1]) + (v[2] - v[3])).norm());
  if (0.25 * warp > tolerance && cuts < most_cuts)
    {
      for (unsigned int k = 0; k < 4; ++k)
        cut_quad(p, quarter(x, k), tolerance, cuts + 1, action);
      return;
    }
  std::array<dealii::Point<3>, 2> middle;
  for (unsigned int t = 0; t < 2; ++t)
    middle[t] = dealii::Point<3>(0.25 * (x[t][0] + x[t][1]) + 0.25 * (x[t][2] + x[t][3]));
  using Triangles = std::array<std::array<dealii::Point<3>, 3>, 2>;
  for (unsigned int k = 0; k < 4; ++k)
    {
      const unsigned int next = (k + 1) % 4;
      action(Triangles{{{{x[0][k], x[0][next], middle[0]}}, {{x[1][k], x[1][next], middle[1]}}}});
    }
}

template <typename Action>
void
for_each_simplex(const std::array<dealii::Point<3>, 2> &p,
                 const Quads                           &x,
                 const double                           tolerance,
                 const Action                          &action)
{
  using Triangles = std::array<std::array<dealii::Point<3>, 3>, 2>;
  if (x[0][2] == x[0][3] && x[1][2] == x[1][3])
    action(Triangles{{{{x[0][0], x[0][1], x[0][2]}}, {{x[1][0], x[1][1], x[1][2]}}}});
  else
    cut_quad(p, x, tolerance, 0, action);
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
  last.clear();
  std::vector<PathEvent> events;
  for (unsigned int s = 0; s < points.size(); ++s)
    for (std::size_t i = 0; i < starts[s].size(); ++i)
      {
        const unsigned int                      point = candidates[s]->point[i];
        const std::array<dealii::Point<dim>, 2> p     = {{starts[s][i], points[s].point(point)}};
        CandidateRange                          range{candidates[s]->facet.data(),
                             candidates[s]->begin[i],
                             candidates[s]->begin[i + 1],
                             0};
        for (unsigned int b = 0; b < surface.bodies.size(); ++b)
          {
            const auto &body = surface.bodies[b];
            events.clear();
            range.side = side_of(body, points[s], point);
            meet_body(surface, b, p, range, events);
            unite(events);
            for (const auto &event : events)
              if (body.kind == SurfaceKind::sheet || event.direction > 0)
                last.push_back({points[s].id(point),
                                p[0] + event.time * (p[1] - p[0]),
                                event.time,
                                b,
                                surface.facets[event.facet].key,
                                s,
                                point,
                                event.direction});
          }
      }
  for (const auto &crossing : last)
    if (first.size() < n_kept)
      first.push_back(crossing);
  total += last.size();
  return last.size();
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
                      const CandidateRange                    &range,
                      std::vector<PathEvent>                  &events) const
{
  // Facets near the path with what is on them, and the way off those that the point starts on.
  struct Near
  {
    unsigned int                                                           facet;
    std::array<std::array<dealii::Point<dim>, vertices_per_facet<dim>>, 2> x;
    double                                                                 size;
  };
  static thread_local std::vector<Near> near;
  near.clear();
  dealii::Tensor<1, dim> off;
  double                 smallest = std::numeric_limits<double>::max();
  for (std::size_t k = range.begin; k < range.end; ++k)
    {
      const auto &facet = surface.facets[range.facet[k]];
      if (facet.body != body)
        continue;
      Near one{range.facet[k], {}, 0};
      for (unsigned int v = 0; v < facet.nodes.size(); ++v)
        {
          one.x[0][v] = nodes[facet.nodes[v]];
          one.x[1][v] = surface.nodes[facet.nodes[v]].position;
          one.size    = std::max(one.size, one.x[0][v].distance(one.x[0][0]));
        }
      if (far_apart<dim>(p, one.x))
        continue;
      near.push_back(one);
      for_each_simplex(p, one.x, tolerance * one.size, [&](const auto &simplex) {
        const auto normal = normal_if_on<dim>(p[0], simplex[0], thickness_of_nothing * one.size);
        if (normal.norm_square() > 0)
          smallest = std::min(smallest, one.size);
        off += normal;
      });
    }
  auto path = p;
  if (off.norm_square() > 0)
    path[0] += step_off * range.side * smallest / off.norm() * off;
  for (const auto &one : near)
    for_each_simplex(path, one.x, tolerance * one.size, [&](const auto &simplex) {
      meet_simplex<dim>(
        path, simplex, {range.side, thickness_of_nothing * one.size}, one.facet, events);
    });
}

template class Audit<2>;
template class Audit<3>;
} // namespace coracle::contact
