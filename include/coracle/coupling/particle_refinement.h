// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/surface_distance.h>
#include <coracle/coupling/material_point_system.h>
#include <coracle/coupling/structure_system.h>
#include <coracle/particles/split_merge.h>

namespace coracle
{
/**
 * Keeps about as many particles in a cell as there were at the start, whatever its size: particles
 * too large for the cell they are in split, particles too small for it merge.
 *
 * It goes by sizes, not by numbers, so that spray does not split for being alone. Nothing passes a
 * surface by that: a child or merged particle keeps its contact distance and is nearer to where it
 * came from than any surface is; else the particle waits as it is.
 */
template <int dim>
class ParticleRefinement
{
public:
  /// Entries of `Grid/Adaptivity`.
  static void declare(Declaration &adaptivity);
  explicit ParticleRefinement(const Parameters &adaptivity);

  /**
   * Splits and merges once. Particles must be sorted, and are not afterwards. Collective.
   * @param next_id for each body, the next that is free; the same on all ranks
   * @return particles made and taken, on all ranks
   */
  std::uint64_t adapt(MaterialPointSystem<dim>   &points,
                      StructureSystem<dim>       &structure,
                      std::vector<std::uint64_t> &next_id) const;

private:
  /// Distance to surfaces from any place near this rank's particles; none where there are no
  /// structures.
  using Distance = contact::SurfaceDistance<dim>;

  struct Split
  {
    unsigned int                  row;
    typename SplitMerge<dim>::Arm arm;
  };

  double             largest_size(const MaterialPointSystem<dim> &points) const;
  std::vector<Split> find_splits(const MaterialPointBody<dim> &body,
                                 const Octree<dim>            &octree,
                                 const Distance               *distance) const;
  bool
  may_split(const MaterialPointBody<dim> &body, const Split &split, const Distance *distance) const;
  /// Of one leaf.
  std::vector<std::vector<unsigned int>> find_groups(const MaterialPointBody<dim> &body,
                                                     const Octree<dim>            &octree,
                                                     const unsigned int            leaf,
                                                     const Distance               *distance) const;
  bool                                   may_merge(const MaterialPointBody<dim>    &body,
                                                   const std::vector<unsigned int> &group,
                                                   const Distance                  *distance) const;

  /// In shares of the particles across a cell that the body has.
  double split_below, merge_above;
};
} // namespace coracle
