// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/exact_sum.h>
#include <coracle/grid/box_boundary.h>
#include <coracle/grid/node_split.h>

#include <vector>

namespace coracle
{
/**
 * One velocity field on the octree's nodes: what particles gather there, and
 * how the nodes then move. Bodies of one field meet without slip and without
 * passing through each other; bodies of different fields do not feel each
 * other here at all.
 *
 * Where sheets split the field, nodes have further records (NodeSplit); "node" below means any
 * record.
 *
 * The calls of one step, in order:
 *   clear, (particles scatter), sum, predict, [contact], distribute,
 *   clear_momentum, (particles scatter), sum, remap.
 */
template <int dim>
class NodalField
{
public:
  /// Places in a gathered record: mass [kg], momentum [kg m/s], force [N].
  struct Gathered
  {
    static constexpr unsigned int mass = 0, momentum = 1, force = 1 + dim;
  };
  /// Places in a motion record: velocity at the end of the step [m/s], its change over the step
  /// [m/s], mass [kg].
  struct Motion
  {
    static constexpr unsigned int velocity = 0, change = dim, mass = 6;
  };

  /// @param split further records of nodes that sheets cut off; null: there are none
  NodalField(const Octree<dim>      &octree,
             const BoxBoundary<dim> &boundary,
             const NodeSplit<dim>   *split = nullptr);

  /// The octree has new nodes: all is zero. Between steps.
  void reinit();

  /**
   * What nodes gather does not depend on the order from now on, nor on the ranks, bit by bit: for
   * each of the bounds' kinds two sums are kept, of summands rounded so that sums are exact
   * (SumGrid), and of what was rounded off.
   */
  void make_reproducible() { is_reproducible = true; }
  bool reproducible() const { return is_reproducible; }

  /// No summand is larger on any rank; `number` bounds how many there may be at a node.
  struct Bounds
  {
    double mass = 0, momentum = 0, force = 0, number = 1;
  };
  /// Before nodes gather, if that is to be reproducible: the same on all ranks and on any number of
  /// them.
  void bound(const Bounds &bounds);
  /// Largest component of what nodes on this rank have as velocity and change of it [m/s].
  double largest_velocity() const;

  /// Adds to what a node has gathered.
  void give(const unsigned int node, const unsigned int place, const double value)
  {
    if (!is_reproducible)
      {
        records[node][place] += value;
        return;
      }
    const double high = high_grid[place].round(value);
    records[node][place] += high;
    rests[node][place] += low_grid[place].round(value - high);
  }

  NodeRecords       &gathered() { return records; }
  const NodeRecords &gathered() const { return records; }
  const NodeRecords &motion() const { return motions; }

  /// For a new step; takes the records that the split has now.
  void clear();
  /// Hanging nodes give what they have to their parents, ghosts to their owners.
  void sum();
  /// What happened to this rank's share of the kinetic energy on the grid in this step [J].
  struct Energies
  {
    double gathered = 0; ///< p^2/2m as gathered from particles
    double gravity  = 0; ///< brought by gravity
    double boundary = 0; ///< taken at the faces of the box
    double contact  = 0; ///< brought by contact impulses
    double given    = 0; ///< m v^2/2 at the end, as particles find it
  };
  const Energies &energies() const { return books; }
  /// If sums are to be reproducible: rank 0 has all of them, others nothing. Collective.
  void sum_energies();

  /// v = p/m; v += dt (f/m + g); conditions of the box; owned nodes, then everybody's copies.
  void predict(const double dt, const dealii::Tensor<1, dim> &gravity);
  /// Ghosts and hanging nodes follow owned ones.
  void distribute();

  /// Contact impulses [N s] and position corrections [kg m] of this rank, added on any local
  /// non-hanging nodes, then applied on all ranks (collective).
  void add_impulse(const unsigned int            node,
                   const dealii::Tensor<1, dim> &impulse,
                   const dealii::Tensor<1, dim> &correction);
  void apply_impulses();
  /// Position correction of nodes over this step [m], and whether there is any on this rank.
  bool                          has_shift() const { return !shifted_nodes.empty(); }
  const dealii::Tensor<1, dim> &shift(const unsigned int node) const { return shifts[node]; }
  bool                          is_shifted(const unsigned int node) const { return shifted[node]; }

  /// For the second gathering of momentum (MUSL): keeps the masses.
  void clear_momentum();
  /// v2 = p/m with the conditions of the box, in the momentum's place; hanging nodes and ghosts
  /// too.
  void remap();

  /// 1/m per direction, 0 where the box fixes the node or no mass is near.
  dealii::Tensor<1, dim> inverse_mass(const unsigned int node) const;
  dealii::Tensor<1, dim> velocity(const unsigned int node) const;

  /// Momentum sum over owned, non-hanging nodes of this rank [N s].
  dealii::Tensor<1, dim> momentum() const;
  std::size_t            memory_consumption() const;

private:
  unsigned int  n_records() const { return split ? split->n_records() : octree.n_nodes(); }
  unsigned char fixed(const unsigned int record) const
  {
    return boundary.fixed(split ? split->node(record) : record);
  }
  /// Calls action(record) for all that this rank owns.
  template <typename Action>
  void for_each_owned(const Action &action) const
  {
    for (unsigned int i = 0; i < octree.n_owned_nodes(); ++i)
      action(i);
    for (unsigned int i = octree.n_nodes(); i < n_records(); ++i)
      if (split->is_owned(i))
        action(i);
  }
  /// Calls action(record, direction) for all that this rank owns and the box fixes.
  template <typename Action>
  void for_each_fixed(const Action &action) const
  {
    const auto directions = [&](const unsigned int record) {
      for (unsigned int d = 0; d < dim; ++d)
        if (fixed(record) & (1u << d))
          action(record, d);
    };
    for (const unsigned int i : boundary.fixed_nodes())
      if (i < octree.n_owned_nodes())
        directions(i);
    for (unsigned int i = octree.n_nodes(); i < n_records(); ++i)
      if (split->is_owned(i))
        directions(i);
  }
  void sum_rests();
  void book(const Energies &of_a_node);
  void sum_to_owners(NodeRecords &r) const;
  void update_ghosts(NodeRecords &r) const;

  void predict_node(const unsigned int i, const double dt, const dealii::Tensor<1, dim> &gravity);
  void apply_impulse(const unsigned int node);
  void fix_boundary_nodes(const double dt, const dealii::Tensor<1, dim> &gravity);
  void shift_hanging_nodes();
  void condense(NodeRecords &r) const;
  void interpolate_hanging(NodeRecords &r) const;

  const Octree<dim>      &octree;
  const BoxBoundary<dim> &boundary;
  const NodeSplit<dim>   *split;
  bool                    is_reproducible = false;
  /// Of the places in a gathered record.
  std::array<SumGrid, 8>              high_grid, low_grid;
  NodeRecords                         records, rests, motions, impulses;
  std::vector<unsigned int>           touched;
  std::vector<dealii::Tensor<1, dim>> shifts;
  std::vector<unsigned char>          shifted;
  std::vector<unsigned int>           shifted_nodes;
  Energies                            books;
  RankSums                            exact_books{5, true};
};
} // namespace coracle
