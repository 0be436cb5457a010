// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/continuous_check.h>
#include <coracle/contact/surface_topology.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// A point nearer than this part of the facet's size starts on the surface, and is thought this
/// part of the smallest facet's size there off it.
constexpr double on_surface = 1e-8, off_surface = 1e-9;
/// Planes that are collected before less clearance is asked for.
constexpr unsigned int most_planes = 32;
constexpr double       squeezes[]  = {1., 0.2, 0.04};

template <int dim>
dealii::Point<dim>
between(const dealii::Point<dim> &a, const dealii::Point<dim> &b, const double t)
{
  return a + t * (b - a);
}

template <int dim, std::size_t n>
std::array<dealii::Point<dim>, n>
between(const std::array<dealii::Point<dim>, n> &a,
        const std::array<dealii::Point<dim>, n> &b,
        const double                             t)
{
  std::array<dealii::Point<dim>, n> result;
  for (std::size_t k = 0; k < n; ++k)
    result[k] = between(a[k], b[k], t);
  return result;
}

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

dealii::Tensor<1, 2>
mean_normal(const std::array<dealii::Point<2>, 2> &x)
{
  return normal_of(x, {});
}

dealii::Tensor<1, 3>
mean_normal(const std::array<dealii::Point<3>, 4> &x)
{
  return dealii::cross_product_3d(x[2] - x[0], x[3] - x[1]);
}

double
volume(const std::array<dealii::Tensor<1, 2>, 2> &v)
{
  return v[0][0] * v[1][1] - v[0][1] * v[1][0];
}

double
volume(const std::array<dealii::Tensor<1, 3>, 3> &v)
{
  return dealii::cross_product_3d(v[0], v[1]) * v[2];
}

/**
 * Bounds of the volume spanned by vectors that change linearly in time: the
 * smallest and the greatest of its Bernstein coefficients, which are means of
 * volumes of some vectors at the start and the others at the end.
 */
template <int dim>
std::array<double, 2>
volume_bounds(const std::array<dealii::Tensor<1, dim>, dim> &start,
              const std::array<dealii::Tensor<1, dim>, dim> &end)
{
  std::array<double, dim + 1>       sum{};
  std::array<unsigned int, dim + 1> n{};
  for (unsigned int choice = 0; choice < (1u << dim); ++choice)
    {
      std::array<dealii::Tensor<1, dim>, dim> v;
      unsigned int                            degree = 0;
      for (unsigned int i = 0; i < dim; ++i)
        {
          const bool last = (choice >> i) & 1;
          v[i]            = last ? end[i] : start[i];
          degree += last;
        }
      sum[degree] += volume(v);
      ++n[degree];
    }
  std::array<double, 2> result{{sum[0], sum[0]}};
  for (unsigned int i = 0; i <= dim; ++i)
    {
      result[0] = std::min(result[0], sum[i] / n[i]);
      result[1] = std::max(result[1], sum[i] / n[i]);
    }
  return result;
}
} // namespace

template <int dim>
NearestPoint<dim>
ContinuousCheck<dim>::nearest_on(const dealii::Point<dim> &x, const Vertices &vertices)
{
  if constexpr (dim == 3)
    if (vertices[2] == vertices[3])
      return nearest_point_triangle(x, vertices);
  return nearest_point(x, vertices);
}

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
ContinuousCheck<dim>::smallest_facet_at(const Surface<dim>       &surface,
                                        const dealii::Point<dim> &x,
                                        const PointOfSet         &point) const
{
  double   result = std::numeric_limits<double>::max();
  Vertices vertices;
  for (const unsigned int *f = point.first_facet; f != point.last_facet; ++f)
    {
      for (unsigned int k = 0; k < n_vertices; ++k)
        vertices[k] = nodes[surface.facets[*f].nodes[k]];
      double size = 0;
      for (const auto &v : vertices)
        size = std::max(size, v.distance(vertices[0]));
      if (std::sqrt(nearest_on(x, vertices).distance_square) < on_surface * size_of(*f))
        result = std::min(result, size);
    }
  return result < std::numeric_limits<double>::max() ? result : 0;
}

template <int dim>
void
ContinuousCheck<dim>::collect(const Surface<dim>       &surface,
                              const dealii::Point<dim> &begin,
                              const dealii::Point<dim> &end,
                              const PointOfSet         &point)
{
  near.clear();
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
      if (apart)
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
      const double distance = std::sqrt(nearest_on(begin, pair.start).distance_square);
      pair.clearance        = std::min(room, 0.5 * distance);
      if (distance > 0)
        near.push_back(pair);
    }
}

// Does the facet stay behind a plane along it? Enough for all but a few pairs.
template <int dim>
bool
ContinuousCheck<dim>::certainly_apart(const dealii::Point<dim> &begin,
                                      const dealii::Point<dim> &end,
                                      const Near               &facet)
{
  const Vector normal = mean_normal(facet.start);
  const double length = normal.norm(), side = (begin - facet.start[0]) * normal > 0 ? 1 : -1;
  bool         result = true;
  for (unsigned int k = 0; k < n_vertices; ++k)
    result &= (side * ((begin - facet.start[k]) * normal) > facet.clearance * length) &
              (side * ((end - facet.end[k]) * normal) > facet.clearance * length);
  return result;
}

// Does the point stay on one side of a plane that moves with the facet, at least `kept` off it, and
// the facet's remaining node on the other, from time t to s? Knows of turning, unlike a fixed
// plane.
template <int dim>
bool
ContinuousCheck<dim>::stays_off(const dealii::Point<dim> &begin,
                                const dealii::Point<dim> &end,
                                const Near               &facet,
                                const double              t,
                                const double              s)
{
  const std::array<dealii::Point<dim>, 2> p = {{between(begin, end, t), between(begin, end, s)}};
  const std::array<Vertices, 2>           x = {
              {between(facet.start, facet.end, t), between(facet.start, facet.end, s)}};
  const bool         quad = (dim == 3 && !(x[0][n_vertices - 1] == x[0][n_vertices - 2]));
  const unsigned int n = (dim == 2 ? 2 : quad ? 4 : 3), n_tries = quad ? 4 : 1;
  for (unsigned int first = 0; first < n_tries; ++first)
    {
      using Vectors = std::array<dealii::Tensor<1, dim>, dim>;
      std::array<Vectors, 2> v, w;
      double                 size = 0;
      for (unsigned int e = 0; e < 2; ++e)
        {
          for (unsigned int i = 1; i < dim; ++i)
            v[e][i] = w[e][i] = x[e][(first + i) % n] - x[e][first];
          v[e][0] = p[e] - x[e][first];
          w[e][0] = x[e][(first + n - 1) % n] - x[e][first];
        }
      // A bound of the normal's length.
      const auto longest = [&v](const unsigned int i) {
        return std::max(v[0][i].norm(), v[1][i].norm());
      };
      size                     = (dim == 2 ? longest(1) : longest(1) * longest(dim - 1));
      const auto   bounds      = volume_bounds<dim>(v[0], v[1]);
      const double side        = (bounds[0] > 0 ? 1 : -1);
      const double least       = (bounds[0] > 0 ? bounds[0] : -bounds[1]);
      const double least_asked = 0.9 * facet.clearance * size;
      if (least <= least_asked)
        continue;
      if (!quad)
        return true;
      const auto other = volume_bounds<dim>(w[0], w[1]);
      if ((side > 0 ? other[1] : -other[0]) < 0.1 * least_asked)
        return true;
    }
  return false;
}

template <int dim>
bool
ContinuousCheck<dim>::meets(const dealii::Point<dim> &begin,
                            const dealii::Point<dim> &end,
                            const Near               &facet,
                            Meeting                  &meeting)
{
  double displacement = 0;
  for (unsigned int k = 0; k < n_vertices; ++k)
    displacement = std::max(displacement, ((end - begin) - (facet.end[k] - facet.start[k])).norm());
  if (displacement == 0)
    return false;
  const double kept = 0.9 * facet.clearance;
  double       t    = 0;
  for (unsigned int i = 0; i < 60; ++i)
    {
      const auto p        = between(begin, end, t);
      const auto x        = between(facet.start, facet.end, t);
      meeting.time        = t;
      meeting.nearest     = nearest_on(p, x);
      const double length = std::sqrt(meeting.nearest.distance_square);
      if (length > 0)
        meeting.normal = (p - meeting.nearest.place) / length;
      if (length <= facet.clearance && i > 0)
        return true;

      // How long the facet stays behind the plane at `kept` from it.
      double plane = 1;
      for (unsigned int k = 0; k < n_vertices; ++k)
        {
          const double now  = (p - x[k]) * meeting.normal - kept,
                       then = (end - facet.end[k]) * meeting.normal - kept;
          if (now <= 0)
            plane = 0;
          else if (then < 0)
            plane = std::min(plane, now / (now - then));
        }
      double next = std::max(t + plane * (1 - t), t + (length - kept) / displacement);
      if (next >= 1)
        return false;
      for (double part = 1; part > 0.01; part *= 0.25)
        if (next < t + part * (1 - t) && stays_off(begin, end, facet, t, t + part * (1 - t)))
          next = t + part * (1 - t);
      t = next;
      if (t >= 1)
        return false;
    }
  return true;
}

template <int dim>
bool
ContinuousCheck<dim>::first_meeting(const dealii::Point<dim> &begin,
                                    const dealii::Point<dim> &end,
                                    Meeting                  &meeting,
                                    unsigned int             &which) const
{
  bool    result = false;
  Meeting one{};
  for (unsigned int i = 0; i < near.size(); ++i)
    if (meets(begin, end, near[i], one) && (!result || one.time < meeting.time))
      {
        result  = true;
        meeting = one;
        which   = i;
      }
  return result;
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
  if (!first_meeting(begin, end, first, first_which))
    return true;
  double asked = 1;
  for (const double squeeze : squeezes)
    {
      for (auto &pair : near)
        pair.clearance *= squeeze / asked;
      asked = squeeze;
      planes.clear();
      end           = wanted;
      double growth = 2;
      for (unsigned int i = 0; i < most_planes / 2; ++i)
        {
          if (!first_meeting(begin, end, meeting, which))
            return true;
          planes.push_back(plane_at_end(near[which], meeting));
          planes.push_back(plane_on_the_way(near[which], meeting, begin));
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
      if (!first_meeting(begin, end, meeting, which))
        return true;
    }
  return false;
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

  auto contact = contacts.begin();
  for (unsigned int s = 0; s < points.size(); ++s)
    for (std::size_t i = 0; ends[s][0] != nullptr && i < candidates[s]->point.size(); ++i)
      {
        const unsigned int p     = candidates[s]->point[i];
        dealii::Point<dim> begin = points[s].point(p), end;
        for (int d = 0; d < dim; ++d)
          end[d] = ends[s][d][p];

        passed.assign(surface.bodies.size(), 0);
        while (contact != contacts.end() &&
               (contact->set < s || (contact->set == s && contact->point < p)))
          ++contact;
        Vector outward;
        for (; contact != contacts.end() && contact->set == s && contact->point == p; ++contact)
          {
            const double size = size_of(contact->facet);
            if (contact->gap < -on_surface * size)
              passed[surface.facets[contact->facet].body] = 1;
            else if (contact->gap < on_surface * size)
              outward = contact->normal;
          }
        if (points[s].is_hole(p))
          continue;

        const unsigned int *facets = candidates[s]->facet.data();
        const PointOfSet    point  = {facets + candidates[s]->begin[i],
                                      facets + candidates[s]->begin[i + 1],
                                      points[s].radius(p)};
        if (outward.norm_square() > 0)
          begin += off_surface * smallest_facet_at(surface, begin, point) * outward;
        collect(surface, begin, end, point);
        if (near.empty())
          continue;
        const auto wanted = end;
        const bool free   = keep_free(begin, end);
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
