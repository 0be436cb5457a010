// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/base/columns.h>
#include <coracle/base/parameters.h>
#include <coracle/mesh/structure_mesh.h>
#include <coracle/structure/body_state.h>
#include <coracle/structure/node_columns.h>

#include <memory>
#include <string>
#include <vector>

namespace coracle
{
/**
 * What every structural body shows: its mesh, the state of its nodes, and the
 * surface that contact meets. Nodes and facets have local numbers; a node that
 * several ranks hold has one key and one owner, and is up to date on all of them.
 */
template <int dim>
class StructuralBody
{
public:
  using Vector = dealii::Tensor<1, dim>;

  const std::string   &name() const { return body_name; }
  const BodyMesh<dim> &mesh() const { return *body_mesh; }
  const Columns       &nodes() const { return node_columns; }
  Columns             &nodes() { return node_columns; }

  /// Facets of this rank's surface, see mesh/body_mesh.h for their orientation.
  const std::vector<BoundaryFacet<dim>> &facets() const { return body_mesh->facets; }
  /// Local numbers of the nodes of facets() and of those that they hang on, each once.
  const std::vector<unsigned int> &surface_nodes() const { return nodes_on_surface; }
  /// Thickness of the contact surface d [m], and Coulomb friction coefficient [1].
  double thickness() const { return surface_thickness; }
  double friction() const { return surface_friction; }

  dealii::Point<dim> position(const unsigned int node) const
  {
    return dealii::Point<dim>(vector(NodeColumns<dim>::position, node));
  }
  /// Predicted velocity at the middle of the step [m/s].
  Vector velocity(const unsigned int node) const
  {
    return vector(NodeColumns<dim>::velocity, node);
  }
  /// 1/m in each direction, 0 where the motion is prescribed [1/kg].
  Vector inverse_mass(const unsigned int node) const
  {
    return vector(NodeColumns<dim>::inverse_mass, node);
  }
  std::uint64_t key(const unsigned int node) const { return body_mesh->key(node); }
  int           owner(const unsigned int node) const { return body_mesh->owner(node); }

  /// Displacement since the start, for output [m].
  Vector displacement(const unsigned int node) const
  {
    return vector(NodeColumns<dim>::position, node) - vector(NodeColumns<dim>::reference, node);
  }
  /// Mean over the last step, of nodes that this rank owns [N].
  Vector contact_force(const unsigned int node) const
  {
    return vector(NodeColumns<dim>::contact_force, node);
  }

  /// Elements are shared out by these from the next change or sharing out on; of no effect on a
  /// body of sheets. Collective.
  void set_element_weights(const std::vector<double> &weights)
  {
    if (auto *const mesh = dynamic_cast<StructureMesh<dim> *>(body_mesh.get()))
      mesh->set_weights(weights);
  }

protected:
  /// Entries of the surface, besides the section `Mesh`.
  static void declare_surface(Declaration &body_section);
  /// Nodes are at their reference positions.
  StructuralBody(const Parameters &body, std::unique_ptr<BodyMesh<dim>> mesh);
  /// After the mesh has changed.
  void find_surface_nodes();

  /// Saves which elements there are and how they are shared out, or makes the mesh so. Collective.
  /// @return has the mesh been changed?
  static bool serialize_mesh(Archive &archive, StructureMesh<dim> &mesh);
  /// @param summed columns to which each rank has added what its elements give
  void serialize_nodes(Archive &archive, const Archive::Summed &summed);

  Vector vector(const unsigned int first_column, const unsigned int node) const
  {
    Vector result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = node_columns[first_column + d][node];
    return result;
  }
  void add_vector(const unsigned int first_column, const unsigned int node, const Vector &value)
  {
    for (unsigned int d = 0; d < dim; ++d)
      node_columns[first_column + d][node] += value[d];
  }
  void set_vector(const unsigned int first_column, const unsigned int node, const Vector &value)
  {
    for (unsigned int d = 0; d < dim; ++d)
      node_columns[first_column + d][node] = value[d];
  }

  std::string                    body_name;
  std::unique_ptr<BodyMesh<dim>> body_mesh;
  Columns                        node_columns;

private:
  std::vector<unsigned int> nodes_on_surface;
  double                    surface_thickness, surface_friction;
};

extern template class StructuralBody<2>;
extern template class StructuralBody<3>;
} // namespace coracle
