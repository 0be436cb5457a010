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
  /// Index of the point, as the caller numbers them.
  unsigned int point;
  /// Index into Surface::facets; of several that share the edge or vertex, the one with the lowest key.
  unsigned int facet;
  Region       region;
  /// Weights of the facet's nodes at the nearest point, sum 1.
  std::array<double, vertices_per_facet<dim>> weights;
  /// From the surface to the side the point belongs to, unit length.
  dealii::Tensor<1, dim> normal;
  /// Signed distance of the point from the (mid-)surface along the normal, g [m].
  double gap;
  /// Contact distance R = d/2 + r [m].
  double distance;
};

/// Vector unknowns whose velocity has one inverse mass per direction: grid nodes and structure nodes.
template <int dim>
struct Unknown
{
  dealii::Tensor<1, dim> velocity;
  dealii::Tensor<1, dim> inverse_mass;
  /// The same unknown has the same key on every rank; `owner` sums its impulses.
  std::uint64_t key = 0;
  int           owner = 0;
};

/// A rigid body: the same on all ranks. Spin is about z in 2-D (component 2 of the pseudo-vector).
template <int dim>
struct RigidUnknown
{
  dealii::Point<dim>     centre;
  dealii::Tensor<1, dim> velocity;
  dealii::Tensor<1, 3>   spin;
  /// 1/M per direction, 0 where not free.
  dealii::Tensor<1, dim> inverse_mass;
  /// Inverse inertia about the centre in the current frame; in 2-D only entry (2,2) is used.
  dealii::Tensor<2, 3> inverse_inertia;
};

/// Sides of the contacts as rows: velocity of a side = sum of weight * velocity[unknown] (+ rigid motion).
/// Side 0 is the point, side 1 the facet.
struct Rows
{
  struct Entry
  {
    unsigned int unknown;
    double       weight;
  };
  /// Entries of side s of contact c: begin[2 * c + s] up to begin[2 * c + s + 1].
  std::vector<std::size_t> begin = {0};
  std::vector<Entry>       entries;
  /// Rigid body of the facet's side, or -1.
  std::vector<int> rigid_body;
};

/// What the solver gives back, per contact, as acting on the point (the facet gets the opposite).
template <int dim>
struct Impulses
{
  /// Impulse P, normal and friction [N s].
  std::vector<dealii::Tensor<1, dim>> impulse;
  /// "Mass times displacement" of the position solve [kg m]; moves positions, never velocities.
  std::vector<dealii::Tensor<1, dim>> correction;
};
} // namespace coracle::contact
