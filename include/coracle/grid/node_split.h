// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/grid/octree.h>

#include <cstdint>
#include <vector>

namespace coracle
{
/**
 * Nodes that sheets cut off from some of the particles around them have one
 * record more for each set of sheets between: particles use the record of the
 * sheets that lie between them and the node, and so feel only what is on their
 * own side (visibility, as for cracks in J.A. Nairn, Material point method
 * calculations with explicit cracks, CMES 4 (2003) 649-663).
 *
 * Records 0 ... n_nodes() - 1 are the octree's nodes, those behind are extra
 * and made anew for each step. The owner of a node has all its extra records,
 * other ranks those that their own particles use. Only nodes that do not hang
 * have any.
 */
template <int dim>
class NodeSplit
{
public:
  explicit NodeSplit(const Octree<dim> &octree) : octree(octree) {}

  /// The octree has new nodes.
  void reinit();

  /// Forget all extra records.
  void clear();

  /// The record of a node for particles from which these sheets (a bit for each) separate it; made
  /// if it is new. With no sheet it is the node's own.
  unsigned int record(const unsigned int node, const std::uint64_t sheets);

  /// Collective. Owners learn of the extra records of other ranks.
  void share();

  unsigned int n_records() const { return octree.n_nodes() + extras.size(); }
  /// The node of a record.
  unsigned int node(const unsigned int record) const
  {
    return record < octree.n_nodes() ? record : extras[record - octree.n_nodes()].node;
  }
  bool is_owned(const unsigned int record) const { return node(record) < octree.n_owned_nodes(); }

  /// Unique over ranks and records, below 2^48.
  std::uint64_t key(const unsigned int record) const
  {
    return record < octree.n_nodes() ? std::uint64_t(octree.global_node(record))
                                     : extras[record - octree.n_nodes()].key;
  }

  /// Extra records only: what other ranks have is added to the owner's and becomes zero there.
  void sum_to_owners(NodeRecords &records) const;
  /// Extra records only: other ranks get what the owner has.
  void update_ghosts(NodeRecords &records) const;

  std::size_t memory_consumption() const;

private:
  struct Extra
  {
    unsigned int  node;
    std::uint64_t sheets;
    std::uint64_t key;
    /// Next extra record of the same node, or -1.
    int next;
  };

  /// Records that this rank and another share, in the same order on both.
  struct Partner
  {
    int                       rank;
    std::vector<unsigned int> records;
    mutable NodeRecords       buffer;
  };

  void make_keys();
  void swap(const std::vector<Partner> &from, const std::vector<Partner> &to) const;

  const Octree<dim> &octree;
  std::vector<Extra> extras;
  /// First extra record of each node, or -1.
  std::vector<int> first;
  /// Ranks that own nodes of extra records here, and ranks that use extra records of nodes owned
  /// here.
  std::vector<Partner> owners, users;
};
} // namespace coracle
