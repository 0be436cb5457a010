// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/local_search.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// Places nearer to each other than this, in facet sizes, are one contact that round-off has
/// doubled.
constexpr double same_place = 1e-8;
/// Nearer to an edge or vertex than this, in facet sizes, the offset has no reliable direction.
constexpr double on_surface = 1e-7;
} // namespace

template <int dim>
void
LocalSearch<dim>::reinit(const Surface<dim> &s)
{
  surface = &s;
  connections.reinit(s);
}

template <int dim>
std::array<dealii::Point<dim>, vertices_per_facet<dim>>
LocalSearch<dim>::vertices(const unsigned int facet) const
{
  std::array<dealii::Point<dim>, vertices_per_facet<dim>> x;
  for (unsigned int k = 0; k < x.size(); ++k)
    x[k] = surface->nodes[surface->facets[facet].nodes[k]].position;
  return x;
}

template <int dim>
void
LocalSearch<dim>::update()
{
  balls.resize(surface->facets.size());
  for (unsigned int f = 0; f < balls.size(); ++f)
    {
      const auto         x = vertices(f);
      dealii::Point<dim> centre;
      for (const auto &p : x)
        centre += p / double(x.size());
      double square = 0;
      for (const auto &p : x)
        square = std::max(square, centre.distance_square(p));
      balls[f] = {centre, std::sqrt(square)};
    }
}

template <int dim>
void
LocalSearch<dim>::collect_pairs(const PointSet<dim> &points,
                                const Candidates    &candidates,
                                const double         travel)
{
  pairs.clear();
  for (std::size_t i = 0; i < candidates.point.size(); ++i)
    {
      const unsigned int p = candidates.point[i];
      if (points.is_hole(p))
        continue;
      const auto   x = points.point(p);
      const double r = points.radius(p) + travel;
      for (std::size_t k = candidates.begin[i]; k < candidates.begin[i + 1]; ++k)
        {
          const unsigned int f = candidates.facet[k];
          const double       reach =
            balls[f].radius + r + 0.5 * surface->bodies[surface->facets[f].body].thickness;
          if (x.distance_square(balls[f].centre) < reach * reach)
            {
              pairs.emplace_back();
              pairs.back().point = p;
              pairs.back().facet = f;
            }
        }
    }
}

template <int dim>
void
LocalSearch<dim>::measure_pairs(const PointSet<dim> &points)
{
  for (auto &pair : pairs)
    {
      const auto x = points.point(pair.point);
      if constexpr (dim == 3)
        if (n_corners(surface->facets[pair.facet]) == 3)
          {
            pair.nearest = nearest_point_triangle(x, vertices(pair.facet));
            continue;
          }
      pair.nearest = nearest_point(x, vertices(pair.facet));
    }
}

template <int dim>
void
LocalSearch<dim>::find(const PointSet<dim>       &points,
                       const unsigned int         set,
                       const Candidates          &candidates,
                       const Motion              &motion,
                       std::vector<Contact<dim>> &contacts)
{
  const double travel = motion.travel();
  collect_pairs(points, candidates, travel);
  measure_pairs(points);

  const auto body = [this](const Pair &pair) { return surface->facets[pair.facet].body; };
  // Drop what is out of reach, and bring each point's facets of one body together.
  pairs.erase(std::remove_if(pairs.begin(),
                             pairs.end(),
                             [&](const Pair &pair) {
                               const double limit = travel + points.radius(pair.point) +
                                                    0.5 * surface->bodies[body(pair)].thickness;
                               return pair.nearest.distance_square >= limit * limit;
                             }),
              pairs.end());
  if (surface->bodies.size() > 1)
    std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair &a, const Pair &b) {
      return a.point != b.point ? a.point < b.point : body(a) < body(b);
    });

  std::size_t next   = 0;
  const auto  forget = [&](const unsigned int point, const unsigned int b) {
    if (surface->bodies[b].kind == SurfaceKind::sheet)
      points.side[surface->bodies[b].sheet][point] = 0;
  };
  for (const unsigned int point : candidates.point)
    for (unsigned int b = 0; b < surface->bodies.size(); ++b)
      {
        const std::size_t begin = next;
        while (next < pairs.size() && pairs[next].point == point && body(pairs[next]) == b)
          ++next;
        if (next == begin)
          forget(point, b);
        else
          {
            minima_of_body(points.point(point), begin, next);
            // Near a sheet only where another joins it: the side is that other one's affair.
            if (minima.empty())
              forget(point, b);
            contacts_of_body(points, set, motion, contacts);
          }
      }
}

template <int dim>
void
LocalSearch<dim>::minima_of_body(const dealii::Point<dim> &x_p,
                                 const std::size_t         begin,
                                 const std::size_t         end)
{
  minima.clear();
  for (std::size_t i = begin; i < end; ++i)
    {
      const auto &nearest = pairs[i].nearest;
      if (!connections.is_minimum(x_p, pairs[i].facet, nearest))
        continue;
      bool known = false;
      for (auto &other : minima)
        {
          auto        &kept = pairs[other.pair];
          const double size =
            same_place * (balls[kept.facet].radius + balls[pairs[i].facet].radius);
          if (connections.same_feature(kept.facet, kept.nearest, pairs[i].facet, nearest) ||
              nearest.place.distance_square(kept.nearest.place) < size * size)
            {
              known = true;
              if (surface->facets[pairs[i].facet].key < surface->facets[kept.facet].key)
                other.pair = i;
              break;
            }
        }
      if (!known)
        minima.push_back({static_cast<unsigned int>(i), {}, 0});
    }
  for (auto &minimum : minima)
    {
      const auto &pair     = pairs[minimum.pair];
      minimum.pseudonormal = connections.pseudonormal(pair.facet, pair.nearest);
      const double along   = (x_p - pair.nearest.place) * minimum.pseudonormal.normal;
      const double tiny    = 1e-12 * balls[pair.facet].radius;
      minimum.side         = (along > tiny ? 1 : (along < -tiny ? -1 : 0));
    }
}

template <int dim>
int
LocalSearch<dim>::own_side(const PointSet<dim> &points,
                           const unsigned int   point,
                           const Minimum       &nearest) const
{
  const auto &pair = pairs[nearest.pair];
  const auto &body = surface->bodies[surface->facets[pair.facet].body];
  if (body.kind == SurfaceKind::closed)
    return 1;
  double &kept = points.side[body.sheet][point];
  if (nearest.pseudonormal.rim && pair.nearest.distance_square > 0)
    {
      kept = 0;
      return 0;
    }
  if (kept == 0)
    {
      kept = nearest.side;
      if (nearest.side == 0)
        {
          // On the sheet itself: the side it comes from.
          auto        velocity = points.point_velocity(point);
          const auto &nodes    = surface->facets[pair.facet].nodes;
          for (unsigned int k = 0; k < nodes.size(); ++k)
            velocity -= pair.nearest.weights[k] * surface->nodes[nodes[k]].velocity;
          kept = (velocity * nearest.pseudonormal.normal > 0 ? -1 : 1);
        }
    }
  return kept < 0 ? -1 : 1;
}

template <int dim>
void
LocalSearch<dim>::contacts_of_body(const PointSet<dim>       &points,
                                   const unsigned int         set,
                                   const Motion              &motion,
                                   std::vector<Contact<dim>> &contacts) const
{
  if (minima.empty())
    return;
  const auto nearer = [this](const Minimum &a, const Minimum &b) {
    return pairs[a.pair].nearest.distance_square < pairs[b.pair].nearest.distance_square;
  };
  const auto        &nearest = *std::min_element(minima.begin(), minima.end(), nearer);
  const unsigned int point   = pairs[nearest.pair].point;
  const auto         x_p     = points.point(point);
  const int          own     = own_side(points, point, nearest);
  // At a rim there is no other side; a point exactly on the surface has not passed.
  const auto passed = [own](const Minimum &m) { return !m.pseudonormal.rim && m.side * own < 0; };

  for (const auto &minimum : minima)
    {
      if (passed(minimum) ? &minimum != &nearest : passed(nearest))
        continue;
      const auto &pair  = pairs[minimum.pair];
      const auto &facet = surface->facets[pair.facet];
      const auto &body  = surface->bodies[facet.body];

      Contact<dim> contact;
      contact.set      = set;
      contact.point    = point;
      contact.facet    = pair.facet;
      contact.region   = pair.nearest.region;
      contact.weights  = pair.nearest.weights;
      contact.place    = pair.nearest.place;
      contact.distance = 0.5 * body.thickness + points.radius(point);
      contact.friction = body.friction;

      // Inside a facet the pseudonormal is the more accurate; on the surface there is nothing else.
      const auto   offset = x_p - pair.nearest.place;
      const double length = offset.norm();
      if (pair.nearest.region == Region::interior || length < on_surface * balls[pair.facet].radius)
        contact.normal =
          (own != 0 ? own : (minimum.side < 0 ? -1 : 1)) * minimum.pseudonormal.normal;
      else
        contact.normal = (passed(minimum) ? -1 : 1) * offset / length;
      contact.gap = offset * contact.normal;

      auto velocity = points.point_velocity(point);
      for (unsigned int k = 0; k < facet.nodes.size(); ++k)
        velocity -= contact.weights[k] * surface->nodes[facet.nodes[k]].velocity;
      const double speed =
        std::max(velocity.norm(), 0.25 * (motion.point_speed + motion.node_speed));
      if (contact.gap < contact.distance + 2 * motion.dt * speed)
        contacts.push_back(contact);
    }
}

template class LocalSearch<2>;
template class LocalSearch<3>;
} // namespace coracle::contact
