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
StructureWalls<dim>::update(const contact::Surface<dim>                   &surface,
                            const std::vector<int>                        &rigid_of_node,
                            const std::vector<contact::RigidUnknown<dim>> &rigid_unknowns,
                            const MPI_Comm                                 comm)
{
  rigids = rigid_unknowns;
  nodes.clear();
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    if (const auto &node = surface.nodes[i]; node.owner == static_cast<int>(mpi::rank(comm)))
      nodes.push_back(
        {node.position, node.velocity, node.inverse_mass, node.key, i, rigid_of_node[i]});
  std::vector<Simplex> mine;
  for (const auto &facet : surface.facets)
    {
      if (surface.bodies[facet.body].kind != contact::SurfaceKind::closed)
        continue;
      const auto x = [&](const unsigned int v) { return surface.nodes[facet.nodes[v]].position; };
      if constexpr (dim == 2)
        mine.push_back({x(0), x(1)});
      else
        {
          mine.push_back({x(0), x(1), x(2)});
          if (facet.nodes[3] != facet.nodes[2])
            mine.push_back({x(0), x(2), x(3)});
        }
    }
  facets.clear();
  for (const auto &some : dealii::Utilities::MPI::all_gather(comm, mine))
    facets.insert(facets.end(), some.begin(), some.end());
  for (unsigned int d = 0; d < dim; ++d)
    {
      low[d]  = std::numeric_limits<double>::max();
      high[d] = -low[d];
      for (const Simplex &facet : facets)
        for (const auto &x : facet)
          {
            low[d]  = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
          }
    }
}

template <int dim>
bool
StructureWalls<dim>::contains(const dealii::Point<dim> &x) const
{
  for (unsigned int d = 0; d < dim; ++d)
    if (x[d] < low[d] || x[d] > high[d])
      return false;
  double sum = 0;
  for (const Simplex &facet : facets)
    sum += angle(facet, x);
  return std::fabs(sum) > dealii::numbers::PI * (dim == 2 ? 1 : 2);
}

template <int dim>
bool
StructureWalls<dim>::is_nearer(const dealii::Point<dim> &x, const double reach) const
{
  for (unsigned int d = 0; d < dim; ++d)
    if (x[d] < low[d] - reach || x[d] > high[d] + reach)
      return false;
  for (const Simplex &facet : facets)
    {
      double square;
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
  for (const Simplex &facet : facets)
    for (unsigned int i = 0; i < dim; ++i)
      longest = std::max(longest, facet[i].distance(facet[(i + 1) % dim]));
  return longest;
}

template <int dim>
std::vector<typename StructureWalls<dim>::Push>
StructureWalls<dim>::sum_of_pressures(const double              *p,
                                      const std::vector<Vector> &area,
                                      const MPI_Comm             comm) const
{
  constexpr unsigned int width = dim + 3;
  std::vector<double>    sums(rigids.size() * width);
  for (unsigned int i = 0; i < nodes.size(); ++i)
    {
      const auto &node = nodes[i];
      if (node.rigid < 0)
        continue;
      double *const sum   = sums.data() + node.rigid * width;
      const Vector  force = p[i] * area[i];
      const Vector3 moment =
        dealii::cross_product_3d(in_space<dim>(node.position - rigids[node.rigid].centre),
                                 in_space<dim>(force));
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] += force[d];
      for (unsigned int d = 0; d < 3; ++d)
        sum[dim + d] += moment[d];
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), sums.size(), MPI_DOUBLE, MPI_SUM, comm);
  std::vector<Push> result(rigids.size());
  for (unsigned int r = 0; r < rigids.size(); ++r)
    {
      for (unsigned int d = 0; d < dim; ++d)
        result[r].impulse[d] = sums[r * width + d];
      for (unsigned int d = 0; d < 3; ++d)
        result[r].moment[d] = sums[r * width + dim + d];
    }
  return result;
}

template <int dim>
typename StructureWalls<dim>::Vector
StructureWalls<dim>::velocity_of(const unsigned int i, const std::vector<Push> &push) const
{
  const auto &node = nodes[i];
  if (node.rigid < 0)
    return {};
  const auto   &body = rigids[node.rigid];
  const Vector3 turn = dealii::cross_product_3d(body.inverse_inertia * push[node.rigid].moment,
                                                in_space<dim>(node.position - body.centre));
  Vector        result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] = body.inverse_mass[d] * push[node.rigid].impulse[d] + turn[d];
  return result;
}

template class StructureWalls<2>;
template class StructureWalls<3>;
} // namespace coracle::meshless
