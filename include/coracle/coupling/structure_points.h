// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/point_set.h>
#include <coracle/coupling/structure_system.h>

#include <vector>

namespace coracle
{
/**
 * Structure against structure: the surface nodes of structural bodies are points
 * that meet the facets of other bodies, and of their own body where that asks
 * for self contact. Both ways: each of two bodies has nodes that meet the other's
 * facets.
 *
 * A node's radius is half the thickness of its body, so that two surfaces keep
 * the mean of their thicknesses apart. Bodies without a thickness get a hundredth of
 * the smallest edge of all surfaces: at a distance of zero, corners have no normal.
 *
 * A node that several ranks have is a point on one of them. Hanging nodes are
 * none: they lie on straight edges between nodes that are.
 */
template <int dim>
class StructurePoints
{
public:
  /// No points where there is nothing to meet, or where structures shall not meet. Collective.
  StructurePoints(const bool wanted, StructureSystem<dim> &structure, MPI_Comm comm);

  /// The surface has other facets and nodes. Which sides of sheets they are on is found anew, and
  /// the distances stay as they are. Collective.
  void structure_changed(StructureSystem<dim> &structure);

  unsigned int n_sets() const { return parts.size(); }

  /// One set for each body with points, with positions and predicted velocities as they are now.
  void fill(const contact::Surface<dim>                           &surface,
            typename std::vector<contact::PointSet<dim>>::iterator set);

  /// Structures that start nearer to each other than the contact distance: a UserError. Collective.
  void refuse_initial_overlaps(const Parameters &root, StructureSystem<dim> &structure);

  /// The sides of sheets that points are on.
  void serialize(Archive &archive);

private:
  /// One body's points on this rank.
  struct Part
  {
    unsigned int                         body;
    double                               radius;
    std::vector<unsigned int>            nodes;
    std::vector<std::uint64_t>           keys;
    std::array<std::vector<double>, dim> position, velocity;
    std::vector<std::vector<double>>     side;
  };

  void make_parts(const StructureSystem<dim>  &structure,
                  const contact::Surface<dim> &surface,
                  const std::vector<bool>     &is_mine);

  MPI_Comm          comm;
  std::vector<Part> parts;
  double            smallest_edge;
};
} // namespace coracle
