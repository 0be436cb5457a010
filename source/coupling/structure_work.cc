// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/coupling/structure_work.h>

namespace coracle
{
namespace
{
/// Over an element of full integration, in space: one with one point, a facet with its nodes, an
/// element of a rigid body.
constexpr double of_one_point = 0.5, of_facet = 0.6, of_rigid_element = 0.05;
} // namespace

template <int dim>
void
StructureWork<dim>::declare(Declaration &load_balance)
{
  load_balance.quantity(
    "Work of an element",
    "5",
    "1",
    "",
    "Of a solid's element with full integration over that of a particle, in a step; "
    "with one point it is half of it, of a facet 0.6, of an element of a rigid body 0.05.",
    0.);
}

template <int dim>
StructureWork<dim>::StructureWork(const Parameters &root)
{
  const Parameters load   = root.section("Grid").section("Load balance"),
                   bodies = root.section("Bodies");
  element_weight          = load.quantity("Work of an element");
  contact_weight          = load.quantity("Work of a contact");
  may_move                = root.section("Contact").choice("Method") == "surface";
  for (const std::string &name : bodies.section_names())
    may_move = may_move && bodies.section(name).choice("Kind") != "meshless fluid";
}

// A node that ranks share is a point at the lowest of them, which has the first of its elements.
template <int dim>
std::vector<double>
StructureWork<dim>::of_body(const StructuralBody<dim>  &body,
                            const StructurePoints<dim> &points,
                            const unsigned int          index,
                            const double                weight) const
{
  // Weights must not be nothing.
  constexpr double       least     = 1e-3;
  constexpr unsigned int none      = -1;
  const auto            &mesh      = body.mesh();
  const unsigned int     n_corners = 1u << mesh.cell_dimension();
  std::vector<double>    result(mesh.n_cells(), std::max(weight, least));
  for (const auto &facet : mesh.facets)
    result[facet.element] += of_facet * element_weight;

  std::vector<unsigned int> first(mesh.n_nodes(), none);
  for (unsigned int e = mesh.n_cells(); e-- > 0;)
    for (unsigned int v = 0; v < n_corners; ++v)
      first[mesh.cells()[e * n_corners + v]] = e;
  for (auto facet = mesh.facets.rbegin(); facet != mesh.facets.rend(); ++facet)
    for (const unsigned int node : facet->nodes)
      first[node] = facet->element;
  points.for_each_number(index, [&](const unsigned int i, const double number) {
    if (const unsigned int e = first[body.surface_nodes()[i]]; e != none)
      result[e] += contact_weight * number;
  });
  return result;
}

template <int dim>
typename StructureWork<dim>::ByBody
StructureWork<dim>::of_elements(const StructureSystem<dim> &structure,
                                const ContactCoupling<dim> &contacts) const
{
  ByBody      result;
  const auto &points = contacts.structure_points();
  for (const auto &body : structure.solids)
    result.push_back(
      of_body(body,
              points,
              result.size(),
              (body.n_points_per_element() > 1 ? 1. : of_one_point) * element_weight));
  for (const auto &body : structure.rigids)
    result.push_back(of_body(body,
                             points,
                             result.size(),
                             body.mesh().n_sheets() > 0 ? 0. : of_rigid_element * element_weight));
  return result;
}

template class StructureWork<2>;
template class StructureWork<3>;
} // namespace coracle
