// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/audit_cut.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
// All in sizes of a facet. Errors of round-off in places are well below `doubt`; a path is thought
// moved out of doubt by up to `largest_shift`; nearer than `on_at_end` a point is on the surface,
// and is then thought moved off it by `step_off`. What was on it at the end of a step must also be
// so at the start of the next, where bilinear facets are cut in another way.
constexpr double doubt = 2e-11, smallest_shift = 1e-9, largest_shift = 3e-9, on_at_end = 4e-9,
                 on_at_start = 8e-9, step_off = 2e-8;
constexpr std::array<double, 2> on = {{on_at_start, on_at_end}};
/// A point on the surface is thought moved off all that is nearer than this: the other side of a
/// narrow valley, too.
constexpr double beside = 4e-8;
/// A touch is no deeper than this.
constexpr double depth_of_touch = 4e-9;
/// Lengths that are smaller than this part of coordinates or of the path are lost in round-off.
constexpr double relative_size = 1e-3;
/// How many ways to be out of doubt are tried.
constexpr unsigned int n_shifts = 16;

/// Directions in general position.
template <int dim>
dealii::Tensor<1, dim>
direction(const unsigned int i)
{
  dealii::Tensor<1, dim> result;
  for (int d = 0; d < dim; ++d)
    result[d] = std::cos(1.7 + 2.3 * i + 2.1 * d + 0.37 * i * d);
  return result / result.norm();
}

template <int dim>
bool
neighbours(const MovingFacet<dim> &a, const MovingFacet<dim> &b)
{
  return std::any_of(a.nodes.begin(), a.nodes.end(), [&b](const unsigned int node) {
    return std::find(b.nodes.begin(), b.nodes.end(), node) != b.nodes.end();
  });
}
} // namespace

template <int dim>
void
PathAudit<dim>::begin(const Path<dim> &p)
{
  path   = p;
  length = p[0].distance(p[1]);
  near.clear();
}

template <int dim>
void
PathAudit<dim>::add(const MovingFacet<dim> &facet)
{
  const audit_cut::Extent<dim> extent[2] = {audit_cut::Extent<dim>(facet.x[0]),
                                            audit_cut::Extent<dim>(facet.x[1])};
  std::array<double, 2>        size{};
  for (unsigned int t = 0; t < 2; ++t)
    for (int d = 0; d < dim; ++d)
      size[t] =
        std::max({size[t],
                  extent[t].upper[d] - extent[t].lower[d],
                  relative_size * std::max(std::abs(extent[t].lower[d]), extent[t].upper[d])});
  if (audit_cut::far_apart(path,
                           extent[0],
                           extent[1],
                           audit_cut::room * std::max(size[0], size[1]) + largest_shift * length))
    return;
  near.push_back(facet);
  near.back().size = size;
  for (unsigned int t = 0; t < 2; ++t)
    near.back().may_touch[t] = extent[t].holds(path[t], 2 * beside * size[t]);
}

/// Finds the simplices that an end of the path is on, and if there are any, those beside it.
template <int dim>
void
PathAudit<dim>::touch(const unsigned int end)
{
  touched.clear();
  for (unsigned int f = 0; f < near.size(); ++f)
    if (near[f].may_touch[end])
      audit_cut::for_each_simplex(path, near[f], [&](const MovingSimplex<dim> &simplex) {
        const auto  &x      = simplex[end];
        const double size   = near[f].size[end];
        const auto   normal = normal_if_on<dim>(path[end], x, beside * size);
        if (normal.norm_square() == 0)
          return;
        auto inward = -path[end];
        for (const auto &v : x)
          inward += v / dim;
        const bool is_on = normal_if_on<dim>(path[end], x, on[end] * size).norm_square() > 0;
        touched.push_back({normal,
                           inward / std::max(inward.norm(), 1e-300),
                           f,
                           is_on,
                           (path[end] - x[0]) * normal});
      });
  std::stable_partition(touched.begin(), touched.end(), [](const Touched &one) {
    return one.is_on;
  });
  if (!touched.empty() && !touched[0].is_on)
    touched.clear();
}

/// The side that the point belongs to.
template <int dim>
int
PathAudit<dim>::side_of_touched() const
{
  dealii::Tensor<1, dim> normal;
  for (const auto &one : touched)
    if (one.is_on)
      normal += one.normal;
  const auto &facet = near[touched[0].facet];
  return ((path[1] - path[0]) - (facet.x[1][0] - facet.x[0][0])) * normal > 0 ? -1 : 1;
}

/// From an end of the path to where the point is thought to be.
template <int dim>
dealii::Tensor<1, dim>
PathAudit<dim>::way_off(const unsigned int end, const int known_side)
{
  touch(end);
  dealii::Tensor<1, dim> way;
  if (touched.empty())
    return way;
  const int side = (known_side != 0 ? known_side : side_of_touched());
  // What is beside the point but looks away, as the back of a thin body does, is in nobody's way.
  touched.erase(std::remove_if(touched.begin(),
                               touched.end(),
                               [side](const Touched &one) {
                                 return !one.is_on && side * one.height <= 0;
                               }),
                touched.end());
  double size = std::numeric_limits<double>::max();
  for (const auto &one : touched)
    {
      way += one.normal;
      size = std::min(size, near[one.facet].size[end]);
    }
  way *= side;
  // Away from all of these simplices, or else, where that leads into the body (saddles, folds),
  // along and above one of them.
  double lowest = std::numeric_limits<double>::max();
  for (const auto &one : touched)
    lowest = std::min(lowest, side * (one.normal * way) / std::max(way.norm(), 1e-300));
  // The tip of a needle is no fold: its facets look away from each other, and ahead of it is free.
  const bool valley = in_valley(side);
  if (lowest < 0.02 && (valley || way.norm() < 1e-6))
    {
      const auto best =
        std::max_element(touched.begin(), touched.end(), [&](const Touched &a, const Touched &b) {
          return side * (a.normal * way) < side * (b.normal * way);
        });
      way    = side * best->normal + best->inward;
      lowest = std::sqrt(0.5);
    }
  // Farther in a valley, so as to be off its slopes.
  else if (!valley)
    lowest = 1;
  return step_off * size / (lowest * way.norm()) * way;
}

/// Does one of the simplices that the point is on rise above another, seen from this side?
template <int dim>
bool
PathAudit<dim>::in_valley(const int side) const
{
  for (const auto &a : touched)
    for (const auto &b : touched)
      if (side * (a.normal * b.inward) > 1e-6)
        return true;
  return false;
}

/// Meetings with all facets, in the order of time; false where one is in doubt.
template <int dim>
bool
PathAudit<dim>::meet_all(const Path<dim> &moved, const double doubtful_length)
{
  bool sure = true;
  events.clear();
  for (unsigned int f = 0; f < near.size(); ++f)
    audit_cut::for_each_simplex(moved, near[f], [&](const MovingSimplex<dim> &simplex) {
      sure &= meet_simplex<dim>(moved, simplex, doubtful_length, f, events);
    });
  if (events.size() > 1)
    std::sort(events.begin(), events.end(), [](const auto &a, const auto &b) {
      return a.time < b.time;
    });
  return sure;
}

/// Is the path, between these meetings, as near as that to the plane of one of them?
template <int dim>
bool
stays_near(const Path<dim>      &path,
           const PathEvent<dim> &a,
           const PathEvent<dim> &b,
           const double          distance)
{
  // One time would not do: a path may come back to the planes half-way.
  const std::array<double, 3> parts = {{0.21, 0.5, 0.73}};
  return std::all_of(parts.begin(), parts.end(), [&](const double part) {
    const double time = a.time + part * (b.time - a.time);
    return std::min(std::abs(distance_from_plane<dim>(path, a.simplex, time)),
                    std::abs(distance_from_plane<dim>(path, b.simplex, time))) <= distance;
  });
}

/// What goes through and comes back at the same place and no deeper has only touched.
template <int dim>
void
PathAudit<dim>::drop_touches(const Path<dim> &moved, const double depth)
{
  std::size_t kept = 0;
  for (const auto &event : events)
    if (kept > 0 && events[kept - 1].direction != event.direction &&
        neighbours(near[events[kept - 1].facet], near[event.facet]) &&
        stays_near<dim>(moved, events[kept - 1], event, depth))
      --kept;
    else
      events[kept++] = event;
  events.resize(kept);
}

template <int dim>
const std::vector<PathEvent<dim>> &
PathAudit<dim>::meetings(const int side)
{
  events.clear();
  if (near.empty())
    return events;
  double size = std::numeric_limits<double>::max();
  for (const auto &facet : near)
    size = std::min({size, facet.size[0], facet.size[1]});
  size                  = std::max(size, relative_size * length);
  const Path<dim> ends  = {{path[0] + way_off(0, side), path[1] + way_off(1, side)}};
  Path<dim>       moved = ends;
  if (meet_all(moved, doubt * size))
    return events;
  // If it stays in doubt, what is found most often.
  most.clear();
  for (unsigned int i = 0; i < n_shifts; ++i)
    {
      const double distance =
        (smallest_shift + (largest_shift - smallest_shift) * i / n_shifts) * size;
      moved = {{ends[0] + distance * direction<dim>(i), ends[1] + distance * direction<dim>(i)}};
      const bool sure = meet_all(moved, doubt * size);
      drop_touches(moved, depth_of_touch * size);
      if (sure)
        return events;
      if (events.size() > most.size())
        most = events;
    }
  return most;
}

template class PathAudit<2>;
template class PathAudit<3>;
} // namespace coracle::contact
