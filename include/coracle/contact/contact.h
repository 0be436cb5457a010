// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/surface.h>

namespace coracle::contact
{
/// Where on its facet the nearest point lies.
enum class Region : unsigned char
{
  interior,
  edge,
  vertex
};

/**
 * One local minimum of the distance from a point to the whole surface that is
 * within the band, at the start of the step.
 */
template <int dim>
struct Contact
{
  /// Index of the point set, and of the point in it.
  unsigned int set;
  unsigned int point;
  /// Index into Surface::facets; of several that share the edge or vertex, the one with the lowest
  /// key.
  unsigned int facet;
  Region       region;
  /// Weights of the facet's nodes at the nearest point, sum 1.
  std::array<double, vertices_per_facet<dim>> weights;
  /// Nearest point on the (mid-)surface, x_c [m].
  dealii::Point<dim> place;
  /// From the surface to the side the point belongs to, unit length.
  dealii::Tensor<1, dim> normal;
  /// Signed distance of the point from the (mid-)surface along the normal, g [m].
  double gap;
  /// Contact distance R = d/2 + r [m].
  double distance;
  /// Coulomb friction coefficient [1].
  double friction;
  /// Where the point is a surface node: its body, or -1, and its index into Surface::nodes.
  int          point_body = -1;
  unsigned int point_node = 0;
};

/// Can the contact of a surface node move either side? If not, it is none.
template <int dim>
bool
anything_moves(const Contact<dim> &contact, const Surface<dim> &surface)
{
  const auto &facet  = surface.facets[contact.facet];
  bool        result = surface.can_move(contact.point_body, contact.point_node);
  for (unsigned int k = 0; k < facet.nodes.size(); ++k)
    result |= contact.weights[k] != 0 && surface.can_move(facet.body, facet.nodes[k]);
  return result;
}
} // namespace coracle::contact
