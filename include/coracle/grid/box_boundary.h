// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/octree.h>

#include <array>
#include <string>
#include <vector>

namespace coracle
{
/// What a face of the box does to material points.
enum class FaceCondition
{
  /// No motion through the face, free along it; also a plane of symmetry.
  slip,
  /// No motion at the face.
  stick,
  /// Points may leave; they are counted and removed.
  open
};

/**
 * The conditions on the 2 dim faces of the box, and what they mean for nodes:
 * bit d of fixed(node) tells that velocity component d is zero.
 */
template <int dim>
class BoxBoundary
{
public:
  static void declare(Declaration &grid_section);

  BoxBoundary(const std::array<FaceCondition, 2 * dim> &conditions, const Octree<dim> &octree);
  static std::array<FaceCondition, 2 * dim> read(const Parameters &grid_section);

  /// The octree has new nodes.
  void reinit(const Octree<dim> &octree);

  /// Face 2 d is the lower one in direction d, 2 d + 1 the upper one.
  FaceCondition condition(const unsigned int face) const { return conditions[face]; }
  unsigned char fixed(const unsigned int node) const { return flags[node]; }
  /// Owned and ghost nodes with anything fixed.
  const std::vector<unsigned int> &fixed_nodes() const { return nodes; }

  /// Face through which a point outside of the box has left (the one it is farthest beyond).
  unsigned int face_left(const dealii::Point<dim> &point) const;
  /// "x min", "y max", ...
  static std::string face_name(const unsigned int face);

private:
  std::array<FaceCondition, 2 * dim> conditions;
  dealii::BoundingBox<dim>           box;
  std::vector<unsigned char>         flags;
  std::vector<unsigned int>          nodes;
};
} // namespace coracle
