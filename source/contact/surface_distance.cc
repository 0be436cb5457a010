// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/candidates.h>
#include <coracle/contact/nearest_point.h>
#include <coracle/contact/surface_distance.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
double
distance_square(const dealii::Point<2> &place, const Surface<2> &surface, const Facet<2> &facet)
{
  return nearest_point(place,
                       {surface.nodes[facet.nodes[0]].position,
                        surface.nodes[facet.nodes[1]].position})
    .distance_square;
}

double
distance_square(const dealii::Point<3> &place, const Surface<3> &surface, const Facet<3> &facet)
{
  std::array<dealii::Point<3>, 4> x;
  for (unsigned int k = 0; k < 4; ++k)
    x[k] = surface.nodes[facet.nodes[k]].position;
  return (facet.nodes[2] == facet.nodes[3] ? nearest_point_triangle(place, x)
                                           : nearest_point(place, x))
    .distance_square;
}

/// To the nearest point of a box.
template <int dim>
double
distance_square(const dealii::Point<dim> &place, const Box &box)
{
  double result = 0;
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double way = std::max({0., box.lower[d] - place[d], place[d] - box.upper[d]});
      result += way * way;
    }
  return result;
}
} // namespace

template <int dim>
void
SurfaceDistance<dim>::reinit(const Surface<dim>     &owned,
                             const std::vector<Box> &places,
                             const double            reach)
{
  std::vector<Box> reached = places;
  for (Box &box : reached)
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.lower[d] -= reach;
        box.upper[d] += reach;
      }
  exchange.rebuild(owned, reached, {});
  const auto &surface = exchange.surface();
  boxes.clear();
  for (const auto &facet : surface.facets)
    boxes.push_back(facet_box(surface, facet, 0.));
  std::vector<Box> thick = boxes;
  for (std::size_t f = 0; f < thick.size(); ++f)
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double half = 0.5 * surface.bodies[surface.facets[f].body].thickness;
        thick[f].lower[d] -= half;
        thick[f].upper[d] += half;
      }
  tree.build(thick);
  noted.assign(boxes.size(), false);
}

template <int dim>
double
SurfaceDistance<dim>::operator()(const dealii::Point<dim> &place, const double limit) const
{
  return distance(place, limit, {});
}

template <int dim>
double
SurfaceDistance<dim>::distance(const dealii::Point<dim> &place,
                               const double              limit,
                               const std::vector<bool>  &counts) const
{
  const auto &surface = exchange.surface();
  Box         around;
  for (unsigned int d = 0; d < dim; ++d)
    {
      around.lower[d] = place[d] - limit;
      around.upper[d] = place[d] + limit;
    }
  tree.find(around, found);
  double nearest = limit;
  for (const unsigned int f : found)
    {
      const auto  &facet = surface.facets[f];
      const double half  = 0.5 * surface.bodies[facet.body].thickness;
      if ((!counts.empty() && !counts[facet.body]) ||
          distance_square(place, boxes[f]) >= (nearest + half) * (nearest + half))
        continue;
      nearest = std::min(nearest, std::sqrt(distance_square(place, surface, facet)) - half);
    }
  return nearest;
}

template <int dim>
void
SurfaceDistance<dim>::note_near(const dealii::Point<dim> &place,
                                const double              limit,
                                const std::vector<bool>  &counts)
{
  const auto &surface = exchange.surface();
  Box         around;
  for (unsigned int d = 0; d < dim; ++d)
    {
      around.lower[d] = place[d] - limit;
      around.upper[d] = place[d] + limit;
    }
  tree.find(around, found);
  for (const unsigned int f : found)
    {
      const auto  &facet = surface.facets[f];
      const double reach = limit + 0.5 * surface.bodies[facet.body].thickness;
      noted[f] =
        noted[f] || (counts[facet.body] && distance_square(place, boxes[f]) < reach * reach &&
                     distance_square(place, surface, facet) < reach * reach);
    }
}

template <int dim>
std::vector<bool>
SurfaceDistance<dim>::noted_nodes(const std::size_t n_owned_nodes) const
{
  const auto                         &surface = exchange.surface();
  std::vector<dealii::Tensor<1, dim>> marks(surface.nodes.size()), owned(n_owned_nodes);
  for (std::size_t f = 0; f < noted.size(); ++f)
    if (noted[f])
      for (const unsigned int node : surface.facets[f].nodes)
        marks[node][0] = 1;
  exchange.add_to_owners(marks, owned);
  std::vector<bool> result;
  for (const auto &mark : owned)
    result.push_back(mark[0] > 0);
  return result;
}

template class SurfaceDistance<2>;
template class SurfaceDistance<3>;
} // namespace coracle::contact
