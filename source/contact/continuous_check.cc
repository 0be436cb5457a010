// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/between.h>
#include <coracle/contact/continuous_check.h>
#include <coracle/contact/surface_topology.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// A point nearer than this part of the facet's size starts on the surface.
constexpr double on_surface = 1e-8;
/// It is then thought this part of the smallest facet's size there off it, and no less than this
/// part of the largest one's: nearest points are good to 1e-10 of a facet's size.
constexpr double off_smallest = 1e-8, off_largest = 1e-9;
/// Planes that are collected before less clearance is asked for.
constexpr unsigned int most_planes = 32;
constexpr double       squeezes[]  = {1., 0.2, 0.04};

dealii::Tensor<1, 2>
normal_of(const std::array<dealii::Point<2>, 2> &x, const NearestPoint<2> &)
{
  const auto t = x[1] - x[0];
  return dealii::Tensor<1, 2>({t[1], -t[0]});
}

/// Of the bilinear facet (triangle: of its plane) at a place on it; not of unit length.
dealii::Tensor<1, 3>
normal_of(const std::array<dealii::Point<3>, 4> &x, const NearestPoint<3> &at)
{
  if (x[2] == x[3])
    return dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
  const double xi = at.weights[1] + at.weights[2], eta = at.weights[2] + at.weights[3];
  return dealii::cross_product_3d((1 - eta) * (x[1] - x[0]) + eta * (x[2] - x[3]),
                                  (1 - xi) * (x[3] - x[0]) + xi * (x[2] - x[1]));
}

} // namespace

template <int dim>
void
ContinuousCheck<dim>::start(const Surface<dim> &surface)
{
  nodes.resize(surface.nodes.size());
  for (unsigned int i = 0; i < nodes.size(); ++i)
    nodes[i] = surface.nodes[i].position;
}

template <int dim>
double
ContinuousCheck<dim>::size_of(const unsigned int facet) const
{
  double size = 0;
  for (int d = 0; d < dim; ++d)
    size = std::max(size, extents[facet].upper[d] - extents[facet].lower[d]);
  return size;
}

template <int dim>
double
ContinuousCheck<dim>::way_off_surface(const Surface<dim>       &surface,
                                      const dealii::Point<dim> &x,
                                      const PointOfSet         &point) const
{
  double   smallest = std::numeric_limits<double>::max(), largest = 0;
  Vertices vertices;
  for (const unsigned int *f = point.first_facet; f != point.last_facet; ++f)
    {
      for (unsigned int k = 0; k < n_vertices; ++k)
        vertices[k] = nodes[surface.facets[*f].nodes[k]];
      if (std::sqrt(nearest_on(x, vertices).distance_square) >= on_surface * size_of(*f))
        continue;
      double size = 0;
      for (const auto &v : vertices)
        size = std::max(size, v.distance(vertices[0]));
      smallest = std::min(smallest, size);
      largest  = std::max(largest, size);
    }
  return largest > 0 ? std::max(off_smallest * smallest, off_largest * largest) : 0.;
}

template <int dim>
bool
ContinuousCheck<dim>::collect(const Surface<dim>       &surface,
                              const dealii::Point<dim> &begin,
                              const dealii::Point<dim> &end,
                              const PointOfSet         &point)
{
  const std::size_t n_known = near.size();
  for (const unsigned int *f = point.first_facet; f != point.last_facet; ++f)
    {
      const auto  &facet = surface.facets[*f];
      const auto  &box   = extents[*f];
      const auto  &body  = surface.bodies[facet.body];
      const double R     = point.radius + 0.5 * body.thickness;
      const double room  = std::max(clearance * R, least_clearance * size_of(*f));
      bool         apart = passed[facet.body];
      for (int d = 0; d < dim; ++d)
        apart |= (std::max(begin[d], end[d]) < box.lower[d] - room) |
                 (std::min(begin[d], end[d]) > box.upper[d] + room);
      if (apart || std::any_of(near.begin(), near.begin() + n_known, [f](const Near &pair) {
            return pair.facet == *f;
          }))
        continue;
      Near pair;
      pair.facet = *f;
      for (unsigned int k = 0; k < n_vertices; ++k)
        {
          pair.start[k] = nodes[facet.nodes[k]];
          pair.end[k]   = surface.nodes[facet.nodes[k]].position;
        }
      pair.clearance = room;
      if (certainly_apart(begin, end, pair))
        continue;
      const double distance   = std::sqrt(nearest_on(begin, pair.start).distance_square);
      pair.greatest_clearance = pair.clearance = std::min(room, 0.5 * distance);
      if (distance > 0)
        near.push_back(pair);
    }
  return near.size() > n_known;
}

template <int dim>
typename ContinuousCheck<dim>::Plane
ContinuousCheck<dim>::plane_at_end(const Near &facet, const Meeting &meeting)
{
  Plane              result{meeting.normal, 0};
  dealii::Point<dim> place;
  for (unsigned int k = 0; k < n_vertices; ++k)
    place += meeting.nearest.weights[k] * facet.end[k];
  if (meeting.nearest.region == Region::interior)
    {
      // Turned with the facet.
      const auto then = normal_of(between(facet.start, facet.end, meeting.time), meeting.nearest),
                 last = normal_of(facet.end, meeting.nearest);
      if (last.norm() > 0 && then.norm() > 0)
        result.normal = (then * meeting.normal < 0 ? -1 : 1) / last.norm() * last;
    }
  result.bound = result.normal * place + 2 * facet.clearance;
  return result;
}

// At the time of the meeting the path must be off the facet; its end decides where it is then.
template <int dim>
typename ContinuousCheck<dim>::Plane
ContinuousCheck<dim>::plane_on_the_way(const Near               &facet,
                                       const Meeting            &meeting,
                                       const dealii::Point<dim> &begin)
{
  constexpr double   earliest = 0.1;
  const double       t        = std::max(earliest, meeting.time);
  dealii::Point<dim> place;
  for (unsigned int k = 0; k < n_vertices; ++k)
    place += meeting.nearest.weights[k] * between(facet.start[k], facet.end[k], t);
  const double bound = meeting.normal * place + 2 * facet.clearance;
  return {meeting.normal, (bound - (1 - t) * (meeting.normal * begin)) / t};
}

// Where the point would be at the end if from this time on it kept its place relative to the facet.
template <int dim>
dealii::Point<dim>
ContinuousCheck<dim>::carried(const Near               &facet,
                              const dealii::Point<dim> &begin,
                              const dealii::Point<dim> &end,
                              const double              time)
{
  Meeting    there{};
  const auto p     = between(begin, end, time);
  const auto x     = between(facet.start, facet.end, time);
  there.time       = time;
  there.nearest    = nearest_on(p, x);
  const double gap = std::sqrt(there.nearest.distance_square);
  if (gap == 0)
    return p;
  there.normal             = (p - there.nearest.place) / gap;
  const auto         plane = plane_at_end(facet, there);
  dealii::Point<dim> result;
  for (unsigned int k = 0; k < n_vertices; ++k)
    result += there.nearest.weights[k] * facet.end[k];
  return result + gap * plane.normal;
}

// The nearest place to `wanted` behind no plane: Gauss-Seidel on the multipliers of the planes.
template <int dim>
void
ContinuousCheck<dim>::project(const dealii::Point<dim> &wanted, dealii::Point<dim> &end) const
{
  std::array<double, most_planes> multiplier{};
  end = wanted;
  for (unsigned int sweep = 0; sweep < 50; ++sweep)
    {
      double change = 0, size = 0;
      for (unsigned int k = 0; k < planes.size(); ++k)
        {
          const double old = multiplier[k];
          multiplier[k]    = std::max(0., old + planes[k].bound - planes[k].normal * end);
          end += (multiplier[k] - old) * planes[k].normal;
          change = std::max(change, std::abs(multiplier[k] - old));
          size   = std::max(size, multiplier[k]);
        }
      if (change <= 1e-6 * size)
        break;
    }
}

template <int dim>
bool
ContinuousCheck<dim>::keep_free(const dealii::Point<dim> &begin, dealii::Point<dim> &end)
{
  const dealii::Point<dim> wanted = end;
  Meeting                  meeting{}, first{};
  unsigned int             which = 0, first_which = 0;
  for (auto &pair : near)
    pair.clearance = pair.greatest_clearance;
  if (!first_meeting(begin, end, first, first_which))
    return true;
  for (const double squeeze : squeezes)
    {
      for (auto &pair : near)
        pair.clearance = squeeze * pair.greatest_clearance;
      planes.clear();
      end           = wanted;
      double growth = 2;
      for (unsigned int i = 0; i < most_planes / 2; ++i)
        {
          if (!first_meeting(begin, end, meeting, which))
            return true;
          planes.push_back(within_reach(plane_at_end(near[which], meeting), wanted));
          planes.push_back(within_reach(plane_on_the_way(near[which], meeting, begin), wanted));
          // The more, the longer it takes.
          const double more = (growth - 2) * near[which].clearance;
          for (unsigned int k = planes.size() - 2; k < planes.size(); ++k)
            planes[k].bound += more;
          growth *= 2;
          project(wanted, end);
        }
    }
  // Stay where the first facet was met, or where the point was before, and go with the facet.
  for (const double part : {0.9, 0.5, 0.})
    {
      end = carried(near[first_which], begin, wanted, part * first.time);
      for (int d = 0; d < dim; ++d)
        if (fixed[d])
          end[d] = wanted[d];
      if (!first_meeting(begin, end, meeting, which))
        return true;
    }
  return false;
}

template <int dim>
bool
ContinuousCheck<dim>::find_free_end(const Surface<dim>       &surface,
                                    const dealii::Point<dim> &begin,
                                    dealii::Point<dim>       &end,
                                    const PointOfSet         &point)
{
  const auto wanted = end;
  bool       free   = true;
  near.clear();
  // An end that has been changed may be near to other facets.
  while (collect(surface, begin, end, point))
    {
      end  = wanted;
      free = keep_free(begin, end);
    }
  return free;
}

template <int dim>
void
ContinuousCheck<dim>::find_extents(const Surface<dim> &surface)
{
  extents.resize(surface.facets.size());
  for (unsigned int f = 0; f < extents.size(); ++f)
    for (int d = 0; d < dim; ++d)
      {
        auto &lower = extents[f].lower[d], &upper = extents[f].upper[d];
        lower = upper = nodes[surface.facets[f].nodes[0]][d];
        for (const unsigned int node : surface.facets[f].nodes)
          {
            const double a = nodes[node][d], b = surface.nodes[node].position[d];
            lower = std::min({lower, a, b});
            upper = std::max({upper, a, b});
          }
      }
}

template <int dim>
typename ContinuousCheck<dim>::Vector
ContinuousCheck<dim>::look_at_contacts(const Surface<dim>    &surface,
                                       const unsigned int     set,
                                       const unsigned int     point,
                                       ContactIterator       &contact,
                                       const ContactIterator &end)
{
  passed.assign(surface.bodies.size(), 0);
  while (contact != end && (contact->set < set || (contact->set == set && contact->point < point)))
    ++contact;
  Vector outward;
  for (; contact != end && contact->set == set && contact->point == point; ++contact)
    {
      const double size = size_of(contact->facet);
      if (contact->gap < -on_surface * size)
        passed[surface.facets[contact->facet].body] = 1;
      // Farther off it needs no help, which in a narrow valley could take it through the other
      // wall.
      else if (contact->gap < off_largest * size)
        outward = contact->normal;
    }
  return outward;
}

template <int dim>
typename ContinuousCheck<dim>::Report
ContinuousCheck<dim>::resolve(const Surface<dim>                    &surface,
                              const std::vector<PointSet<dim>>      &points,
                              const std::vector<const Candidates *> &candidates,
                              const std::vector<Contact<dim>>       &contacts,
                              const Ends                            &ends)
{
  Report report;
  if (std::all_of(ends.begin(), ends.end(), [](const auto &end) { return end[0] == nullptr; }))
    return report;
  find_extents(surface);
  fixed.fill(false);
  auto contact = contacts.begin();
  for (unsigned int s = 0; s < points.size(); ++s)
    for (std::size_t i = 0; ends[s][0] != nullptr && i < candidates[s]->point.size(); ++i)
      {
        const unsigned int p       = candidates[s]->point[i];
        const Vector       outward = look_at_contacts(surface, s, p, contact, contacts.end());
        if (points[s].is_hole(p))
          continue;
        dealii::Point<dim> begin = points[s].point(p), end;
        for (int d = 0; d < dim; ++d)
          end[d] = ends[s][d][p];
        const unsigned int *facets = candidates[s]->facet.data();
        const PointOfSet    point  = {facets + candidates[s]->begin[i],
                                      facets + candidates[s]->begin[i + 1],
                                      points[s].radius(p)};
        if (outward.norm_square() > 0)
          begin += way_off_surface(surface, begin, point) * outward;
        const auto wanted = end;
        const bool free   = find_free_end(surface, begin, end, point);
        if (free && end == wanted)
          continue;
        ++report.n_resolved;
        report.n_failed += !free;
        report.largest_shift = std::max(report.largest_shift, end.distance(wanted));
        for (int d = 0; d < dim; ++d)
          ends[s][d][p] = end[d];
      }
  return report;
}

template class ContinuousCheck<2>;
template class ContinuousCheck<3>;
} // namespace coracle::contact
