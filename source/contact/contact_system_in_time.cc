// SPDX-License-Identifier: GPL-3.0-or-later
// The continuous check of a step, on all ranks: nodes of structures in passes, then points.
#include <coracle/contact/contact_system.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coracle::contact
{
namespace
{
/// Passes in which nodes and facets go aside and rigid bodies are shortened, then passes that hold
/// them with half of their way, then passes that hold them where the step began. Each of the last
/// ones reaches the neighbours of those before, so that none are left long before there are so
/// many.
constexpr unsigned int n_aside = 10, n_half = 3, n_hold = 100;
/// How much farther facets go in each pass.
constexpr double growth = 0.5;
/// No node goes farther than this part of what candidates were looked for.
constexpr double part_of_reach = 0.5;
/// Sums over this many bits' number of displacements do not depend on their order.
constexpr int sum_bits = 12;

template <int dim>
bool
has_nodes(const std::vector<PointSet<dim>> &points)
{
  return std::any_of(points.begin(), points.end(), [](const auto &set) { return set.body >= 0; });
}

/// What rounds displacements whose sums are to be reproducible.
SumGrid
sum_grid(const bool reproducible, const double reach)
{
  return reproducible ? SumGrid(reach, sum_bits) : SumGrid();
}

template <int dim>
unsigned int
n_rigid_bodies(const Surface<dim> &surface)
{
  int n = 0;
  for (const auto &body : surface.bodies)
    n = std::max(n, body.rigid_body + 1);
  return n;
}
} // namespace

template <int dim>
double
ContactSystem<dim>::farthest_node(const Surface<dim> &owned) const
{
  double square = 0;
  for (unsigned int i = 0; i < owned.nodes.size(); ++i)
    square = std::max(square, owned.nodes[i].position.distance_square(positions_at_search[i]));
  MPI_Allreduce(MPI_IN_PLACE, &square, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return std::sqrt(square);
}

// Candidates are all that can be met only if nothing moves farther than they were looked for.
template <int dim>
void
ContactSystem<dim>::limit_travel(const Surface<dim>                        &owned,
                                 const std::vector<PointSet<dim>>          &points,
                                 const typename ContinuousCheck<dim>::Ends &ends)
{
  const double limit = std::max(0., reach - used_before - farthest_node(owned));

  double farthest = 0;
  for (unsigned int s = 0; s < points.size(); ++s)
    for (unsigned int i = 0; ends[s][0] != nullptr && i < points[s].n_points; ++i)
      {
        double way = 0;
        for (int d = 0; d < dim; ++d)
          way +=
            (ends[s][d][i] - points[s].position[d][i]) * (ends[s][d][i] - points[s].position[d][i]);
        if (way <= farthest || points[s].is_hole(i))
          continue;
        if (way > limit * limit)
          {
            const double part = limit / std::sqrt(way);
            for (int d = 0; d < dim; ++d)
              ends[s][d][i] =
                points[s].position[d][i] + part * (ends[s][d][i] - points[s].position[d][i]);
            way = limit * limit;
            ++statistics.n_held;
          }
        farthest = std::max(farthest, way);
      }
  farthest = std::sqrt(farthest);
  MPI_Allreduce(MPI_IN_PLACE, &farthest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  used = std::max(used, used_before + farthest);
}

// Two nodes come nearer to each other by what both move.
template <int dim>
unsigned long
ContactSystem<dim>::limit_travel_of_nodes(const Surface<dim> &owned)
{
  unsigned long n     = 0;
  const double  limit = part_of_reach * reach;
  if (farthest_node(owned) <= limit)
    return n;
  for (const auto &facet : owned.facets)
    for (const unsigned int i : facet.nodes)
      {
        const Vector way    = owned.nodes[i].position - positions_at_search[i];
        const double length = way.norm();
        if (length <= limit || !owned.can_move(facet.body, i))
          continue;
        ++n;
        const int    rigid = owned.bodies[facet.body].rigid_body;
        const double part  = 0.99 * limit / length;
        if (rigid < 0)
          {
            Vector back = (part - 1) * way;
            for (int d = 0; d < dim; ++d)
              back[d] = sum_grid(options.reproducible, reach).round(back[d]);
            changes.move(i, back);
          }
        else
          changes.rigid_part[rigid] = std::min(changes.rigid_part[rigid], 0.5);
      }
  return n;
}

template <int dim>
unsigned long
ContactSystem<dim>::ask_nodes(const Surface<dim>               &owned,
                              const std::vector<PointSet<dim>> &points,
                              const unsigned int                pass)
{
  const unsigned int n_rigid   = n_rigid_bodies(owned);
  const double       held_part = (pass < n_aside + n_half ? 0.5 : 0.);
  asked.reinit(surface().nodes.size(), n_rigid, held_part);
  std::vector<const Candidates *> candidate_lists;
  for (unsigned int s = 0; s < points.size(); ++s)
    candidate_lists.push_back(&search.candidates(s));
  unsigned long n[2] = {in_time.follow_nodes(surface(),
                                             points,
                                             candidate_lists,
                                             list,
                                             {facets.local_nodes_of_points(),
                                              pass == 0,
                                              pass >= n_aside,
                                              1 + growth * pass,
                                              options.reproducible ? SumGrid(reach, sum_bits)
                                                                   : SumGrid()},
                                             asked),
                        0};
  changes.reinit(owned.nodes.size(), n_rigid, held_part);
  if (pass < n_aside)
    n[1] = limit_travel_of_nodes(owned);
  MPI_Allreduce(MPI_IN_PLACE, n, 2, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
  if (n[0] > 0)
    {
      facets.add_to_owners(asked.shift, changes.shift);
      facets.add_to_owners(asked.count, changes.count);
      for (unsigned int b = 0; b < n_rigid; ++b)
        changes.rigid_part[b] = std::min(changes.rigid_part[b], asked.rigid_part[b]);
    }
  if (n_rigid > 0 && n[0] + n[1] > 0)
    MPI_Allreduce(
      MPI_IN_PLACE, changes.rigid_part.data(), n_rigid, MPI_DOUBLE, MPI_MIN, communicator);
  statistics.n_held += (n[1] > 0 && my_rank(communicator) == 0 ? n[1] : 0);
  // Too far is no failure if nothing is met.
  return pass < n_aside ? n[0] + n[1] : n[0];
}

template <int dim>
void
ContactSystem<dim>::resolve_nodes_in_time(const Surface<dim>               &owned,
                                          const std::vector<PointSet<dim>> &points,
                                          const ChangeEnds                 &change)
{
  std::vector<dealii::Point<dim>> wanted;
  bool                            any = false;
  unsigned long                   n   = 0;
  for (unsigned int pass = 0; pass <= n_aside + n_half + n_hold; ++pass)
    {
      n = ask_nodes(owned, points, pass);
      if (n == 0)
        break;
      if (!any)
        for (const auto &node : owned.nodes)
          wanted.push_back(node.position);
      any         = true;
      int changed = change(changes);
      MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_LOR, communicator);
      facets.update(owned);
      // All that can be held is held.
      if (!changed && pass >= n_aside + n_half)
        break;
    }
  if (any)
    count_changed_nodes(owned, points, wanted, n);
}

template <int dim>
void
ContactSystem<dim>::count_changed_nodes(const Surface<dim>                    &owned,
                                        const std::vector<PointSet<dim>>      &points,
                                        const std::vector<dealii::Point<dim>> &wanted,
                                        const unsigned long                    n_failed)
{
  // Rigid bodies count as one each.
  unsigned long              n = 0;
  std::vector<unsigned long> moved(n_rigid_bodies(owned));
  for (const auto &set : points)
    for (unsigned int i = 0; set.body >= 0 && i < set.n_points; ++i)
      {
        const unsigned int node  = set.surface_node[i];
        const double       shift = owned.nodes[node].position.distance(wanted[node]);
        if (shift == 0)
          continue;
        largest_node_shift = std::max(largest_node_shift, shift);
        if (const int rigid = owned.bodies[set.body].rigid_body; rigid >= 0)
          moved[rigid] = 1;
        else
          ++n;
      }
  moved.push_back(n);
  MPI_Allreduce(
    MPI_IN_PLACE, moved.data(), moved.size() - 1, MPI_UNSIGNED_LONG, MPI_MAX, communicator);
  MPI_Allreduce(MPI_IN_PLACE, &moved.back(), 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
  statistics.n_resolved += std::accumulate(moved.begin(), moved.end(), 0ul);
  statistics.n_failed += n_failed;
}

template <int dim>
void
ContactSystem<dim>::resolve_in_time(const Surface<dim>                        &owned,
                                    const std::vector<PointSet<dim>>          &points,
                                    const typename ContinuousCheck<dim>::Ends &ends,
                                    const ChangeEnds                          &change)
{
  // The papers' methods stay as they are.
  if (options.law != Law::split || options.local_search != LocalMethod::nearest_on_surface ||
      !options.continuous_check)
    return;
  facets.update(owned);
  largest_node_shift = 0;
  if (change && has_nodes(points))
    resolve_nodes_in_time(owned, points, change);
  limit_travel(owned, points, ends);
  std::vector<const Candidates *> candidate_lists;
  for (unsigned int s = 0; s < points.size(); ++s)
    candidate_lists.push_back(&search.candidates(s));
  const auto    report = in_time.resolve(surface(), points, candidate_lists, list, ends);
  unsigned long n[2]   = {report.n_resolved, report.n_failed};
  MPI_Allreduce(MPI_IN_PLACE, n, 2, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
  statistics.n_resolved += n[0];
  statistics.n_failed += n[1];
  statistics.largest_shift = std::max(report.largest_shift, largest_node_shift);
  MPI_Allreduce(MPI_IN_PLACE, &statistics.largest_shift, 1, MPI_DOUBLE, MPI_MAX, communicator);
  used += statistics.largest_shift;
}

#define INSTANTIATE(dim)                             \
  template void ContactSystem<dim>::resolve_in_time( \
    const Surface<dim> &,                            \
    const std::vector<PointSet<dim>> &,              \
    const typename ContinuousCheck<dim>::Ends &,     \
    const typename ContactSystem<dim>::ChangeEnds &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace coracle::contact
