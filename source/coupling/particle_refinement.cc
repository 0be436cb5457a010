// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/particle_refinement.h>

#include <algorithm>
#include <optional>

namespace coracle
{
namespace
{
template <int dim>
using Layout = ParticleLayout<dim>;

/// A group may have this many times 2^dim particles.
constexpr double largest_group = 1.5;
/// In particle sizes: contact distances are kept but for round-off.
constexpr double touching = 1e-9;
} // namespace

template <int dim>
void
ParticleRefinement<dim>::declare(Declaration &adaptivity)
{
  adaptivity.quantity("Split below",
                      "0.7",
                      "1",
                      "",
                      "Particles split where a cell has fewer of their size across it than this "
                      "share of what the body has "
                      "(its `Particles across a cell`); 0: never.",
                      0.,
                      0.99);
  adaptivity.quantity("Merge above",
                      "1.5",
                      "1",
                      "",
                      "Particles merge where a cell has more of their size across it than this "
                      "share of what the body has; 0: never.",
                      0.);
}

template <int dim>
ParticleRefinement<dim>::ParticleRefinement(const Parameters &adaptivity)
  : split_below(adaptivity.quantity("Split below")), merge_above(adaptivity.quantity("Merge above"))
{
  if (merge_above == 0)
    merge_above = std::numeric_limits<double>::infinity();
  // A particle of a full group of two levels must not split again, nor a child merge.
  if (merge_above < 1.01 || merge_above < 1.5 * split_below)
    throw adaptivity.error("Merge above",
                           "particles would split and merge in turn",
                           std::to_string(merge_above) +
                             " with Split below = " + std::to_string(split_below),
                           "choose at least 1.01, and 1.5 times Split below");
}

template <int dim>
double
ParticleRefinement<dim>::largest_size(const MaterialPointSystem<dim> &points) const
{
  double size = 0;
  for (const auto &body : points.bodies)
    for (std::size_t row = 0; row < body.points.n_rows(); ++row)
      size =
        std::max(size,
                 body.points.column(Layout<dim>::size)[row] * std::max(1., body.radius_factor));
  return mpi::max(size, points.octree.triangulation.get_communicator());
}

template <int dim>
bool
ParticleRefinement<dim>::may_split(const MaterialPointBody<dim> &body,
                                   const Split                  &split,
                                   const Distance               *distance) const
{
  const double size = body.points.column(Layout<dim>::size)[split.row];
  // The turning of a particle next to a face of the box does not fit into fewer directions.
  if (body.points.layout().affine >= 0)
    for (int d = 0; d < dim; ++d)
      if (split.arm[d] < 0.25 * size)
        return false;
  if (distance == nullptr)
    return true;
  const double             radius = 0.5 * body.radius_factor * size, reach = split.arm.norm();
  const dealii::Point<dim> x    = body.points.position(split.row);
  const double             free = (*distance)(x, reach + radius);
  if (free >= reach + radius)
    return true;
  if (free <= reach)
    return false;
  for (unsigned int k = 0; k < SplitMerge<dim>::n_children; ++k)
    if ((*distance)(SplitMerge<dim>::child_place(x, split.arm, k), radius) <
        radius - touching * size)
      return false;
  return true;
}

template <int dim>
std::vector<typename ParticleRefinement<dim>::Split>
ParticleRefinement<dim>::find_splits(const MaterialPointBody<dim> &body,
                                     const Octree<dim>            &octree,
                                     const Distance               *distance) const
{
  std::vector<Split> result;
  const auto        &points = body.points;
  for (const unsigned int leaf : points.occupied_cells())
    for (unsigned int row = points.cell_begin()[leaf]; row < points.cell_begin()[leaf + 1]; ++row)
      if (!points.is_hole(row) && octree.size(leaf) < split_below * body.particles_across *
                                                        points.column(Layout<dim>::size)[row])
        {
          const Split split{row, SplitMerge<dim>::arm(points, row, octree.box())};
          if (may_split(body, split, distance))
            result.push_back(split);
        }
  return result;
}

template <int dim>
bool
ParticleRefinement<dim>::may_merge(const MaterialPointBody<dim>    &body,
                                   const std::vector<unsigned int> &group,
                                   const Distance                  *distance) const
{
  if (distance == nullptr)
    return true;
  const auto        &points = body.points;
  dealii::Point<dim> place;
  double             mass = 0, box = 0, farthest = 0;
  for (const unsigned int row : group)
    {
      const double m = points.column(Layout<dim>::mass)[row];
      mass += m;
      place += m * points.position(row);
      box += std::pow(points.column(Layout<dim>::size)[row], dim);
    }
  place /= mass;
  for (const unsigned int row : group)
    farthest = std::max(farthest, place.distance(points.position(row)));
  const double needed = std::max(1.01 * farthest, body.radius_factor * std::pow(box, 1. / dim));
  return (*distance)(place, needed) >= needed;
}

template <int dim>
std::vector<std::vector<unsigned int>>
ParticleRefinement<dim>::find_groups(const MaterialPointBody<dim> &body,
                                     const Octree<dim>            &octree,
                                     const unsigned int            leaf,
                                     const Distance               *distance) const
{
  // Particles in one of the boxes that the merged ones will fill, and on the same side of sheets;
  // by place, so that the order does not depend on ranks.
  struct Member
  {
    std::vector<double> key;
    unsigned int        row;
    bool                operator<(const Member &other) const { return key < other.key; }
  };
  const auto         &points = body.points;
  const double        size = octree.size(leaf), n = std::max(1., std::round(body.particles_across));
  const int           n_sheets = points.layout().n_sheets;
  std::vector<Member> members;
  for (unsigned int row = points.cell_begin()[leaf]; row < points.cell_begin()[leaf + 1]; ++row)
    if (!points.is_hole(row) &&
        size > merge_above * body.particles_across * points.column(Layout<dim>::size)[row])
      {
        members.push_back({{}, row});
        auto                    &key = members.back().key;
        const dealii::Point<dim> x   = points.position(row);
        for (int d = 0; d < dim; ++d)
          key.push_back(std::floor(std::min((x[d] - octree.lower(leaf)[d]) / size * n, n - 0.5)));
        for (int s = 0; s < n_sheets; ++s)
          key.push_back(points.column(points.layout().side + s)[row]);
        for (int d = 0; d < dim; ++d)
          key.push_back(x[d]);
      }
  std::sort(members.begin(), members.end());

  std::vector<std::vector<unsigned int>> result;
  const auto                             same_box = [&](const Member &a, const Member &b) {
    return std::equal(a.key.begin(), a.key.begin() + dim + n_sheets, b.key.begin());
  };
  const std::size_t most = static_cast<std::size_t>(largest_group * (1 << dim));
  for (std::size_t first = 0, last; first < members.size(); first = last)
    {
      last = first + 1;
      while (last < members.size() && same_box(members[first], members[last]))
        ++last;
      // As many as are too many for one make several.
      const std::size_t n_groups = (last - first + most - 1) / most;
      for (std::size_t g = 0; g < n_groups; ++g)
        {
          std::vector<unsigned int> group;
          for (std::size_t i = first + (last - first) * g / n_groups;
               i < first + (last - first) * (g + 1) / n_groups;
               ++i)
            group.push_back(members[i].row);
          if (group.size() > 1 && may_merge(body, group, distance))
            result.push_back(group);
        }
    }
  return result;
}

template <int dim>
std::uint64_t
ParticleRefinement<dim>::adapt(MaterialPointSystem<dim>   &points,
                               StructureSystem<dim>       &structure,
                               std::vector<std::uint64_t> &next_id) const
{
  const auto             &octree = points.octree;
  const MPI_Comm          comm   = octree.triangulation.get_communicator();
  std::optional<Distance> distance;
  if (!structure.empty())
    {
      distance.emplace(comm);
      std::vector<contact::Box> places;
      if (octree.n_owned_leaves() > 0)
        {
          const auto region = octree.owned_region();
          places.emplace_back();
          for (int d = 0; d < dim; ++d)
            {
              places.back().lower[d] = region.lower_bound(d);
              places.back().upper[d] = region.upper_bound(d);
            }
        }
      // Merged particles are twice as large, or somewhat more.
      distance->reinit(structure.publish_surface(), places, 4 * largest_size(points));
    }
  const Distance *const to_surface = distance ? &*distance : nullptr;

  std::uint64_t changes = 0;
  unsigned int  b       = 0;
  for (auto &body : points.bodies)
    {
      SplitMerge<dim>     split_merge(body.points);
      const auto          splits = find_splits(body, octree, to_surface);
      const std::uint64_t n_new  = splits.size() * (SplitMerge<dim>::n_children - 1);
      std::uint64_t       id     = next_id[b] + mpi::offset(n_new, comm);
      next_id[b] += mpi::sum(n_new, comm);
      const std::uint64_t before = body.points.ledger.merged;
      if (std::isfinite(merge_above))
        for (const unsigned int leaf : body.points.occupied_cells())
          if (const auto groups = find_groups(body, octree, leaf, to_surface); !groups.empty())
            split_merge.merge(groups);
      for (const Split &split : splits)
        {
          split_merge.split(split.row, split.arm, id);
          id += SplitMerge<dim>::n_children - 1;
        }
      points.book_split_merge(body, split_merge.lost_energy_sum());
      changes += n_new + body.points.ledger.merged - before;
      ++b;
    }
  return mpi::sum(changes, comm);
}

template class ParticleRefinement<2>;
template class ParticleRefinement<3>;
} // namespace coracle
