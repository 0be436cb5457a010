// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/row_builder.h>

namespace coracle::contact
{
template <int dim>
void
RowBuilder<dim>::clear()
{
  for (const auto &origin : sources)
    (origin.is_surface ? node_place : place)[origin.number] = none;
  list.clear();
  all.clear();
  sources.clear();
}

template <int dim>
void
RowBuilder<dim>::add(const unsigned int unknown, const double weight)
{
  if (weight == 0)
    return;
  // Hanging nodes bring the same parent repeatedly; the solver's diagonal needs the sum.
  for (std::size_t e = list.begin.back(); e < list.entries.size(); ++e)
    if (list.entries[e].unknown == unknown)
      {
        list.entries[e].weight += weight;
        return;
      }
  list.entries.push_back({unknown, weight});
}

template <int dim>
void
RowBuilder<dim>::add_node(const Surface<dim> &surface,
                          const unsigned int  index,
                          const double        weight)
{
  if (surface.nodes[index].hangs())
    {
      for (const int parent : surface.nodes[index].parents)
        add_node(surface, parent, 0.5 * weight);
      return;
    }
  unsigned int &number = local_number(node_place, index);
  if (number == none)
    {
      const auto &node = surface.nodes[index];
      number           = all.size();
      sources.push_back({true, index});
      all.push_back({node.velocity, node.inverse_mass, node.key, node.owner});
    }
  add(number, weight);
}

template <int dim>
void
RowBuilder<dim>::add_facet_side(const Contact<dim> &contact, const Surface<dim> &surface)
{
  const auto &facet = surface.facets[contact.facet];
  const int   rigid = surface.bodies[facet.body].rigid_body;
  if (rigid < 0)
    for (unsigned int k = 0; k < facet.nodes.size(); ++k)
      if (contact.weights[k] != 0)
        add_node(surface, facet.nodes[k], contact.weights[k]);
  list.begin.push_back(list.entries.size());
  list.rigid_body.push_back(
    {{contact.point_body < 0 ? -1 : surface.bodies[contact.point_body].rigid_body, rigid}});
}

template class RowBuilder<2>;
template class RowBuilder<3>;
} // namespace coracle::contact
