// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/point_cloud.h>

#include <mpi.h>

#include <array>
#include <vector>

namespace coracle::meshless
{
struct TessellationOptions
{
  /// Elements are kept whose empty sphere's radius is at most alpha h, with h the mean spacing of
  /// their points.
  double alpha = 1.3;
  /// Share of h within which circumcentres count as one, and below which the height of a simplex
  /// counts as none (a sliver).
  double merge_tolerance = 1e-3;

  /// How far from its own points a rank must know those of others, with `spacing` the largest of
  /// all points [m]: an element and its neighbours.
  double halo_width(const double spacing) const
  {
    return 4. * (alpha + 10. * merge_tolerance) * spacing;
  }
};

/**
 * The polygons or polyhedra between points that make up the fluid, as far as
 * this rank assembles them: those whose point of lowest id it owns, so that
 * each element is on exactly one rank. Node numbers are rows of the PointCloud.
 */
template <int dim>
struct Tessellation
{
  using Simplex = std::array<unsigned int, dim + 1>;
  using Facet   = std::array<unsigned int, dim>;

  unsigned int n_elements() const { return volume.size(); }
  unsigned int n_nodes(const unsigned int element) const
  {
    return first_node[element + 1] - first_node[element];
  }
  bool is_simplex(const unsigned int element) const { return n_nodes(element) == dim + 1; }

  /// Nodes of element e, by rising id: node[first_node[e]] to node[first_node[e + 1]].
  std::vector<unsigned int> first_node = {0}, node;

  /// The element cut into simplices, for quadrature; slivers are left out, but for lone ones.
  std::vector<unsigned int> first_simplex = {0};
  std::vector<Simplex>      simplex;

  /// The element's surface in facets (edges, triangles) whose nodes turn counter-clockwise seen
  /// from outside, in the plane: the outside to the right of first to second node. Elements that
  /// are simplices have none here.
  std::vector<unsigned int> first_facet = {0};
  std::vector<Facet>        facet;
  /// Of each of these the face it is part of, by one of the face's facets (counted from the
  /// element's first): triangles in one plane are one face if they look at the same element.
  std::vector<unsigned int> face;

  /// Of each element [m^dim].
  std::vector<double> volume;

  /// Facets that no other element shares, turned in the same way, and their elements.
  std::vector<Facet>        boundary_facet;
  std::vector<unsigned int> boundary_element;

  /// Of each point: it is fluid, and on the boundary or without an element. Right for own points;
  /// the copies' are to be had from their owners (Halo::update).
  std::vector<unsigned char> on_free_surface;
  /// Of each point: it has an element. Right for own points.
  std::vector<unsigned char> has_element;
};

/**
 * The extended Delaunay tessellation of the points, without the elements whose
 * empty sphere is too large or whose points are all walls.
 *
 * Simplices on one empty sphere are one element, so that the tessellation is
 * unique: a regular grid gives squares or cubes. Slivers (simplices as flat as
 * the tolerance) join one of the elements beside them.
 *
 * A kept element lies in a ball of radius 2 alpha h around each of its points. A
 * rank that knows all points within twice that of its own (options.halo_width())
 * therefore finds its elements, and the neighbours that decide which of their
 * facets are boundary and which of them slivers join, as all points together
 * would give them.
 *
 * @throws RunFailure on all ranks if two points are at the same place. Collective.
 *
 * Source: Del Pin, Idelsohn, Onate & Calvo (2003), sections 2 and 6; Idelsohn,
 * Calvo & Onate (2003), Polyhedrization of an arbitrary 3D point set, CMAME 192.
 */
template <int dim>
Tessellation<dim>
tessellate(const PointCloud<dim> &points, const TessellationOptions &options, const MPI_Comm comm);
} // namespace coracle::meshless
