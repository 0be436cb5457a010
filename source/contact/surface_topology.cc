// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/numbers.h>

#include <coracle/contact/surface_topology.h>

#include <algorithm>
#include <cmath>
#include <tuple>

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

std::uint64_t
edge_key(const unsigned int a, const unsigned int b)
{
  return (std::uint64_t(std::min(a, b)) << 32) + std::max(a, b);
}

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
  middles.clear();
  for (unsigned int i = 0; i < s.nodes.size(); ++i)
    if (s.nodes[i].hangs())
      middles.emplace(edge_key(s.nodes[i].parents[0], s.nodes[i].parents[1]), i);
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

template <int dim>
unsigned int
SurfaceTopology<dim>::middle_of(const unsigned int a, const unsigned int b) const
{
  if (middles.empty())
    return none;
  const auto found = middles.find(edge_key(a, b));
  return found == middles.end() ? none : found->second;
}

template <int dim>
template <typename Action>
void
SurfaceTopology<dim>::on_edge(const unsigned int a,
                              const unsigned int b,
                              const double       s,
                              const Action      &action) const
{
  for (unsigned int i = begin[a]; i < begin[a + 1]; ++i)
    {
      SharedEdge edge;
      if (find_edge(surface->facets[facets[i]], a, b, edge))
        action(AtEdge{facets[i], edge.corner, edge.reversed ? 1 - s : s});
    }
}

template <int dim>
template <typename Action>
void
SurfaceTopology<dim>::at_edge(const unsigned int       f,
                              const NearestPoint<dim> &nearest,
                              const Action            &action) const
{
  const auto        &facet = surface->facets[f];
  const unsigned int end   = (nearest.feature + 1) % n_corners(facet);
  const unsigned int a = facet.nodes[nearest.feature], b = facet.nodes[end];
  const double       s = nearest.weights[end];
  on_edge(a, b, s, action);
  if (middles.empty())
    return;
  // Halves of it that smaller facets have.
  if (const unsigned int middle = middle_of(a, b); middle != none)
    {
      if (s < 0.5)
        on_edge(a, middle, 2 * s, action);
      else
        on_edge(middle, b, 2 * s - 1, action);
    }
  // The edge that it is a half of.
  for (const auto &[hanging, other, from_other] :
       {std::make_tuple(a, b, 1 - s), std::make_tuple(b, a, s)})
    if (const auto &node = surface->nodes[hanging]; node.hangs())
      for (unsigned int k = 0; k < 2; ++k)
        if (static_cast<unsigned int>(node.parents[k]) == other)
          on_edge(other, node.parents[1 - k], 0.5 * from_other, action);
}

template <int dim>
template <typename Action>
void
SurfaceTopology<dim>::at_middle(const unsigned int node, const Action &action) const
{
  if (surface->nodes[node].hangs())
    on_edge(surface->nodes[node].parents[0], surface->nodes[node].parents[1], 0.5, action);
}

// The direction into the facet at a position along its edge.
template <>
dealii::Tensor<1, 3>
SurfaceTopology<3>::inward(const AtEdge &at) const
{
  const auto        &facet = surface->facets[at.facet];
  const unsigned int n = n_corners(facet), k = at.corner;
  const auto         x = [&](const unsigned int i) { return position(facet.nodes[i % n]); };
  return (1 - at.s) * (x(k + n - 1) - x(k)) + at.s * (x(k + 2) - x(k + 1));
}

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
  const auto                   descends   = [&](const AtEdge &at) {
    if constexpr (dim == 3)
      result = result && not_downhill<3>(from_point, inward(at));
    else
      (void)at;
  };
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
      if constexpr (dim == 3)
        at_middle(node, descends);
    }
  else if constexpr (dim == 3)
    at_edge(f, nearest, descends);
  return result;
}

template <>
typename SurfaceTopology<2>::Pseudonormal
SurfaceTopology<2>::pseudonormal(const unsigned int f, const NearestPoint<2> &nearest) const
{
  const auto &facet = surface->facets[f];
  if (nearest.region == Region::interior)
    return {unit(turned(position(facet.nodes[1]) - position(facet.nodes[0]))), false};
  const unsigned int   node = facet.nodes[nearest.feature];
  dealii::Tensor<1, 2> sum;
  unsigned int         n_facets = 0;
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

template <>
typename SurfaceTopology<3>::Pseudonormal
SurfaceTopology<3>::normal_inside(const unsigned int f, const NearestPoint<3> &nearest) const
{
  const auto  &facet = surface->facets[f];
  const auto  &w     = nearest.weights;
  const double x = w[1] + w[2], y = w[2] + w[3]; // (1 + xi) / 2, (1 + eta) / 2
  const auto   p     = [&](const unsigned int k) { return position(facet.nodes[k]); };
  const bool   is_3  = (n_corners(facet) == 3);
  const auto   t_xi  = (is_3 ? p(1) - p(0) : (1 - y) * (p(1) - p(0)) + y * (p(2) - p(3)));
  const auto   t_eta = (is_3 ? p(2) - p(0) : (1 - x) * (p(3) - p(0)) + x * (p(2) - p(1)));
  return {unit(dealii::cross_product_3d(t_xi, t_eta)), false};
}

// A vertex is on the rim if one of its edges has a single facet; each inner edge is met twice:
// around an inner vertex every neighbour is once next and once previous.
template <>
typename SurfaceTopology<3>::Pseudonormal
SurfaceTopology<3>::normal_at_vertex(const unsigned int node, const unsigned int body) const
{
  dealii::Tensor<1, 3> sum;
  unsigned int         n_facets  = 0;
  long                 open      = 0;
  const auto           neighbour = [&](const unsigned int other) -> long {
    const unsigned int middle = middle_of(node, other);
    return middle == none ? other : middle;
  };
  for (unsigned int i = begin[node]; i < begin[node + 1]; ++i)
    {
      const auto &other = surface->facets[facets[i]];
      if (other.body != body)
        continue;
      const unsigned int n = n_corners(other), k = corner_of(other, node);
      const unsigned int next = other.nodes[(k + 1) % n], previous = other.nodes[(k + n - 1) % n];
      const auto         a = unit(position(next) - position(node)),
                 b         = unit(position(previous) - position(node));
      const auto normal    = dealii::cross_product_3d(a, b);
      sum += std::atan2(normal.norm(), a * b) * unit(normal);
      open += neighbour(next) - neighbour(previous);
      ++n_facets;
    }
  // A larger one fills half the plane.
  at_middle(node, [&](const AtEdge &at) {
    const auto &other = surface->facets[at.facet];
    if (other.body != body)
      return;
    const unsigned int from = other.nodes[at.corner],
                       to   = other.nodes[(at.corner + 1) % n_corners(other)];
    sum += dealii::numbers::PI *
           unit(dealii::cross_product_3d(position(to) - position(from), inward(at)));
    open += static_cast<long>(to) - static_cast<long>(from);
    ++n_facets;
  });
  return {unit(sum), !(open == 0 && n_facets > 1)};
}

template <>
typename SurfaceTopology<3>::Pseudonormal
SurfaceTopology<3>::pseudonormal(const unsigned int f, const NearestPoint<3> &nearest) const
{
  const auto &facet = surface->facets[f];
  if (nearest.region == Region::interior)
    return normal_inside(f, nearest);
  if (nearest.region == Region::vertex)
    return normal_at_vertex(facet.nodes[nearest.feature], facet.body);
  dealii::Tensor<1, 3> sum;
  unsigned int         n_facets = 0;
  at_edge(f, nearest, [&](const AtEdge &at) {
    const auto        &other = surface->facets[at.facet];
    const unsigned int end   = (at.corner + 1) % n_corners(other);
    if (other.body != facet.body)
      return;
    const auto along = position(other.nodes[end]) - position(other.nodes[at.corner]);
    sum += unit(dealii::cross_product_3d(along, inward(at)));
    ++n_facets;
  });
  return {unit(sum), n_facets < 2};
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
