// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/sheet_crossing.h>

#include <algorithm>

namespace coracle::contact
{
namespace
{
/// By which part of its length the end of a way is moved aside: far above round-off, far below
/// anything else.
constexpr double askew_part = 1e-9;

/// Twice the area of a triangle, six times the volume of a tetrahedron, with its sign.
double
determinant(const dealii::Tensor<1, 2> &a, const dealii::Tensor<1, 2> &b)
{
  return a[0] * b[1] - a[1] * b[0];
}

double
determinant(const dealii::Tensor<1, 3> &a,
            const dealii::Tensor<1, 3> &b,
            const dealii::Tensor<1, 3> &c)
{
  return a * dealii::cross_product_3d(b, c);
}

dealii::Point<2>
nearest_on_simplex(const dealii::Point<2> &p, const std::array<dealii::Point<2>, 2> &x)
{
  const auto   edge  = x[1] - x[0];
  const double share = (p - x[0]) * edge / std::max(edge.norm_square(), 1e-300);
  return x[0] + std::clamp(share, 0., 1.) * edge;
}

dealii::Point<3>
nearest_on_segment(const dealii::Point<3> &p, const dealii::Point<3> &a, const dealii::Point<3> &b)
{
  const auto   edge  = b - a;
  const double share = (p - a) * edge / std::max(edge.norm_square(), 1e-300);
  return a + std::clamp(share, 0., 1.) * edge;
}

/// The foot in the plane if it is inside, else the nearest of the edges.
dealii::Point<3>
nearest_on_simplex(const dealii::Point<3> &p, const std::array<dealii::Point<3>, 3> &x)
{
  const auto   n      = dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
  const double square = n.norm_square();
  bool         inside = square > 0;
  for (unsigned int i = 0; i < 3 && inside; ++i)
    inside = n * dealii::cross_product_3d(x[(i + 1) % 3] - x[i], p - x[i]) >= 0;
  if (inside)
    return p - ((p - x[0]) * n / square) * n;
  dealii::Point<3> best = nearest_on_segment(p, x[0], x[1]);
  for (unsigned int i = 1; i < 3; ++i)
    if (const auto other = nearest_on_segment(p, x[i], x[(i + 1) % 3]);
        other.distance_square(p) < best.distance_square(p))
      best = other;
  return best;
}
} // namespace

template <int dim>
void
SheetCrossing<dim>::reinit(const Surface<dim> &s)
{
  surface = &s;
  quadrilaterals.clear();
  simplices.clear();
  sheets.clear();
  for (unsigned int f = 0; f < s.facets.size(); ++f)
    {
      const auto        &n     = s.facets[f].nodes;
      const SurfaceBody &body  = s.bodies[s.facets[f].body];
      const auto         first = simplices.size();
      Assert(body.kind == SurfaceKind::sheet && body.sheet >= 0, dealii::ExcInternalError());
      if constexpr (dim == 2)
        simplices.push_back({{n[0], n[1]}});
      else if (n[3] == n[2])
        simplices.push_back({{n[0], n[1], n[2]}});
      else
        {
          const unsigned int middle = s.nodes.size() + quadrilaterals.size();
          quadrilaterals.push_back(f);
          for (unsigned int i = 0; i < 4; ++i)
            simplices.push_back({{n[i], n[(i + 1) % 4], middle}});
        }
      sheets.insert(sheets.end(), simplices.size() - first, body.sheet);
    }
  update();
}

template <int dim>
void
SheetCrossing<dim>::update()
{
  vertices.clear();
  for (const auto &node : surface->nodes)
    vertices.push_back(node.position);
  for (const unsigned int f : quadrilaterals)
    {
      dealii::Point<dim> middle;
      for (const unsigned int node : surface->facets[f].nodes)
        middle += surface->nodes[node].position / vertices_per_facet<dim>;
      vertices.push_back(middle);
    }
  if constexpr (dim == 3)
    {
      normals.resize(simplices.size());
      for (unsigned int s = 0; s < simplices.size(); ++s)
        {
          const auto &[a, b, c] = simplices[s];
          normals[s] =
            dealii::cross_product_3d(vertices[b] - vertices[a], vertices[c] - vertices[a]);
        }
    }
  boxes.assign(simplices.size(), Box());
  for (unsigned int s = 0; s < simplices.size(); ++s)
    for (int d = 0; d < dim; ++d)
      {
        boxes[s].lower[d] = boxes[s].upper[d] = vertices[simplices[s][0]][d];
        for (const unsigned int v : simplices[s])
          {
            boxes[s].lower[d] = std::min(boxes[s].lower[d], vertices[v][d]);
            boxes[s].upper[d] = std::max(boxes[s].upper[d], vertices[v][d]);
          }
      }
}

template <int dim>
void
SheetCrossing<dim>::within(const Box                 &around,
                           const List                &list,
                           std::vector<unsigned int> &result) const
{
  result.clear();
  for (const unsigned int s : list)
    if (overlap(around, boxes[s]))
      result.push_back(s);
}

template <int dim>
std::uint64_t
SheetCrossing<dim>::between(const dealii::Point<dim> &p,
                            const dealii::Point<dim> &end,
                            const List               &list) const
{
  // A little askew, so that symmetric scenes have no ways exactly through vertices and edges, where
  // round-off would decide.
  dealii::Point<dim> q       = end;
  const double       askew[] = {1., 0.6180339887, -0.3247179572};
  for (int d = 0; d < dim; ++d)
    q[d] += askew_part * askew[d] * p.distance(end);

  Box way;
  for (int d = 0; d < dim; ++d)
    {
      way.lower[d] = std::min(p[d], q[d]);
      way.upper[d] = std::max(p[d], q[d]);
    }
  std::uint64_t result = 0;
  for (const unsigned int s : list)
    if (overlap(way, boxes[s]) && meets(p, q, s))
      result ^= std::uint64_t(1) << (sheets[s] % 64);
  return result;
}

template <>
bool
SheetCrossing<2>::meets(const dealii::Point<2> &p,
                        const dealii::Point<2> &q,
                        const unsigned int      s) const
{
  const auto &a = vertices[simplices[s][0]], &b = vertices[simplices[s][1]];
  const auto  left = [&](const dealii::Point<2> &x) { return determinant(q - p, x - p) >= 0; };
  const auto  side = [&](const dealii::Point<2> &x) { return determinant(b - a, x - a) >= 0; };
  return left(a) != left(b) && side(p) != side(q);
}

template <>
bool
SheetCrossing<3>::meets(const dealii::Point<3> &p,
                        const dealii::Point<3> &q,
                        const unsigned int      s) const
{
  const auto &x    = simplices[s];
  const auto  side = [&](const dealii::Point<3> &y) {
    return normals[s] * (y - vertices[x[0]]) >= 0;
  };
  if (side(p) == side(q))
    return false;
  // The way passes all edges on the same side; an edge is always taken from its lower number.
  unsigned int n_left = 0;
  for (unsigned int i = 0; i < 3; ++i)
    {
      const unsigned int from = std::min(x[i], x[(i + 1) % 3]), to = std::max(x[i], x[(i + 1) % 3]);
      const bool         left = determinant(q - p, vertices[from] - p, vertices[to] - p) >= 0;
      n_left += (left == (from == x[i]));
    }
  return n_left == 0 || n_left == 3;
}

template <int dim>
bool
SheetCrossing<dim>::is_near(const dealii::Point<dim> &p,
                            const unsigned int        s,
                            const double              distance) const
{
  bool result = true;
  for (int d = 0; d < dim; ++d)
    result = result && p[d] > boxes[s].lower[d] - distance && p[d] < boxes[s].upper[d] + distance;
  return result;
}

template <int dim>
dealii::Point<dim>
SheetCrossing<dim>::nearest_point(const dealii::Point<dim> &p, const unsigned int s) const
{
  std::array<dealii::Point<dim>, dim> x;
  for (int v = 0; v < dim; ++v)
    x[v] = vertices[simplices[s][v]];
  return nearest_on_simplex(p, x);
}

template <int dim>
dealii::Tensor<1, dim>
SheetCrossing<dim>::normal(const unsigned int s) const
{
  dealii::Tensor<1, dim> n;
  const auto            &a = vertices[simplices[s][0]], &b = vertices[simplices[s][1]];
  if constexpr (dim == 2)
    n = dealii::cross_product_2d(b - a);
  else
    n = dealii::cross_product_3d(b - a, vertices[simplices[s][2]] - a);
  return n / std::max(n.norm(), 1e-300);
}

template class SheetCrossing<2>;
template class SheetCrossing<3>;
} // namespace coracle::contact
