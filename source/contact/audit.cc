// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/audit.h>

namespace coracle::contact
{
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
  for (unsigned int s = 0; s < points.size(); ++s)
    for (std::size_t i = 0; i < starts[s].size(); ++i)
      {
        const unsigned int   point = candidates[s]->point[i];
        const Path<dim>      p     = {{starts[s][i], points[s].point(point)}};
        const CandidateRange range{candidates[s]->facet.data(),
                                   candidates[s]->begin[i],
                                   candidates[s]->begin[i + 1]};
        for (unsigned int b = 0; b < surface.bodies.size(); ++b)
          {
            const auto &body = surface.bodies[b];
            path_audit.begin(p);
            add_facets(surface, b, range);
            for (const auto &event : path_audit.meetings(side_of(body, points[s], point)))
              if (body.kind == SurfaceKind::sheet || event.direction > 0)
                last.push_back({points[s].id(point),
                                p[0] + event.time * (p[1] - p[0]),
                                event.time,
                                b,
                                surface.facets[path_audit.facet(event).index].key,
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
Audit<dim>::add_facets(const Surface<dim>   &surface,
                       const unsigned int    body,
                       const CandidateRange &range)
{
  for (std::size_t k = range.begin; k < range.end; ++k)
    {
      const auto &facet = surface.facets[range.facet[k]];
      if (facet.body != body)
        continue;
      MovingFacet<dim> moving{range.facet[k], facet.nodes, {}, {}, {}};
      for (unsigned int v = 0; v < facet.nodes.size(); ++v)
        {
          moving.x[0][v] = nodes[facet.nodes[v]];
          moving.x[1][v] = surface.nodes[facet.nodes[v]].position;
        }
      path_audit.add(moving);
    }
}

template class Audit<2>;
template class Audit<3>;
} // namespace coracle::contact
