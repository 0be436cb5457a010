// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/facet_exchange.h>
#include <coracle/contact/local_search.h>
#include <coracle/contact/overlap_projection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coracle::contact
{
namespace
{
constexpr unsigned int maximum_searches = 100, sweeps_per_search = 20;
/// Remaining depth, in contact distances, at which a point counts as out.
constexpr double tolerance = 1e-9;

/// The points concerned, copied so that they can be moved about.
template <int dim>
struct Movers
{
  std::array<std::vector<double>, dim> position, velocity;
  std::vector<double>                  radius;
  std::vector<std::vector<double>>     side;

  void add(const PointSet<dim> &from, const unsigned int i, const std::size_t n_sheets)
  {
    for (int d = 0; d < dim; ++d)
      {
        position[d].push_back(from.point(i)[d]);
        velocity[d].push_back(from.point_velocity(i)[d]);
      }
    radius.push_back(from.radius(i));
    side.resize(n_sheets);
    for (std::size_t s = 0; s < n_sheets; ++s)
      side[s].push_back(from.side[s][i]);
  }

  PointSet<dim> view()
  {
    PointSet<dim> set;
    set.n_points = radius.size();
    for (int d = 0; d < dim; ++d)
      {
        set.position[d] = position[d].data();
        set.velocity[d] = velocity[d].data();
      }
    set.radius_column = radius.data();
    for (auto &column : side)
      set.side.push_back(column.data());
    return set;
  }
};

/// Move one point away from its contacts; returns the depth it had, in contact distances.
template <int dim>
double
push(Movers<dim>                                       &movers,
     typename std::vector<Contact<dim>>::const_iterator begin,
     typename std::vector<Contact<dim>>::const_iterator end,
     const double                                       length)
{
  dealii::Tensor<1, dim> move;
  double                 deepest = 0;
  for (unsigned int sweep = 0; sweep < sweeps_per_search; ++sweep)
    for (auto c = begin; c != end; ++c)
      {
        const double depth = c->distance - c->gap - c->normal * move;
        if (depth > 0)
          move += depth * c->normal;
        deepest = std::max(deepest, depth / std::max(c->distance, tolerance * length));
      }
  for (int d = 0; d < dim; ++d)
    movers.position[d][begin->point] += move[d];
  return deepest;
}

/// Diagonal of the box around all nodes.
template <int dim>
double
diameter(const Surface<dim> &surface)
{
  dealii::Point<dim> lower = surface.nodes.front().position, upper = lower;
  for (const auto &node : surface.nodes)
    for (int d = 0; d < dim; ++d)
      {
        lower[d] = std::min(lower[d], node.position[d]);
        upper[d] = std::max(upper[d], node.position[d]);
      }
  return lower.distance(upper);
}

template <int dim>
void
iterate(const Surface<dim> &surface, Movers<dim> &movers, const bool any_deep)
{
  const double      length = diameter(surface);
  GlobalSearch<dim> search;
  LocalSearch<dim>  local_search;
  local_search.reinit(surface);
  local_search.update();
  std::vector<Contact<dim>> contacts;
  double                    deepest = 1, near = 0;
  for (const double radius : movers.radius)
    near = std::max(near, 2 * radius);
  for (const auto &body : surface.bodies)
    near = std::max(near, body.thickness);
  for (unsigned int n = 0; n < maximum_searches && deepest > tolerance; ++n)
    {
      // From deep inside, the nearest face may be anywhere.
      const double                     reach = (n == 0 && any_deep) ? length : near;
      const std::vector<PointSet<dim>> sets  = {movers.view()};
      search.rebuild(surface, sets, reach);
      contacts.clear();
      local_search.find(sets[0], 0, search.candidates(0), {1., 0.5 * reach, 0.}, contacts);
      deepest = 0;
      for (auto begin = contacts.cbegin(); begin != contacts.cend();)
        {
          const auto end = std::find_if(begin, contacts.cend(), [&](const auto &c) {
            return c.point != begin->point;
          });
          deepest        = std::max(deepest, push(movers, begin, end, length));
          begin          = end;
        }
    }
}
} // namespace

template <int dim>
std::vector<Projection<dim>>
project_overlaps(const Surface<dim>               &owned,
                 const std::vector<PointSet<dim>> &points,
                 const std::vector<Overlap<dim>>  &overlaps,
                 MPI_Comm                          communicator)
{
  FacetExchange<dim> exchange(communicator);
  std::vector<Box>   everywhere(1);
  everywhere[0].lower.fill(std::numeric_limits<double>::lowest());
  everywhere[0].upper.fill(std::numeric_limits<double>::max());
  exchange.rebuild(owned, everywhere, points);

  std::vector<Projection<dim>> result;
  Movers<dim>                  movers;
  bool                         any_deep = false;
  std::size_t                  n_sheets = 0;
  for (const auto &set : points)
    n_sheets = std::max(n_sheets, set.side.size());
  for (const auto &overlap : overlaps)
    {
      any_deep = any_deep || !std::isfinite(overlap.depth);
      result.push_back({overlap.set, overlap.point, overlap.place});
    }
  if (result.empty())
    return result;
  const auto before = [](const auto &a, const auto &b) {
    return a.set != b.set ? a.set < b.set : a.point < b.point;
  };
  const auto same = [](const auto &a, const auto &b) {
    return a.set == b.set && a.point == b.point;
  };
  std::sort(result.begin(), result.end(), before);
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  for (const auto &one : result)
    movers.add(points[one.set], one.point, n_sheets);

  iterate(exchange.surface(), movers, any_deep);

  for (std::size_t i = 0; i < result.size(); ++i)
    {
      for (int d = 0; d < dim; ++d)
        result[i].place[d] = movers.position[d][i];
      for (std::size_t s = 0; s < n_sheets; ++s)
        points[result[i].set].side[s][result[i].point] = movers.side[s][i];
    }
  return result;
}

template std::vector<Projection<2>> project_overlaps(const Surface<2> &,
                                                     const std::vector<PointSet<2>> &,
                                                     const std::vector<Overlap<2>> &,
                                                     MPI_Comm);
template std::vector<Projection<3>> project_overlaps(const Surface<3> &,
                                                     const std::vector<PointSet<3>> &,
                                                     const std::vector<Overlap<3>> &,
                                                     MPI_Comm);
} // namespace coracle::contact
