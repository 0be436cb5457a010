// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/surface_topology.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// Not normalised normal spanned by a tangent (2-D) or two (3-D).
dealii::Tensor<1, 2>
turned(const dealii::Tensor<1, 2> &t)
{
  dealii::Tensor<1, 2> n;
  n[0] = t[1];
  n[1] = -t[0];
  return n;
}

template <int dim>
dealii::Tensor<1, dim>
unit(const dealii::Tensor<1, dim> &a)
{
  const double length = a.norm();
  return length > 0 ? a / length : a;
}

/// (x_c - x_p) . t >= 0 up to what round-off and edge_tolerance can spoil.
template <int dim>
bool
not_downhill(const dealii::Tensor<1, dim> &from_point, const dealii::Tensor<1, dim> &tangent)
{
  const double square = tangent.norm_square();
  return from_point * tangent >=
         -4 * edge_tolerance * square - 1e-14 * std::sqrt(square) * from_point.norm();
}

/// Corner of the facet at this node, or n_corners if it has none there.
template <int dim>
unsigned int
corner_of(const Facet<dim> &facet, const unsigned int node)
{
  const unsigned int n = n_corners(facet);
  unsigned int       k = 0;
  while (k < n && facet.nodes[k] != node)
    ++k;
  return k;
}

/// An edge of a neighbour, seen from it: start corner k, and whether it runs against the given one.
struct SharedEdge
{
  unsigned int corner;
  bool         reversed;
};

bool
find_edge(const Facet<3> &facet, const unsigned int a, const unsigned int b, SharedEdge &edge)
{
  const unsigned int n = n_corners(facet);
  for (unsigned int k = 0; k < n; ++k)
    {
      const unsigned int i = facet.nodes[k], j = facet.nodes[(k + 1) % n];
      if ((i == a && j == b) || (i == b && j == a))
        {
          edge = {k, i == b};
          return true;
        }
    }
  return false;
}
} // namespace

template <int dim>
void
SurfaceTopology<dim>::reinit(const Surface<dim> &s)
{
  surface = &s;
  begin.assign(s.nodes.size() + 1, 0);
  const auto each = [&s](const auto &action) {
    for (unsigned int f = 0; f < s.facets.size(); ++f)
      for (unsigned int k = 0; k < n_corners(s.facets[f]); ++k)
        action(s.facets[f].nodes[k], f);
  };
  each([this](const unsigned int node, const unsigned int) { ++begin[node + 1]; });
  for (unsigned int i = 0; i < s.nodes.size(); ++i)
    begin[i + 1] += begin[i];
  facets.resize(begin.back());
  std::vector<unsigned int> next(begin.begin(), begin.end() - 1);
  each([&](const unsigned int node, const unsigned int f) { facets[next[node]++] = f; });
  // Sums over the facets at a node must not depend on how facets are numbered.
  for (unsigned int i = 0; i < s.nodes.size(); ++i)
    std::sort(facets.begin() + begin[i],
              facets.begin() + begin[i + 1],
              [&s](const unsigned int a, const unsigned int b) {
                return s.facets[a].key < s.facets[b].key;
              });
}

namespace
{
/// Start of edge `feature`, its end, and the direction into the facet at position s along it.
dealii::Tensor<1, 3>
inward(const Surface<3> &surface, const Facet<3> &facet, const unsigned int corner, const double s)
{
  const unsigned int n = n_corners(facet);
  const auto x = [&](const unsigned int k) { return surface.nodes[facet.nodes[k % n]].position; };
  return (1 - s) * (x(corner + n - 1) - x(corner)) + s * (x(corner + 2) - x(corner + 1));
}

/// Facets at the edge of `nearest`: calls action(facet index, edge there, position along it).
template <typename Action>
void
at_edge(const Surface<3>                &surface,
        const std::vector<unsigned int> &begin,
        const std::vector<unsigned int> &facets,
        const unsigned int               f,
        const NearestPoint<3>           &nearest,
        const Action                    &action)
{
  const auto        &facet = surface.facets[f];
  const unsigned int end   = (nearest.feature + 1) % n_corners(facet);
  const unsigned int a = facet.nodes[nearest.feature], b = facet.nodes[end];
  const double       s = nearest.weights[end];
  for (unsigned int i = begin[a]; i < begin[a + 1]; ++i)
    {
      SharedEdge edge;
      if (find_edge(surface.facets[facets[i]], a, b, edge))
        action(facets[i], edge.corner, edge.reversed ? 1 - s : s);
    }
}
} // namespace

template <int dim>
bool
SurfaceTopology<dim>::is_minimum(const dealii::Point<dim> &x_p,
                                 const unsigned int        f,
                                 const NearestPoint<dim>  &nearest) const
{
  if (nearest.region == Region::interior)
    return true;
  const dealii::Tensor<1, dim> from_point = nearest.place - x_p;
  bool                         result     = true;
  if (nearest.region == Region::vertex)
    {
      const unsigned int node = surface->facets[f].nodes[nearest.feature];
      for (unsigned int i = begin[node]; i < begin[node + 1] && result; ++i)
        {
          const auto        &facet = surface->facets[facets[i]];
          const unsigned int n = n_corners(facet), k = corner_of(facet, node);
          for (const unsigned int other : {(k + 1) % n, (k + n - 1) % n})
            result = result &&
                     not_downhill<dim>(from_point, position(facet.nodes[other]) - position(node));
        }
    }
  else if constexpr (dim == 3)
    at_edge(*surface,
            begin,
            facets,
            f,
            nearest,
            [&](const unsigned int g, const unsigned int corner, const double s) {
              result = result &&
                       not_downhill<3>(from_point, inward(*surface, surface->facets[g], corner, s));
            });
  return result;
}

template <int dim>
typename SurfaceTopology<dim>::Pseudonormal
SurfaceTopology<dim>::pseudonormal(const unsigned int f, const NearestPoint<dim> &nearest) const
{
  const auto            &facet = surface->facets[f];
  dealii::Tensor<1, dim> sum;
  unsigned int           n_facets = 0;
  if constexpr (dim == 2)
    {
      if (nearest.region == Region::interior)
        return {unit(turned(position(facet.nodes[1]) - position(facet.nodes[0]))), false};
      const unsigned int node = facet.nodes[nearest.feature];
      for (unsigned int i = begin[node]; i < begin[node + 1]; ++i)
        {
          const auto &other = surface->facets[facets[i]];
          if (other.body != facet.body)
            continue;
          ++n_facets;
          sum += unit(turned(position(other.nodes[1]) - position(other.nodes[0])));
        }
      return {unit(sum), n_facets < 2};
    }
  else
    {
      const auto normal_at_edge = [&](const unsigned int g,
                                      const unsigned int corner,
                                      const double       s) {
        const auto        &other = surface->facets[g];
        const unsigned int n     = n_corners(other);
        if (other.body != facet.body)
          return;
        const auto along = position(other.nodes[(corner + 1) % n]) - position(other.nodes[corner]);
        sum += unit(dealii::cross_product_3d(along, inward(*surface, other, corner, s)));
        ++n_facets;
      };
      if (nearest.region == Region::edge)
        at_edge(*surface, begin, facets, f, nearest, normal_at_edge);
      else if (nearest.region == Region::interior)
        {
          const auto  &w = nearest.weights;
          const double x = w[1] + w[2], y = w[2] + w[3]; // (1 + xi) / 2, (1 + eta) / 2
          const auto   p = [&](const unsigned int k) { return position(facet.nodes[k]); };
          const auto   t_xi =
            (n_corners(facet) == 3 ? p(1) - p(0) : (1 - y) * (p(1) - p(0)) + y * (p(2) - p(3)));
          const auto t_eta =
            (n_corners(facet) == 3 ? p(2) - p(0) : (1 - x) * (p(3) - p(0)) + x * (p(2) - p(1)));
          return {unit(dealii::cross_product_3d(t_xi, t_eta)), false};
        }
      else
        {
          // A vertex is on the rim if one of its edges has a single facet; each inner edge is met
          // twice.
          const unsigned int node = facet.nodes[nearest.feature];
          long               open = 0;
          for (unsigned int i = begin[node]; i < begin[node + 1]; ++i)
            {
              const auto &other = surface->facets[facets[i]];
              if (other.body != facet.body)
                continue;
              const unsigned int n = n_corners(other), k = corner_of(other, node);
              const unsigned int next     = other.nodes[(k + 1) % n],
                                 previous = other.nodes[(k + n - 1) % n];
              const auto a                = unit(position(next) - position(node)),
                         b                = unit(position(previous) - position(node));
              const auto normal           = dealii::cross_product_3d(a, b);
              sum += std::atan2(normal.norm(), a * b) * unit(normal);
              // Around an inner vertex every neighbour is once next and once previous.
              open += static_cast<long>(next) - static_cast<long>(previous);
              n_facets += 2;
            }
          n_facets = (open == 0 && n_facets > 2 ? 2 : 1);
        }
      return {unit(sum), n_facets < 2};
    }
}

template <int dim>
bool
SurfaceTopology<dim>::same_feature(const unsigned int       facet_a,
                                   const NearestPoint<dim> &a,
                                   const unsigned int       facet_b,
                                   const NearestPoint<dim> &b) const
{
  if (a.region != b.region || a.region == Region::interior)
    return false;
  const auto        &fa = surface->facets[facet_a], &fb = surface->facets[facet_b];
  const unsigned int a0 = fa.nodes[a.feature], b0 = fb.nodes[b.feature];
  if (a.region == Region::vertex)
    return a0 == b0;
  const unsigned int a1 = fa.nodes[(a.feature + 1) % n_corners(fa)],
                     b1 = fb.nodes[(b.feature + 1) % n_corners(fb)];
  return (a0 == b0 && a1 == b1) || (a0 == b1 && a1 == b0);
}

template class SurfaceTopology<2>;
template class SurfaceTopology<3>;
} // namespace coracle::contact
