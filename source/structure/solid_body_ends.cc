// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of where nodes end within a step.
#include <coracle/structure/solid_body.h>

namespace coracle
{
template <int dim>
void
SolidBody<dim>::add_end_change(const unsigned int node, const Vector &shift, const Vector &count)
{
  this->add_vector(Node::correction, node, shift);
  this->add_vector(Node::impulse, node, count);
}

template <int dim>
bool
SolidBody<dim>::apply_end_changes(const double held_part)
{
  // Both columns are free between `move` and the next contact.
  Columns &nodes = this->node_columns;
  for (const unsigned int first : {Node::correction, Node::impulse})
    {
      condense(first, dim);
      mesh().exchange.sum_to_owners(nodes, first, dim);
    }
  const double *const n_shifts = nodes[Node::impulse], *const n_holds = nodes[Node::impulse + 1];
  bool result = false;
  for (int d = 0; d < dim; ++d)
    for (const unsigned int n : contact_nodes)
      {
        double &shift = nodes[Node::correction + d][n];
        if (nodes[Node::inverse_mass + d][n] == 0)
          shift = 0;
        else if (n_holds[n] > 0)
          shift = (held_part - 1) * nodes[Node::increment + d][n];
        else if (n_shifts[n] > 0)
          shift /= n_shifts[n];
        result = result || shift != 0;
      }
  distribute(Node::correction);
  for (int d = 0; d < dim; ++d)
    for (unsigned int n = 0; n < nodes.size(); ++n)
      {
        double &shift = nodes[Node::correction + d][n];
        nodes[Node::position + d][n] += shift;
        nodes[Node::increment + d][n] += shift;
        shift                       = 0;
        nodes[Node::impulse + d][n] = 0;
      }
  return result;
}

template void SolidBody<2>::add_end_change(const unsigned int, const Vector &, const Vector &);
template void SolidBody<3>::add_end_change(const unsigned int, const Vector &, const Vector &);
template bool SolidBody<2>::apply_end_changes(const double);
template bool SolidBody<3>::apply_end_changes(const double);
} // namespace coracle
