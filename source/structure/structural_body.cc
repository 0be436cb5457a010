// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/key_directory.h>
#include <coracle/structure/structural_body.h>

#include <algorithm>

namespace coracle
{
template <int dim>
void
StructuralBody<dim>::declare_surface(Declaration &section)
{
  section.quantity("Thickness",
                   "0",
                   "m",
                   "d",
                   "of the contact surface: points are kept d/2 and their own radius away",
                   0.);
  section.quantity("Friction", "0", "1", "mu", "Coulomb friction coefficient against points", 0.);
  section.list("Initial velocity", "", "m/s", "v_0", "at time zero; zero if empty");
}

template <int dim>
StructuralBody<dim>::StructuralBody(const Parameters              &body,
                                    std::unique_ptr<BodyMesh<dim>> mesh_of_body)
  : body_name(body.name())
  , body_mesh(std::move(mesh_of_body))
  , node_columns(NodeColumns<dim>::n_columns)
  , surface_thickness(body.quantity("Thickness"))
  , surface_friction(body.quantity("Friction"))
{
  const auto &mesh = *body_mesh;
  node_columns.resize(mesh.n_nodes());
  for (unsigned int n = 0; n < mesh.n_nodes(); ++n)
    {
      set_vector(NodeColumns<dim>::reference, n, mesh.nodes[n]);
      set_vector(NodeColumns<dim>::position, n, mesh.nodes[n]);
    }
  find_surface_nodes();
}

template <int dim>
void
StructuralBody<dim>::find_surface_nodes()
{
  std::vector<bool> is_there(body_mesh->n_nodes());
  for (const auto &facet : body_mesh->facets)
    for (const unsigned int node : facet.nodes)
      is_there[node] = true;
  std::vector<bool> with_parents = is_there;
  for (const HangingNode &hanging : body_mesh->hanging_nodes)
    if (is_there[hanging.node])
      for (const auto &[parent, weight] : hanging.parents)
        with_parents[parent] = true;
  nodes_on_surface.clear();
  for (unsigned int node = 0; node < body_mesh->n_nodes(); ++node)
    if (with_parents[node])
      nodes_on_surface.push_back(node);
}

template <int dim>
void
StructuralBody<dim>::serialize_nodes(Archive &archive, const Archive::Summed &summed)
{
  std::vector<std::uint64_t> keys;
  for (unsigned int n = 0; n < body_mesh->n_nodes(); ++n)
    keys.push_back(body_mesh->key(n));
  archive.keyed("nodes", keys, body_mesh->n_owned_nodes(), node_columns, summed);
}

template <int dim>
bool
StructuralBody<dim>::serialize_mesh(Archive &archive, StructureMesh<dim> &mesh)
{
  std::vector<std::uint64_t> keys     = mesh.element_keys;
  std::vector<double>        weights  = mesh.weights();
  bool                       weighted = mesh.is_weighted();
  archive.in_order("element_keys", keys);
  // Earlier checkpoints know no weights.
  if (archive.has("element_weights"))
    {
      archive.same("weighted", weighted);
      archive.in_order("element_weights", weights);
    }
  if (!archive.loads())
    return false;
  weights.resize(keys.size(), 1.);

  Columns saved(1);
  saved.resize(keys.size());
  std::copy(weights.begin(), weights.end(), saved[0]);
  KeyDirectory elements(1, mesh.communicator());
  elements.add(keys, saved);
  const unsigned int before = mesh.n_changes();
  Columns            found(1);
  mesh.refine_to([&](const std::vector<std::uint64_t> &of_mesh) {
    found.resize(of_mesh.size());
    return elements.find(of_mesh, found);
  });
  if (weighted)
    {
      mesh.set_weights(std::vector<double>(found[0], found[0] + found.size()));
      Columns           no_node_columns, no_element_columns;
      CarriedState<dim> nothing{no_node_columns, no_element_columns, {}};
      mesh.share_out(nothing);
    }
  return mesh.n_changes() > before;
}

template class StructuralBody<2>;
template class StructuralBody<3>;
} // namespace coracle
