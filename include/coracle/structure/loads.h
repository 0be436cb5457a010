// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/function.h>

#include <coracle/base/columns.h>
#include <coracle/base/exact_sum.h>
#include <coracle/base/parameters.h>
#include <coracle/mesh/structure_mesh.h>

#include <memory>
#include <vector>

namespace coracle
{
/**
 * The section `Loads` of a body: pressure that follows the surface (against the
 * outward normal of the current facet, on its current area), traction (a fixed
 * direction, on the unloaded area), and acceleration fields (force per mass).
 */
template <int dim>
class Loads
{
public:
  static void declare(Declaration &body_section);
  /// Collective. Throws UserError.
  Loads(const Parameters &body_section, const StructureMesh<dim> &mesh);

  /**
   * Add the forces at `time` to the column `external`: what this rank's facets and owned nodes
   * give, each rounded by the grid, without sums over ranks [N].
   */
  void add_forces(Columns &nodes, const double time, const SumGrid &grid) const;
  /// The largest of these, on this rank [N].
  double largest_force(const Columns &nodes, const double time) const;

private:
  enum class Kind
  {
    pressure,
    traction,
    acceleration
  };

  struct Load
  {
    Kind                                   kind;
    std::unique_ptr<dealii::Function<dim>> function;
    /// Nodes of the facets it acts on; none for an acceleration.
    std::vector<std::array<unsigned int, BoundaryFacet<dim>::n_nodes>> facets;
  };

  Load read(const Parameters &section, const StructureMesh<dim> &mesh) const;
  /// Call give(node, direction, force) for each.
  template <typename Give>
  void for_each_force(const Columns &nodes, const double time, const Give &give) const;
  template <typename Give>
  void for_each_facet_force(const Load &load, const Columns &nodes, const Give &give) const;
  template <typename Give>
  void for_each_node_force(const Load &load, const Columns &nodes, const Give &give) const;

  std::vector<Load> loads;
  unsigned int      n_owned_nodes;
};

extern template class Loads<2>;
extern template class Loads<3>;
} // namespace coracle
