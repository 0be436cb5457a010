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
/// Nearer than this, in facet sizes, a point is on the surface.
constexpr double off_surface = 1e-9;

/// Of the plane that leaves the corners equally far; not of unit length.
dealii::Tensor<1, 2>
mean_normal(const std::array<dealii::Point<2>, 2> &x)
{
  return dealii::cross_product_2d(x[1] - x[0]);
}

dealii::Tensor<1, 3>
mean_normal(const std::array<dealii::Point<3>, 4> &x)
{
  return dealii::cross_product_3d(x[2] - x[0], x[3] - x[1]);
}
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
      dealii::Tensor<1, dim> normal = mean_normal(x);
      const double           length = normal.norm();
      normal                        = (length > 0 ? 1 / length : 0.) * normal;
      double warp                   = 0;
      for (const auto &p : x)
        warp = std::max(warp, std::abs((p - centre) * normal));
      balls[f] = {centre, std::sqrt(square), normal, warp};
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
          const unsigned int f     = candidates.facet[k];
          const auto        &ball  = balls[f];
          const auto         way   = x - ball.centre;
          const double       reach = r + 0.5 * surface->bodies[surface->facets[f].body].thickness;
          if (way.norm_square() < (reach + ball.radius) * (reach + ball.radius) &&
              std::abs(way * ball.normal) < (reach + ball.warp) * (1 + 1e-12))
            {
              pairs.emplace_back();
              pairs.back().point = p;
              pairs.back().facet = f;
            }
        }
    }
}

template <int dim>
double
LocalSearch<dim>::reach(const PointSet<dim> &points, const Pair &pair, const double travel) const
{
  const auto &body = surface->bodies[surface->facets[pair.facet].body];
  return travel + points.radius(pair.point) + 0.5 * body.thickness;
}

template <int dim>
void
LocalSearch<dim>::arrange_pairs(const PointSet<dim> &points, const double travel)
{
  pairs.erase(std::remove_if(pairs.begin(),
                             pairs.end(),
                             [&](const Pair &pair) {
                               const double limit = reach(points, pair, travel);
                               return !(pair.nearest.distance_square < limit * limit);
                             }),
              pairs.end());
  const auto before = [this](const Pair &a, const Pair &b) {
    const auto &fa = surface->facets[a.facet], &fb = surface->facets[b.facet];
    return fa.body != fb.body ? fa.body < fb.body : fa.key < fb.key;
  };
  for (std::size_t begin = 0, end; begin < pairs.size(); begin = end)
    {
      for (end = begin + 1; end < pairs.size() && pairs[end].point == pairs[begin].point;)
        ++end;
      if (end > begin + 1)
        std::sort(pairs.begin() + begin, pairs.begin() + end, before);
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
  collect_pairs(points, candidates, motion.travel());
  switch (method)
    {
      case LocalMethod::nearest_on_surface:
        return find_on_surface(points, set, candidates, motion, contacts);
      case LocalMethod::nearest_per_facet:
        return nearest_per_facet(points, set, motion, contacts);
      case LocalMethod::perpendicular_foot:
        return perpendicular_feet(points, set, motion, contacts);
    }
}

template <int dim>
void
LocalSearch<dim>::measure_pairs(const PointSet<dim> &points, const double travel)
{
  if constexpr (dim == 2)
    {
      (void)travel;
      for (auto &pair : pairs)
        pair.nearest = nearest_point(points.point(pair.point), vertices(pair.facet));
    }
  else
    {
      quadrilaterals.clear();
      for (unsigned int i = 0; i < pairs.size(); ++i)
        if (n_corners(surface->facets[pairs[i].facet]) == 3)
          pairs[i].nearest =
            nearest_point_triangle(points.point(pairs[i].point), vertices(pairs[i].facet));
        else
          quadrilaterals.push_back(i);
      batch.find(
        quadrilaterals.size(),
        [&](const std::size_t i) {
          const auto &pair = pairs[quadrilaterals[i]];
          return relative_corners(points.point(pair.point), vertices(pair.facet));
        },
        [&](const std::size_t i, const double xi, const double eta, const double square) {
          auto        &pair  = pairs[quadrilaterals[i]];
          const double limit = reach(points, pair, travel);
          if (square < limit * limit)
            pair.nearest = describe(points.point(pair.point), vertices(pair.facet), xi, eta);
          else
            pair.nearest.distance_square = square;
        });
    }
}

template <int dim>
void
LocalSearch<dim>::find_on_surface(const PointSet<dim>       &points,
                                  const unsigned int         set,
                                  const Candidates          &candidates,
                                  const Motion              &motion,
                                  std::vector<Contact<dim>> &contacts)
{
  measure_pairs(points, motion.travel());
  arrange_pairs(points, motion.travel());

  const auto  body   = [this](const Pair &pair) { return surface->facets[pair.facet].body; };
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
            if (points.body == static_cast<int>(b))
              keep_outer_minima();
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
      // The facet with the lowest key comes first and keeps what several share.
      const bool known = std::any_of(minima.begin(), minima.end(), [&](const Minimum &other) {
        const auto  &kept = pairs[other.pair];
        const double size = same_place * (balls[kept.facet].radius + balls[pairs[i].facet].radius);
        return connections.same_feature(kept.facet, kept.nearest, pairs[i].facet, nearest) ||
               nearest.place.distance_square(kept.nearest.place) < size * size;
      });
      if (known)
        continue;
      const auto pseudonormal = connections.pseudonormal(pairs[i].facet, nearest);
      // A facet without area leaves its place to its neighbours.
      if (nearest.region == Region::interior && pseudonormal.normal.norm_square() == 0)
        continue;
      const double along = (x_p - nearest.place) * pseudonormal.normal;
      const double tiny  = 1e-12 * balls[pairs[i].facet].radius;
      const int    side  = (along > tiny ? 1 : (along < -tiny ? -1 : 0));
      minima.push_back({static_cast<unsigned int>(i), pseudonormal, side});
    }
}

template <int dim>
void
LocalSearch<dim>::keep_outer_minima()
{
  minima.erase(std::remove_if(minima.begin(),
                              minima.end(),
                              [](const Minimum &m) { return m.side < 0; }),
               minima.end());
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
  double      &kept = points.side[body.sheet][point];
  const double tiny = off_surface * balls[pair.facet].radius;
  if (nearest.pseudonormal.rim && pair.nearest.distance_square > tiny * tiny)
    {
      kept = 0;
      return 0;
    }
  if (has_passed(kept) && nearest.side * kept >= 0)
    kept = (kept < 0 ? -1 : 1); // it is back
  // Nothing passes unnoticed (audit), so a point is where it belongs, on whatever side that is: a
  // step may take it round the rim, and at a T-junction sides differ from facet to facet.
  else if (!has_passed(kept) && nearest.side != 0)
    kept = nearest.side;
  else if (kept == 0)
    {
      // On the sheet itself: the side it comes from.
      kept = (relative_velocity(points, pair) * nearest.pseudonormal.normal > 0 ? -1 : 1);
    }
  return kept < 0 ? -1 : 1;
}

template <int dim>
Contact<dim>
LocalSearch<dim>::start_contact(const PointSet<dim> &points,
                                const unsigned int   set,
                                const Pair          &pair) const
{
  const auto  &body = surface->bodies[surface->facets[pair.facet].body];
  Contact<dim> contact;
  contact.set      = set;
  contact.point    = pair.point;
  contact.facet    = pair.facet;
  contact.region   = pair.nearest.region;
  contact.weights  = pair.nearest.weights;
  contact.place    = pair.nearest.place;
  contact.distance = 0.5 * body.thickness + points.radius(pair.point);
  contact.friction = body.friction;
  return contact;
}

template <int dim>
dealii::Tensor<1, dim>
LocalSearch<dim>::relative_velocity(const PointSet<dim> &points, const Pair &pair) const
{
  auto        velocity = points.point_velocity(pair.point);
  const auto &nodes    = surface->facets[pair.facet].nodes;
  for (unsigned int k = 0; k < nodes.size(); ++k)
    velocity -= pair.nearest.weights[k] * surface->nodes[nodes[k]].velocity;
  return velocity;
}

template <int dim>
bool
LocalSearch<dim>::within_band(const PointSet<dim> &points,
                              const Pair          &pair,
                              const Motion        &motion,
                              const Contact<dim>  &contact) const
{
  const double speed = std::max(relative_velocity(points, pair).norm(),
                                0.25 * (motion.point_speed + motion.node_speed));
  return contact.gap <
         contact.distance +
           std::max(least_band * std::min(motion.radius, points.radius(contact.point)),
                    2 * motion.dt * speed);
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
  const auto        &whole   = surface->bodies[surface->facets[pairs[nearest.pair].facet].body];
  // What faces away of a closed body is hidden; a sheet has no such side unless the point passed
  // it.
  const bool one_sided =
    whole.kind == SurfaceKind::closed || has_passed(points.side[whole.sheet][point]);
  // At a rim there is no other side; a point exactly on the surface has not passed.
  const auto passed = [own, one_sided](const Minimum &m) {
    return one_sided && !m.pseudonormal.rim && m.side * own < 0;
  };

  for (const auto &minimum : minima)
    {
      if (passed(minimum) ? &minimum != &nearest : passed(nearest))
        continue;
      const auto &pair    = pairs[minimum.pair];
      auto        contact = start_contact(points, set, pair);

      // Inside a facet the pseudonormal is the more accurate; on the surface there is nothing else.
      const auto   offset = x_p - pair.nearest.place;
      const double length = offset.norm();
      if (pair.nearest.region == Region::interior || length < on_surface * balls[pair.facet].radius)
        {
          const bool by_place = (own == 0 || !one_sided) && minimum.side != 0;
          const int  side     = (by_place || own == 0 ? minimum.side : own);
          contact.normal      = (side < 0 ? -1 : 1) * minimum.pseudonormal.normal;
        }
      else
        contact.normal = (passed(minimum) ? -1 : 1) * offset / length;
      contact.gap = offset * contact.normal;

      if (contact.normal.norm_square() > 0 && within_band(points, pair, motion, contact))
        contacts.push_back(contact);
    }
}

template class LocalSearch<2>;
template class LocalSearch<3>;
} // namespace coracle::contact
