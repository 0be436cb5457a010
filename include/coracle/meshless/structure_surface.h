// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/surface.h>

#include <mpi.h>

namespace coracle::meshless
{
/**
 * The surfaces of all structures, with their nodes, as every rank knows them:
 * where they are nearest to a point, and which of their nodes carry it there.
 */
template <int dim>
class StructureSurface
{
public:
  using Vector = dealii::Tensor<1, dim>;
  /// Numbers of its nodes. Quadrilaterals are two triangles.
  using Simplex = std::array<unsigned int, dim>;

  struct Node
  {
    dealii::Point<dim> position;
    Vector             velocity, inverse_mass;
    std::uint64_t      key;
    /// Number of the rigid body, or -1.
    int rigid;
    /// On an edge or a corner of its body, or no node of a closed body: no normal there.
    bool is_sharp;
  };

  /// A place on a surface, and the nodes that carry it.
  struct Place
  {
    Simplex                 nodes;
    std::array<double, dim> weights;
    dealii::Point<dim>      position;
    /// Outward; mean of the facets that meet there.
    Vector normal;
    /// Of the point that was asked for, above the surface; below 0 inside [m].
    double height;
  };

  /// An end of a convex edge of a body, and the facets that meet there; in the plane an edge is a
  /// node.
  struct Ridge
  {
    unsigned int node;
    /// Unit, along the edge to its other end; in the plane 0.
    Vector                      along;
    std::array<unsigned int, 2> facets;
  };

  /**
   * Take over what is published now. Collective.
   * @param rigid_of_node by node of the surface, -1: deformable
   * @param reach         farthest distance that find_nearest() sees [m]
   */
  void update(const contact::Surface<dim> &surface,
              const std::vector<int>      &rigid_of_node,
              const double                 reach,
              const MPI_Comm               comm);

  /// The nearest place within reach, of closed bodies; false: none is so near.
  bool find_nearest(const dealii::Point<dim> &x, Place &place) const;

  /// Velocity of a place [m/s].
  Vector velocity(const Place &place) const;

  std::array<dealii::Point<dim>, dim> vertices(const Simplex &simplex) const;

  std::vector<Node> nodes;
  /// Of closed bodies.
  std::vector<Simplex> facets;
  /// Unit, outward.
  std::vector<Vector> normals;
  /// Of nodes where no edge is hollow.
  std::vector<Ridge> ridges;
  /// By node of the published surface of this rank: its number here, or -1 if it is another rank's.
  std::vector<int> number;

private:
  using Cell = std::array<int, dim>;

  void gather_nodes(const contact::Surface<dim> &surface,
                    const std::vector<int>      &rigid_of_node,
                    const MPI_Comm               comm);
  void gather_facets(const contact::Surface<dim> &surface, const MPI_Comm comm);
  void find_sharp_nodes();
  void find_ridges(const unsigned int node, const std::vector<unsigned int> &around);
  bool is_hollow(const unsigned int node, const unsigned int f, const unsigned int g) const;
  void sort_into_cells();
  Cell cell_of(const dealii::Point<dim> &x) const;

  double reach = 0;
  /// Facets by the cells of a lattice within reach of which they are.
  std::vector<std::pair<Cell, unsigned int>> in_cell;
};
} // namespace coracle::meshless
