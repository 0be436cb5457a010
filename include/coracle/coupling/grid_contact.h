// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/lac/la_parallel_vector.h>

#include <coracle/coupling/material_point_system.h>
#include <coracle/coupling/structure_on_grid.h>

#include <memory>

namespace coracle
{
/**
 * Contact on the nodes of the octree, as in the coupled finite element material
 * point method: both bodies are mapped to the grid, and where both have mass at
 * a node, approach each other and are near enough, they exchange an impulse
 * there (grid_contact_law.h).
 *
 * Normals are mass gradients (Eq. 23), of unit length, and made collinear by
 * halving their difference. Near enough: along this normal, the foremost points
 * of both bodies among those that the node's shape function reaches overlap,
 * each point counted with its contact radius. Without that bodies meet up to
 * two cells apart. The idea is that of Ma, Zhang & Huang (2010), who compare
 * such a distance with a fraction of the particle spacing.
 *
 * It sees nothing between the nodes of a mesh coarser than the cells, and so
 * lets particles through there; the surface contact of ContactCoupling does not.
 * More than two bodies at a node meet pair after pair.
 *
 * Source: Chen, Qiu, Zhang, Lian & Liu (2015), section 2.4; Bardenhagen, Brackbill & Sulsky,
 * Comput. Methods Appl. Mech. Engrg. 187 (2000) 529-541; Ma, Zhang & Huang, CMES 55 (2010) 61-87.
 */
template <int dim>
class GridContact
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// Which bodies meet on the grid.
  struct Options
  {
    bool   with_structures = false, between_fields = false;
    double friction_between_fields = 0;
  };

  GridContact(const Options            &options,
              MaterialPointSystem<dim> &points,
              StructureSystem<dim>     &structure,
              MPI_Comm                  comm);

  /// Does any pair of bodies meet on the grid?
  bool is_used() const { return !pairs.empty(); }

  /// The octree has new leaves and nodes. Collective.
  void octree_changed();

  /// Impulses of a step, given to both sides. Collective.
  void solve(MaterialPointSystem<dim> &points, StructureSystem<dim> &structure);

  /// Pairs of bodies in contact at a node in the last step, on all ranks.
  unsigned long n_contacts() const { return contacts; }
  /// Momentum that each material point body got in the last step; this rank's share [N s].
  const std::vector<Vector> &received() const { return momenta; }

private:
  /// Two participants that may meet: velocity fields first, then structures.
  struct Pair
  {
    unsigned int r, s;
    double       friction;
  };

  void make_participants(const unsigned int n_fields);
  void read_fields(MaterialPointSystem<dim> &points);
  /// Nodes where both of any pair have mass; false if there are none on any rank. Collective.
  bool mark_nodes();
  void mark_leaves();
  void find_gradients(MaterialPointSystem<dim> &points);
  void solve_pair(const MaterialPointSystem<dim> &points, const Pair &pair);
  bool find_normals(const Pair &pair);
  void find_distances(const MaterialPointSystem<dim> &points, const Pair &pair);
  void add_up_momenta(const MaterialPointSystem<dim> &points);

  /// Calls action(row, leaf, place, fraction) for the pieces of a body's particles that reach
  /// marked nodes.
  template <typename Action>
  void for_each_piece_near(const MaterialPointBody<dim> &body, const Action &action) const;
  /// Calls action(position, radius, leaf, place) for all points of a participant that reach marked
  /// nodes.
  template <typename Action>
  void for_each_point(const MaterialPointSystem<dim> &points,
                      const unsigned int              participant,
                      const Action                   &action) const;
  /// Calls action(node) for the marked nodes of a leaf, hanging corners replaced.
  template <typename Action>
  void for_each_marked_node(const unsigned int leaf, const Action &action) const;

  const Octree<dim>                    &octree;
  MPI_Comm                              comm;
  double                                cell_size = 0;
  std::unique_ptr<StructureOnGrid<dim>> structures;
  std::vector<Pair>                     pairs;
  /// Velocity fields and bodies of the structure.
  std::vector<GridParticipant<dim>> fields, bodies;

  /// Per node: do any two participants share it? Per leaf: does it reach such a node; is it or a
  /// neighbour such a leaf?
  std::vector<unsigned char> is_shared, leaf_reaches, leaf_is_near;
  /// Of the pair at hand: is it at the node, and its normal out of r.
  std::vector<unsigned char> is_met;
  std::vector<Vector>        normals;
  /// How far s reaches along the normal towards r, and r towards s as its negative [m].
  dealii::LinearAlgebra::distributed::Vector<double> nearest_of_s, nearest_of_r;

  std::vector<Vector> momenta;
  unsigned long       contacts = 0;
};
} // namespace coracle
