// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>
#include <coracle/mesh/structure_mesh.h>

#include <set>
#include <string>
#include <vector>

namespace coracle
{
/**
 * The part of a mesh that a boundary condition or load acts on: a boundary id,
 * a box in the unloaded configuration, or the part of the one inside the other.
 */
template <int dim>
class Selection
{
public:
  static void declare(Declaration &section);
  /// With neither of the entries given: everything, if that is allowed, otherwise a UserError.
  Selection(const Parameters &section, const bool everything_allowed);

  /// Facets (their numbers in mesh.facets) with all their nodes selected.
  std::vector<unsigned int> facets(const StructureMesh<dim> &mesh) const;
  /**
   * Local nodes: of the facets with the id, or all nodes in the box. Collective: a rank may hold a
   * node without the facet that selects it. Throws a UserError if no rank finds any.
   */
  std::vector<unsigned int> nodes(const StructureMesh<dim> &mesh) const;

private:
  bool is_inside(const dealii::Point<dim> &p) const;

  const Parameters section;
  const int        boundary_id;
  /// Lower and upper corner, a little enlarged, or nothing.
  std::vector<double> box;
};

/// Words of an entry, separated by spaces or commas, each one of those allowed; otherwise
/// UserError.
std::set<std::string> read_words(const Parameters               &section,
                                 const std::string              &entry,
                                 const std::vector<std::string> &allowed);

extern template class Selection<2>;
extern template class Selection<3>;
} // namespace coracle
