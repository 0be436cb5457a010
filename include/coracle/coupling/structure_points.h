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

  /// The surface has the same nodes and facets on other ranks: all that is known of points goes
  /// with them. Collective.
  void shared_out(StructureSystem<dim> &structure);

  unsigned int n_sets() const { return parts.size(); }

  /// Contacts of points as found for a step; sets before the first one are others'.
  void count(const std::vector<contact::Contact<dim>> &contacts, const unsigned int first_set);
  /// What was counted so far counts half from now on.
  void fade();
  /// Calls action(i, n) for all points of a body on this rank: place among its surface_nodes(), and
  /// contacts in a step, on average of late.
  template <typename Action>
  void for_each_number(const unsigned int body, const Action &action) const
  {
    if (parts.empty() || n_steps == 0)
      return;
    const Part &part = parts[body];
    for (std::size_t i = 0; i < part.nodes.size(); ++i)
      action(part.nodes[i] - part.first_node, part.n_contacts[i] / n_steps);
  }

  /// One set for each body with points, with positions and predicted velocities as they are now.
  void fill(const contact::Surface<dim>                           &surface,
            typename std::vector<contact::PointSet<dim>>::iterator set);

  /// Structures that start nearer to each other than the contact distance: a UserError. Collective.
  void refuse_initial_overlaps(const Parameters &root, StructureSystem<dim> &structure);

  /// The sides of sheets that points are on, and what was counted.
  void serialize(Archive &archive);

private:
  /// One body's points on this rank.
  struct Part
  {
    unsigned int                         body, first_node;
    double                               radius;
    std::vector<unsigned int>            nodes;
    std::vector<std::uint64_t>           keys;
    std::array<std::vector<double>, dim> position, velocity;
    std::vector<std::vector<double>>     side;
    std::vector<double>                  n_contacts;
  };

  void make_parts(const StructureSystem<dim>  &structure,
                  const contact::Surface<dim> &surface,
                  const std::vector<bool>     &is_mine);

  MPI_Comm          comm;
  std::vector<Part> parts;
  double            smallest_edge;
  /// In which contacts were counted.
  double n_steps = 0;
};
} // namespace coracle
