// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_q.h>

#include <coracle/base/archive.h>
#include <coracle/base/parameters.h>
#include <coracle/grid/leaf_tree.h>
#include <coracle/grid/node_exchange.h>

#include <array>
#include <functional>
#include <vector>

namespace coracle
{
/// A region in which cells are refined to a level above the base cells.
template <int dim>
struct RefinementBox
{
  dealii::BoundingBox<dim> box;
  unsigned int             level;

  /// Does it reach into a cell? One that only touches it from outside stays as it is.
  bool meets(const dealii::Point<dim> &lower, const double size) const
  {
    bool result = true;
    for (unsigned int d = 0; d < dim; ++d)
      result = result && box.lower_bound(d) + 1e-6 * size < lower[d] + size &&
               box.upper_bound(d) - 1e-6 * size > lower[d];
    return result;
  }
};

/// What the octree is made from.
template <int dim>
struct OctreeDescription
{
  dealii::BoundingBox<dim>        box;
  double                          cell_size;
  std::vector<RefinementBox<dim>> refinements;

  static void declare(Declaration &grid_section);
  /// Refuses a box that is not a whole number of cells, naming the nearest that is.
  static OctreeDescription read(const Parameters &grid_section);
};

/**
 * The background grid: a box of square or cubic cells, refined locally, 2:1
 * balanced, shared out among the ranks by p4est. It may be refined, coarsened and shared out anew
 * at any time (adapt, repartition); then all leaves and nodes have new numbers, and whoever keeps
 * something by these numbers starts afresh.
 *
 * Cells known to this rank are *leaves*: first the locally owned ones along
 * the space-filling curve, then the ghosts. Their corners are *nodes* with
 * local indices: first the locally owned ones, then the ghosts, among them the
 * parents of all hanging nodes. All hot loops use these two numberings and plain arrays; deal.II's
 * objects stay available for output, refinement and weights.
 *
 * The coarse mesh, which p4est replicates on every rank, has the largest cells
 * that fit the box by bisection from the base cells.
 */
template <int dim>
class Octree
{
public:
  static constexpr unsigned int n_corners = 1u << dim;

  /// A hanging node is the weighted mean of its parents, none of which hangs itself.
  struct HangingNode
  {
    unsigned int                                 node;
    std::vector<std::pair<unsigned int, double>> parents;
  };

  /**
   * @param weight work expected in a cell, from its centre and size, >= 0 (1 for a cell with
   *        nothing in it is added); decides the partition. May be empty.
   * @param saved what save() put there, by any number of ranks: its leaves and, on as many ranks,
   * its partition instead of refinements and weights; null: none. Throws RunFailure on all ranks
   *        where this is not a 2:1 balanced octree of the same box
   */
  Octree(const OctreeDescription<dim>                                          &description,
         const std::function<double(const dealii::Point<dim> &, const double)> &weight,
         MPI_Comm                                                               communicator,
         Archive                                                               *saved = nullptr);

  /// The leaves as they are, and who owns them, as section `octree`.
  void save(Archive &archive) const;

  /**
   * Refine and coarsen by one level at most, and share out anew. Neighbours, also through edges and
   * corners, end up to differ by one level at most: a leaf that asks for refinement has its way,
   * one that asks for coarsening waits for its siblings and neighbours. The result is the same on
   * any number of ranks. Collective.
   *
   * @param wanted level of each owned leaf (bisections of the base cell); the regions of the
   *        description stay at least as fine as they say
   * @param work   of each owned leaf, >= 0, besides one for the leaf itself; decides the partition
   * @return true if there are new leaves; then all numbers are new
   */
  bool adapt(std::vector<int> wanted, const std::vector<double> &work);

  /// Share out anew; all numbers are new. Collective.
  void repartition(const std::vector<double> &work);

  /// Bisections of the base cell.
  int level(const unsigned int leaf) const { return leaf_level[leaf]; }
  /// The level that the description asks for.
  int least_level(const unsigned int leaf) const;

  /// Rank whose leaf contains the point, for any point of the box and on every rank; -1 outside.
  int owner_of(const dealii::Point<dim> &point) const;

  /// Ghost leaves get what their owners have: one value for each of n_leaves(). Collective.
  void update_ghost_leaves(std::vector<double> &values) const;

  unsigned int n_owned_leaves() const { return n_owned; }
  unsigned int n_leaves() const { return leaf_nodes.size(); }
  unsigned int n_owned_nodes() const { return exchange.n_owned(); }
  unsigned int n_nodes() const { return positions.size(); }

  /// Corner nodes, x fastest.
  const std::array<unsigned int, n_corners> &nodes(const unsigned int leaf) const
  {
    return leaf_nodes[leaf];
  }
  /// Lower corner [m], edge length [m], owner.
  const dealii::Point<dim> &lower(const unsigned int leaf) const { return leaf_lower[leaf]; }
  double                    size(const unsigned int leaf) const { return leaf_size[leaf]; }
  int                       owner(const unsigned int leaf) const { return leaf_owner[leaf]; }

  /// Leaf that contains the point, or -1 if it is outside the box or in no leaf this rank knows.
  /// Lower faces belong to a cell, upper ones to its neighbour; the box itself is closed.
  int find(const dealii::Point<dim> &point) const { return tree.find(point); }

  const dealii::Point<dim> &position(const unsigned int node) const { return positions[node]; }
  /// Global number, the same on all ranks.
  dealii::types::global_dof_index global_node(const unsigned int node) const;
  int                             node_owner(const unsigned int node) const;

  /// All that hang among this rank's nodes; their parents are nodes of this rank as well.
  const std::vector<HangingNode> &hanging_nodes() const { return hanging; }
  /// Index into hanging_nodes(), or -1.
  int hanging_index(const unsigned int node) const { return node_to_hanging[node]; }

  const dealii::BoundingBox<dim> &box() const { return description.box; }
  /// Box around this rank's leaves; empty box at the lower corner if it has none.
  dealii::BoundingBox<dim> owned_region() const;
  double                   smallest_cell_size() const;
  double                   largest_cell_size() const;

  NodeExchange                                      exchange;
  dealii::parallel::distributed::Triangulation<dim> triangulation;
  dealii::DoFHandler<dim>                           dof_handler;
  /// For output: leaf of deal.II's active cell index, or -1.
  std::vector<int> leaf_of_active_cell;

  std::size_t memory_consumption() const;

private:
  void make_coarse_grid();
  void refine();
  void load(Archive &archive);
  void partition(const std::function<double(const dealii::Point<dim> &, const double)> &weight);
  /// All numbers anew.
  void number();
  void enumerate();
  void find_first_places();
  void make_hanging_nodes();

  /// One parent of a hanging node.
  struct Parent
  {
    dealii::types::global_dof_index hanging, parent;
    double                          weight;
    std::array<double, dim>         place;
  };
  using Cell   = typename dealii::parallel::distributed::Triangulation<dim>::cell_iterator;
  using Status = typename dealii::parallel::distributed::Triangulation<dim>::CellStatus;

  /// Calls action(cell, leaf) for the cells of all leaves.
  template <typename Action>
  void for_each_cell(const Action &action) const;
  /// Work of what a cell becomes, in thousandths; before the change.
  unsigned int
  work_of(const Cell &cell, const Status status, const std::vector<double> &work) const;
  /// Levels that can be had with 2:1 balance, for all leaves. Collective.
  std::vector<double> close(const std::vector<int> &wanted) const;
  /// The owned leaves of the same parent as an owned one, or nothing if not all are leaves.
  std::vector<std::vector<unsigned int>> find_families() const;

  std::vector<Parent> find_parents() const;
  std::vector<Parent> find_far_parents(const std::vector<Parent> &known) const;
  void                add_ghosts(const std::vector<Parent> &parents);

  OctreeDescription<dim>                           description;
  std::vector<unsigned int>                        n_coarse_cells;
  unsigned int                                     base_level = 0;
  dealii::FE_Q<dim>                                fe;
  LeafTree<dim>                                    tree;
  unsigned int                                     n_owned = 0;
  std::vector<std::array<unsigned int, n_corners>> leaf_nodes;
  std::vector<dealii::Point<dim>>                  leaf_lower;
  std::vector<double>                              leaf_size;
  std::vector<int>                                 leaf_owner, leaf_level;
  /// Place along p4est's curve: of each coarse cell of the tree, and where each rank begins.
  std::vector<std::uint64_t>                           curve_of_coarse_cell;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> first_places;
  std::vector<dealii::Point<dim>>                      positions;
  std::vector<HangingNode>                             hanging;
  std::vector<int>                                     node_to_hanging;
};
} // namespace coracle
