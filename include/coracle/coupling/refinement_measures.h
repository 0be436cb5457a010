// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/leaf_contacts.h>
#include <coracle/coupling/material_point_system.h>
#include <coracle/coupling/structure_system.h>

#include <functional>
#include <vector>

namespace coracle
{
/// What criteria of refinement look at, between steps. Particles are sorted.
template <int dim>
struct RefinementScene
{
  MaterialPointSystem<dim> &points;
  StructureSystem<dim>     &structure;
  const LeafContacts       &contacts;
  double                    time;
};

/// Calls action(other) for the leaves on the other side of the faces of a leaf, some of them
/// repeatedly.
template <int dim, typename Action>
void
for_each_face_neighbour(const Octree<dim> &octree, const unsigned int leaf, const Action &action)
{
  const double size = octree.size(leaf);
  for (int face = 0; face < 2 * dim; ++face)
    for (int part = 0; part < (1 << (dim - 1)); ++part)
      {
        dealii::Point<dim> x = octree.lower(leaf);
        // In the middle of the smallest cell that may be there.
        for (int d = 0, bit = 0; d < dim; ++d)
          x[d] += size * (d == face / 2 ? (face % 2 == 0 ? -0.25 : 1.25)
                                        : 0.25 + 0.5 * ((part >> bit++) & 1));
        if (const int other = octree.find(x); other >= 0)
          action(static_cast<unsigned int>(other));
      }
}

/// Centre and size of a leaf's parent: they follow from where the leaf is in the box.
template <int dim>
dealii::Point<dim> parent_centre(const Octree<dim> &octree, const unsigned int leaf);

/**
 * One number for each owned leaf. All are collective.
 */

/// Layers of cells between a leaf and the nearest that holds particles and has an empty neighbour;
/// those farther than n_layers have n_layers + 1.
template <int dim>
std::vector<double> layers_from_free_surface(const MaterialPointSystem<dim> &points,
                                             const unsigned int              n_layers);

/// Norm of the velocity's gradient times the cell's size, the largest of all fields [m/s]; 0 where
/// a corner has no mass.
template <int dim>
std::vector<double> velocity_jump(const MaterialPointSystem<dim> &points);

/// Largest difference of mean pressure to a face neighbour with particles [Pa].
template <int dim>
std::vector<double> pressure_jump(const MaterialPointSystem<dim> &points);
} // namespace coracle
