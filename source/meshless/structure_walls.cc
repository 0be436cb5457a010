// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/contact/nearest_point.h>
#include <coracle/meshless/structure_walls.h>

#include <algorithm>
#include <limits>

namespace coracle::meshless
{
namespace
{
/// So far around an edge the fluid must be on its facets, and so far from it its points, over the
/// spacing.
constexpr double wet_reach = 2, nearest = 0.25;
/// Cosine of the angle within which normals are those of one facet.
constexpr double same_facet = 0.866;

template <int dim>
dealii::Tensor<1, 3>
in_space(const dealii::Tensor<1, dim> &v)
{
  dealii::Tensor<1, 3> result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] = v[d];
  return result;
}

/// Signed angle (2-D) or solid angle (3-D, van Oosterom & Strackee 1983) of a facet seen from x.
double
angle(const std::array<dealii::Point<2>, 2> &facet, const dealii::Point<2> &x)
{
  const auto a = facet[0] - x, b = facet[1] - x;
  return std::atan2(a[0] * b[1] - a[1] * b[0], a * b);
}

double
angle(const std::array<dealii::Point<3>, 3> &facet, const dealii::Point<3> &x)
{
  const dealii::Tensor<1, 3> a = facet[0] - x, b = facet[1] - x, c = facet[2] - x;
  const double               A = a.norm(), B = b.norm(), C = c.norm();
  return 2 * std::atan2(a * dealii::cross_product_3d(b, c),
                        A * B * C + (a * b) * C + (b * c) * A + (c * a) * B);
}
} // namespace

template <int dim>
void
StructureWalls<dim>::update(const contact::Surface<dim>                   &published,
                            const std::vector<int>                        &rigid_of_node,
                            const std::vector<contact::RigidUnknown<dim>> &rigid_unknowns,
                            const MPI_Comm                                 comm)
{
  rigids = rigid_unknowns;
  surface.update(published, rigid_of_node, reach, comm);
  deforms = false;
  for (const auto &node : surface.nodes)
    deforms |= node.rigid < 0;
  list_nodes();
  for (unsigned int d = 0; d < dim; ++d)
    {
      low[d]  = std::numeric_limits<double>::max();
      high[d] = -low[d];
      for (const auto &facet : surface.facets)
        for (const auto &x : surface.vertices(facet))
          {
            low[d]  = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
          }
    }
}

template <int dim>
void
StructureWalls<dim>::list_nodes()
{
  nodes.clear();
  for (const int n : surface.number)
    if (n >= 0 && is_held(n))
      {
        const auto &node = surface.nodes[n];
        nodes.push_back({node.position,
                         node.velocity,
                         node.inverse_mass,
                         node.key,
                         node.rigid,
                         static_cast<unsigned int>(n)});
      }
}

template <int dim>
void
StructureWalls<dim>::hold_wet_ridges(
  const std::vector<typename StructureSurface<dim>::Place> &sliding,
  const std::vector<dealii::Point<dim>>                    &taken,
  const std::vector<unsigned char>                         &fixed,
  const MPI_Comm                                            comm)
{
  const auto &ridges = surface.ridges;
  // Of each ridge whether a point slides near on each of its facets, as far along the edge as its
  // end or farther, and whether there is a point beside that.
  std::vector<unsigned char> found(3 * ridges.size());
  for (std::size_t r = 0; r < ridges.size(); ++r)
    {
      const dealii::Point<dim> x = surface.nodes[ridges[r].node].position;
      for (const auto &place : sliding)
        for (unsigned int side = 0; side < 2; ++side)
          found[3 * r + side] |=
            place.position.distance_square(x) < std::pow(wet_reach * reach, 2) &&
            (place.position - x) * ridges[r].along > -nearest * reach &&
            place.normal * surface.normals[ridges[r].facets[side]] > same_facet;
      for (const auto &other : taken)
        found[3 * r + 2] |= other.distance_square(x) < std::pow(nearest * reach, 2);
    }
  MPI_Allreduce(MPI_IN_PLACE, found.data(), found.size(), MPI_UNSIGNED_CHAR, MPI_BOR, comm);
  dry.clear();
  for (std::size_t r = 0; r < ridges.size(); ++r)
    if (!fixed[ridges[r].node] && (!found[3 * r] || !found[3 * r + 1] || found[3 * r + 2]))
      dry.insert(surface.nodes[ridges[r].node].key);
  list_nodes();
}

template <int dim>
bool
StructureWalls<dim>::contains(const dealii::Point<dim> &x) const
{
  for (unsigned int d = 0; d < dim; ++d)
    if (x[d] < low[d] || x[d] > high[d])
      return false;
  double sum = 0;
  for (const auto &facet : surface.facets)
    sum += angle(surface.vertices(facet), x);
  return std::fabs(sum) > dealii::numbers::PI * (dim == 2 ? 1 : 2);
}

template <int dim>
bool
StructureWalls<dim>::is_nearer(const dealii::Point<dim> &x, const double reach) const
{
  for (unsigned int d = 0; d < dim; ++d)
    if (x[d] < low[d] - reach || x[d] > high[d] + reach)
      return false;
  for (const auto &nodes_of_facet : surface.facets)
    {
      const auto facet = surface.vertices(nodes_of_facet);
      double     square;
      if constexpr (dim == 2)
        square = contact::nearest_point(x, facet).distance_square;
      else
        square = contact::nearest_point_triangle(x, {facet[0], facet[1], facet[2], facet[2]})
                   .distance_square;
      if (square < reach * reach)
        return true;
    }
  return false;
}

template <int dim>
double
StructureWalls<dim>::longest_edge() const
{
  double longest = 0;
  for (const auto &facet : surface.facets)
    for (unsigned int i = 0; i < dim; ++i)
      {
        const auto &a = surface.nodes[facet[i]], &b = surface.nodes[facet[(i + 1) % dim]];
        if (!slip || (dim == 3 && a.is_sharp && b.is_sharp))
          longest = std::max(longest, a.position.distance(b.position));
      }
  return longest;
}

template <int dim>
typename StructureWalls<dim>::Carried
StructureWalls<dim>::carried(const std::size_t row, const Node &node) const
{
  Carried point{row, {}, {}};
  point.nodes.fill(node.number);
  point.weights[0] = 1;
  return point;
}

template <int dim>
typename StructureWalls<dim>::Pushes
StructureWalls<dim>::sum_of_pressures(const double               *p,
                                      const std::vector<Vector>  &area,
                                      const std::vector<Carried> &points,
                                      const MPI_Comm              comm) const
{
  constexpr unsigned int width = dim + 3;
  const std::size_t      begin = rigids.size() * width;
  std::vector<double>    sums(begin + (couples() ? dim * surface.nodes.size() : 0));
  for (const Carried &point : points)
    {
      const Vector force = p[point.row] * area[point.row];
      const int    rigid = surface.nodes[point.nodes[0]].rigid;
      if (rigid < 0 && couples())
        for (unsigned int v = 0; v < dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            sums[begin + dim * point.nodes[v] + d] += point.weights[v] * force[d];
      else if (rigid >= 0)
        {
          const Vector3 moment =
            dealii::cross_product_3d(in_space<dim>(place_of(point) - rigids[rigid].centre),
                                     in_space<dim>(force));
          for (unsigned int d = 0; d < dim; ++d)
            sums[rigid * width + d] += force[d];
          for (unsigned int d = 0; d < 3; ++d)
            sums[rigid * width + dim + d] += moment[d];
        }
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), sums.size(), MPI_DOUBLE, MPI_SUM, comm);
  Pushes result;
  result.rigid.resize(rigids.size());
  for (unsigned int r = 0; r < rigids.size(); ++r)
    {
      for (unsigned int d = 0; d < dim; ++d)
        result.rigid[r].impulse[d] = sums[r * width + d];
      for (unsigned int d = 0; d < 3; ++d)
        result.rigid[r].moment[d] = sums[r * width + dim + d];
    }
  if (couples())
    result.node.resize(surface.nodes.size());
  for (unsigned int i = 0; i < result.node.size(); ++i)
    for (unsigned int d = 0; d < dim; ++d)
      result.node[i][d] = sums[begin + dim * i + d];
  return result;
}

template <int dim>
dealii::Point<dim>
StructureWalls<dim>::place_of(const Carried &point) const
{
  dealii::Point<dim> x;
  for (unsigned int v = 0; v < dim; ++v)
    x += point.weights[v] * surface.nodes[point.nodes[v]].position;
  return x;
}

template <int dim>
typename StructureWalls<dim>::Vector
StructureWalls<dim>::velocity_of(const Carried &point, const Pushes &pushes) const
{
  Vector result;
  if (const int rigid = surface.nodes[point.nodes[0]].rigid; rigid < 0)
    {
      for (unsigned int v = 0; v < dim && !pushes.node.empty(); ++v)
        for (unsigned int d = 0; d < dim; ++d)
          result[d] += point.weights[v] * surface.nodes[point.nodes[v]].inverse_mass[d] *
                       pushes.node[point.nodes[v]][d];
    }
  else
    {
      const auto   &body = rigids[rigid];
      const Vector3 turn =
        dealii::cross_product_3d(body.inverse_inertia * pushes.rigid[rigid].moment,
                                 in_space<dim>(place_of(point) - body.centre));
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = body.inverse_mass[d] * pushes.rigid[rigid].impulse[d] + turn[d];
    }
  return result;
}

template <int dim>
typename StructureWalls<dim>::Vector
StructureWalls<dim>::velocity_of(const Carried &point) const
{
  Vector result;
  for (unsigned int v = 0; v < dim; ++v)
    result += point.weights[v] * surface.nodes[point.nodes[v]].velocity;
  return result;
}

template <int dim>
double
StructureWalls<dim>::softness(const Carried &point, const Vector &area) const
{
  double result = 0;
  for (unsigned int v = 0; v < dim; ++v)
    if (const auto &node = surface.nodes[point.nodes[v]]; node.rigid < 0)
      for (unsigned int d = 0; d < dim; ++d)
        result += point.weights[v] * area[d] * area[d] * node.inverse_mass[d];
  return result;
}

template class StructureWalls<2>;
template class StructureWalls<3>;
} // namespace coracle::meshless
