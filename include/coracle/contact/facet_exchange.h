// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/contact/box_tree.h>
#include <coracle/contact/point_set.h>

#include <mpi.h>

namespace coracle::contact
{
/**
 * Brings every rank the facets that its points can reach, and takes the nodal
 * impulses back. A rank may own facets, points, both or nothing.
 *
 * Copies of one node that come from several ranks become one node of surface();
 * what acts on it goes back to exactly one of them, the owner if it is among
 * them. A caller whose ranks hold copies of a node sums over these, as it does
 * with element forces.
 */
template <int dim>
class FacetExchange
{
public:
  explicit FacetExchange(MPI_Comm communicator);

  /**
   * Collective. To be called when facets have changed or points may have come
   * within reach of others.
   * @param owned  each facet of the bodies on exactly one rank, with its nodes
   * @param reach  boxes around this rank's points, enlarged by all but half the thickness
   * @param points those that are surface nodes come into surface() too
   */
  void rebuild(const Surface<dim>               &owned,
               const std::vector<Box>           &reach,
               const std::vector<PointSet<dim>> &points);

  /// Collective. Positions, velocities and inverse masses of the nodes anew.
  void update(const Surface<dim> &owned);

  /// The facets within reach.
  const Surface<dim> &surface() const { return local; }

  /// Index in surface().nodes of an owned node that is a point.
  unsigned int local_node(const unsigned int owned_node) const { return local_nodes[owned_node]; }

  /// The same of all owned nodes; without meaning for those that are no points.
  const std::vector<unsigned int> &local_nodes_of_points() const { return local_nodes; }

  /// Collective. Adds `values`, one per node of surface(), to the nodes they came from.
  void add_to_owners(const std::vector<dealii::Tensor<1, dim>> &values,
                     std::vector<dealii::Tensor<1, dim>>       &owned) const;

  /// Of use to the same ranks only.
  void serialize(Archive &archive);

private:
  /// Nodes that one rank sends (indices into owned.nodes) or receives (indices into local.nodes).
  struct Partner
  {
    int                         rank;
    std::vector<unsigned int>   index;
    mutable std::vector<double> buffer;
    /// Of each node: is this rank the one that its impulses return to?
    std::vector<char> returns;
  };

  /// A facet on its way: its nodes are counted in the message's list of nodes.
  struct FacetMessage
  {
    std::array<unsigned int, vertices_per_facet<dim>> nodes;
    unsigned int                                      body;
    std::uint64_t                                     key;
  };

  void        merge(const std::vector<std::vector<SurfaceNode<dim>>> &nodes,
                    const std::vector<std::vector<FacetMessage>>     &facets);
  static void serialize(Archive &archive, std::vector<Partner> &partners);
  void        exchange(std::vector<Partner> &from, std::vector<Partner> &to, const int tag) const;

  MPI_Comm                     communicator;
  Surface<dim>                 local;
  std::vector<unsigned int>    local_nodes;
  mutable std::vector<Partner> sent, received;
};
} // namespace coracle::contact
