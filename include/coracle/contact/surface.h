// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <cstdint>
#include <vector>

namespace coracle::contact
{
/// Segment in 2-D, bilinear quadrilateral in 3-D.
template <int dim>
constexpr unsigned int vertices_per_facet = (dim == 2 ? 2 : 4);

/// A closed body has material on one side only; a sheet (shell, membrane) meets particles on both.
enum class SurfaceKind
{
  closed,
  sheet
};

/// How the points of one body's surface move and resist: what contact knows of a body.
struct SurfaceBody
{
  SurfaceKind kind = SurfaceKind::closed;
  /// Thickness d; contact distance is R = d/2 + r with the particle's radius r [m].
  double thickness = 0;
  /// Coulomb friction coefficient against points [1].
  double friction = 0;
  /// Index into the rigid bodies of the unknowns, or -1: facets move with their nodes.
  int rigid_body = -1;
  /// Index of this sheet's column in PointSet::side; not used by closed bodies.
  int sheet = -1;
  /// The structural body it belongs to: sheets that are joined have one.
  unsigned int part = 0;
  /// May contact move it at all? Not a rigid body whose motion is wholly prescribed.
  bool movable = true;
  /// Do the body's own surface nodes touch its facets?
  bool self_contact = false;
};

/// A node of the surface. Several ranks may hold copies; `key` tells that they are the same.
template <int dim>
struct SurfaceNode
{
  /// Position at the start of the step [m].
  dealii::Point<dim> position;
  /// Predicted velocity at the middle of the step, without contact [m/s].
  dealii::Tensor<1, dim> velocity;
  /// 1/m per direction, 0 where the motion is prescribed [1/kg].
  dealii::Tensor<1, dim> inverse_mass;
  /// Unique over all bodies and ranks.
  std::uint64_t key = 0;
  /// Rank that owns it.
  int owner = 0;
  /// Indices into Surface::nodes of the ends of the edge that it is the middle of and moves with
  /// (3-D, next to a larger facet), or -1: it moves by itself.
  std::array<int, 2> parents{{-1, -1}};

  bool hangs() const { return parents[0] >= 0; }
};

template <int dim>
struct Facet
{
  /// Indices into Surface::nodes; facets are neighbours where they name the same node. 2-D: the
  /// body lies to the left of 0 -> 1, so the outward normal is the tangent turned clockwise. 3-D:
  /// counter-clockwise seen from outside. A triangle repeats its last node.
  std::array<unsigned int, vertices_per_facet<dim>> nodes;
  /// Index into Surface::bodies.
  unsigned int body = 0;
  /// Unique over ranks; ties between facets are resolved by it.
  std::uint64_t key = 0;
};

/// All facets that this rank's points can reach before the next rebuild, with their nodes; and
/// the nodes that are points of this rank, also those without a facet.
template <int dim>
struct Surface
{
  /// The same on all ranks.
  std::vector<SurfaceBody>      bodies;
  std::vector<SurfaceNode<dim>> nodes;
  std::vector<Facet<dim>>       facets;

  /// Can contact move this node of this body?
  bool can_move(const unsigned int body, const unsigned int node) const
  {
    return bodies[body].rigid_body >= 0 ? bodies[body].movable
                                        : nodes[node].inverse_mass.norm_square() > 0;
  }
};
} // namespace coracle::contact
