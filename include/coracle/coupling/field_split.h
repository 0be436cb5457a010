// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/facet_exchange.h>
#include <coracle/contact/sheet_crossing.h>
#include <coracle/coupling/material_point_body.h>
#include <coracle/grid/point_cutter.h>

#include <list>

namespace coracle
{
/**
 * Finds the particles that a sheet cuts off from some of their grid nodes: the
 * straight way from the particle to the node meets the sheet's mid-surface. A
 * way that passes beside a sheet's rim meets nothing, so that fields that are
 * apart along the sheet are one beyond it.
 *
 * A node on a mid-surface counts as lying on its + side. A particle on it lies
 * on the side that contact has noted for it, or else on the + side.
 */
template <int dim>
class FieldSplit
{
public:
  /// Collective.
  FieldSplit(const Octree<dim> &octree);

  /// Cuts of all bodies at the start of a step. Collective.
  void update(const contact::Surface<dim>       &surface,
              std::list<MaterialPointBody<dim>> &bodies,
              NodeSplit<dim>                    &split);

  /// All is looked for anew at the next update. Collective.
  void octree_changed();

  std::size_t memory_consumption() const;

private:
  using Crossing = contact::SheetCrossing<dim>;

  /// A particle whose leaf is near a sheet, with the leaf's place in near_leaves, or one that
  /// touches a surface.
  struct Candidate
  {
    unsigned int row, place;
  };
  static constexpr unsigned int nowhere = -1;

  bool select_sheets(const contact::Surface<dim> &surface);
  void follow_sheets(const bool gimp);
  void find_near_leaves(const double skin, const bool gimp);
  /// Box around the nodes that particles in a leaf can reach.
  contact::Box reach(const unsigned int leaf, const bool gimp) const;
  void         extend(const unsigned int leaf, contact::Box &box) const;
  void         find_candidates(const MaterialPointBody<dim> &body);
  void         cut(MaterialPointBody<dim> &body, NodeSplit<dim> &split);
  contact::Box
  box_around(const dealii::Point<dim> &x, const unsigned int leaf, const double half) const;
  const dealii::Point<dim> &place_of_node(const unsigned int             node,
                                          const typename Crossing::List &list);

  const Octree<dim> &octree;
  MPI_Comm           comm;
  double             smallest_cell;

  /// This rank's facets of sheets; which nodes of the published surface theirs are.
  contact::Surface<dim>           sheets;
  std::vector<unsigned int>       source;
  std::size_t                     n_published = 0;
  std::vector<dealii::Point<dim>> searched_at;
  /// Has there been a search, and have sheets moved since the last?
  bool searched = false, moved = false;
  /// How far sheets may have moved since then [m].
  double searched_skin = 0;

  contact::FacetExchange<dim> exchange;
  Crossing                    crossing;
  contact::BoxTree            tree;

  /// Leaves that a sheet is near, ascending; simplices of near_leaves[i]: near[begin[i]] ...
  std::vector<unsigned int> near_leaves, near;
  std::vector<std::size_t>  begin;
  /// Place of a leaf in near_leaves, or -1.
  std::vector<int> place_of_leaf;

  std::vector<Candidate> candidates;
  /// Simplices near the present particle.
  std::vector<unsigned int> close;
  /// Nodes of this step, moved off mid-surfaces; -1 where not asked for yet.
  std::vector<int>                node_places;
  std::vector<unsigned int>       asked_nodes;
  std::vector<dealii::Point<dim>> cleared;
};
} // namespace coracle
