// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/local_search.h>
#include <coracle/contact/perpendicular_foot.h>
#include <coracle/contact/steepest_descent.h>

#include <limits>

/*
 * The local searches of Song, Liu & Zhang (2020) and Chen et al. (2015), each pair of point and
 * facet for itself. They know no side but where the point is now, which is why points can be lost
 * to the other side, and why neighbouring facets of a plate hinder a point that slides.
 */
namespace coracle::contact
{
namespace
{
/// Nearer to the facet than this, in facet sizes, the offset is 0/0 in Eq. 37.
constexpr double on_surface = 1e-12;

template <int dim>
using Vertices = std::array<dealii::Point<dim>, vertices_per_facet<dim>>;

/// A triangle has but one minimum, whatever finds it.
template <int dim>
NearestPoint<dim>
descend(const dealii::Point<dim> &x_p, const Vertices<dim> &vertices, const unsigned int n_corners)
{
  if constexpr (dim == 3)
    if (n_corners == 3)
      return nearest_point_triangle(x_p, vertices);
  (void)n_corners;
  return nearest_point_by_descent(x_p, vertices);
}

/// Unit normal of this facet alone at a place of it.
template <int dim>
dealii::Tensor<1, dim>
facet_normal(const SurfaceTopology<dim> &topology,
             const unsigned int          facet,
             NearestPoint<dim>           place)
{
  place.region = Region::interior;
  return topology.pseudonormal(facet, place).normal;
}
} // namespace

template <int dim>
void
LocalSearch<dim>::nearest_per_facet(const PointSet<dim>       &points,
                                    const unsigned int         set,
                                    const Motion              &motion,
                                    std::vector<Contact<dim>> &contacts)
{
  for (auto &pair : pairs)
    pair.nearest = descend<dim>(points.point(pair.point),
                                vertices(pair.facet),
                                n_corners(surface->facets[pair.facet]));
  arrange_pairs(points, motion.travel());
  for (const auto &pair : pairs)
    {
      auto       contact = start_contact(points, set, pair);
      const auto offset  = points.point(pair.point) - pair.nearest.place;
      contact.gap        = offset.norm();
      if (contact.gap > on_surface * balls[pair.facet].radius)
        contact.normal = offset / contact.gap; // Song 2020, Eq. 37
      else
        {
          // On the surface: outwards, or to the side that the point comes from.
          contact.normal   = facet_normal(connections, pair.facet, pair.nearest);
          const auto &body = surface->bodies[surface->facets[pair.facet].body];
          if (body.kind == SurfaceKind::sheet &&
              relative_velocity(points, pair) * contact.normal > 0)
            contact.normal *= -1;
        }
      if (contact.normal.norm_square() > 0 && within_band(points, pair, motion, contact))
        contacts.push_back(contact);
    }
}

template <int dim>
void
LocalSearch<dim>::perpendicular_feet(const PointSet<dim>       &points,
                                     const unsigned int         set,
                                     const Motion              &motion,
                                     std::vector<Contact<dim>> &contacts)
{
  for (auto &pair : pairs)
    if (!perpendicular_foot(points.point(pair.point), vertices(pair.facet), pair.nearest))
      pair.nearest.distance_square = std::numeric_limits<double>::max();
  arrange_pairs(points, motion.travel());
  for (const auto &pair : pairs)
    {
      const auto &body    = surface->bodies[surface->facets[pair.facet].body];
      auto        contact = start_contact(points, set, pair);
      contact.normal      = facet_normal(connections, pair.facet, pair.nearest); // Eq. 41
      contact.gap         = (points.point(pair.point) - pair.nearest.place) * contact.normal;
      const bool other_side =
        (contact.gap != 0 ? contact.gap < 0 : relative_velocity(points, pair) * contact.normal > 0);
      if (body.kind == SurfaceKind::sheet && other_side)
        {
          contact.normal *= -1;
          contact.gap *= -1;
        }
      // Deeper than its own contact distance inside a body, the far face of a thin one is meant.
      if (contact.normal.norm_square() > 0 &&
          contact.gap > -std::max(contact.distance, motion.travel()) &&
          within_band(points, pair, motion, contact))
        contacts.push_back(contact);
    }
}

template void LocalSearch<2>::nearest_per_facet(const PointSet<2> &,
                                                const unsigned int,
                                                const Motion &,
                                                std::vector<Contact<2>> &);
template void LocalSearch<3>::nearest_per_facet(const PointSet<3> &,
                                                const unsigned int,
                                                const Motion &,
                                                std::vector<Contact<3>> &);
template void LocalSearch<2>::perpendicular_feet(const PointSet<2> &,
                                                 const unsigned int,
                                                 const Motion &,
                                                 std::vector<Contact<2>> &);
template void LocalSearch<3>::perpendicular_feet(const PointSet<3> &,
                                                 const unsigned int,
                                                 const Motion &,
                                                 std::vector<Contact<3>> &);
} // namespace coracle::contact
