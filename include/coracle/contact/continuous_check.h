// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/exact_sum.h>
#include <coracle/contact/contact.h>
#include <coracle/contact/end_changes.h>
#include <coracle/contact/global_search.h>
#include <coracle/contact/nearest_point.h>

namespace coracle::contact
{
/**
 * Limits what a step may do: follows points through the step, from where they
 * start to where they would end, past facets that move and turn, and changes
 * the ends of points that would come too near to a facet or through it.
 *
 * A contact is linearised at the start of the step. It misses where a facet
 * turns fast, where a point slides in one step from one face of a fold to the
 * next, and where surfaces close on a point so that no velocities of the grid
 * keep it away from both. What is left of such motion is taken from the point's
 * end position: velocities, grid and surface do not change, and in the next
 * step the contact is seen where it is.
 *
 * Point and nodes move straight within the step. Time advances by what is
 * certain to be free: the distance to the facet over the greatest relative
 * displacement, or as long as the facet stays behind the plane between it and
 * the point (Mirtich 1996 calls the first conservative advancement). Where a
 * point comes nearer than `clearance` of the contact distance R, the plane
 * there bounds where it may end; planes are collected until the whole path is
 * free. A pair that starts nearer than that must keep half of its distance.
 *
 * A point that has passed a surface (a contact with negative gap) is not held
 * back from returning. One that starts exactly on a surface belongs to the side
 * that its contact's normal points to.
 */
template <int dim>
class ContinuousCheck
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// Columns of the coordinates at the end of the step, per point set [m]; null for nodes of
  /// structures.
  using Ends = std::vector<std::array<double *, dim>>;

  /// Of R, and of the size of a facet, that a point keeps at least.
  static constexpr double clearance = 0.1, least_clearance = 1e-6;

  /// What happened on this rank.
  struct Report
  {
    /// Points whose end was changed, and those of them whose path is still not free.
    unsigned long n_resolved = 0, n_failed = 0;
    /// Greatest change of an end [m].
    double largest_shift = 0;
  };

  /// At the start of the step: keeps the places of the nodes.
  void start(const Surface<dim> &surface);

  /**
   * At the end of the step, facets and candidates as at the start.
   * @param surface  nodes where they end
   * @param points   where points start
   * @param contacts of this step, sorted by set and point
   * @param ends     where points end, changed
   */
  Report resolve(const Surface<dim>                    &surface,
                 const std::vector<PointSet<dim>>      &points,
                 const std::vector<const Candidates *> &candidates,
                 const std::vector<Contact<dim>>       &contacts,
                 const Ends                            &ends);

  /// One pass over the nodes of structures.
  struct NodePass
  {
    /// Index in the surface of nodes that are points, by their index among owned ones.
    const std::vector<unsigned int> &local_nodes;
    /// The first pass asks for the whole clearance, later ones for what the first may leave.
    bool is_first, holds;
    /// Facets go this many times as far as they must.
    double growth;
    /// Rounds displacements, so that their sum does not depend on the order if it must not.
    SumGrid grid;
  };

  /**
   * Follows the nodes of structures; arguments as for resolve().
   * @param changes what they ask for, zero on entry; nodes as in `surface`
   * @return how many of this rank's nodes are not free and can be helped
   */
  unsigned long follow_nodes(const Surface<dim>                    &surface,
                             const std::vector<PointSet<dim>>      &points,
                             const std::vector<const Candidates *> &candidates,
                             const std::vector<Contact<dim>>       &contacts,
                             const NodePass                        &pass,
                             EndChanges<dim>                       &changes);

private:
  static constexpr unsigned int n_vertices = vertices_per_facet<dim>;
  using Vertices                           = std::array<dealii::Point<dim>, n_vertices>;

  /// A facet within reach of the present point, and how near the point may come to it, now and at
  /// first [m].
  struct Near
  {
    unsigned int facet;
    Vertices     start, end;
    double       clearance, greatest_clearance;
  };

  /// The first time at which a point is too near; nearest point then, and the way to the point.
  struct Meeting
  {
    double            time;
    NearestPoint<dim> nearest;
    Vector            normal;
  };

  /// The end of the point must satisfy normal * x >= bound.
  struct Plane
  {
    Vector normal;
    double bound;
  };

  /// Candidates and radius of the present point.
  struct PointOfSet
  {
    const unsigned int *first_facet, *last_facet;
    double              radius;
  };

  /// A box [m].
  struct Extent
  {
    std::array<double, dim> lower, upper;
  };

  /// A node on its way.
  struct Node
  {
    unsigned int       index;
    int                body;
    dealii::Point<dim> begin, end;
  };

  using ContactIterator = typename std::vector<Contact<dim>>::const_iterator;

  void   find_extents(const Surface<dim> &surface);
  double size_of(const unsigned int facet) const;
  /// Finds the bodies that a point has passed, and the normal of the surface that it starts on, or
  /// 0. Takes its contacts, which are the next ones or none.
  Vector look_at_contacts(const Surface<dim>    &surface,
                          const unsigned int     set,
                          const unsigned int     point,
                          ContactIterator       &contact,
                          const ContactIterator &end);
  /// How far off the facets that it starts on a point is thought to be [m].
  double way_off_surface(const Surface<dim>       &surface,
                         const dealii::Point<dim> &x,
                         const PointOfSet         &point) const;
  /// Adds the facets of a point that the path may meet to `near`; false if it has them all.
  bool collect(const Surface<dim>       &surface,
               const dealii::Point<dim> &begin,
               const dealii::Point<dim> &end,
               const PointOfSet         &point);
  bool keep_free(const dealii::Point<dim> &begin, dealii::Point<dim> &end);
  /// Changes the end until the path is free of all facets that it may meet; false if it is not.
  bool find_free_end(const Surface<dim>       &surface,
                     const dealii::Point<dim> &begin,
                     dealii::Point<dim>       &end,
                     const PointOfSet         &point);
  bool first_meeting(const dealii::Point<dim> &begin,
                     const dealii::Point<dim> &end,
                     Meeting                  &meeting,
                     unsigned int             &which) const;

  static bool              certainly_apart(const dealii::Point<dim> &begin,
                                           const dealii::Point<dim> &end,
                                           const Near               &facet);
  static bool              meets(const dealii::Point<dim> &begin,
                                 const dealii::Point<dim> &end,
                                 const Near               &facet,
                                 Meeting                  &meeting);
  static NearestPoint<dim> nearest_on(const dealii::Point<dim> &x, const Vertices &vertices);
  /// The same plane for ends that can be changed in some directions only.
  Plane        within_reach(Plane plane, const dealii::Point<dim> &wanted) const;
  static Plane plane_at_end(const Near &facet, const Meeting &meeting);
  static Plane
  plane_on_the_way(const Near &facet, const Meeting &meeting, const dealii::Point<dim> &begin);
  static dealii::Point<dim> carried(const Near               &facet,
                                    const dealii::Point<dim> &begin,
                                    const dealii::Point<dim> &end,
                                    const double              time);
  void project(const dealii::Point<dim> &wanted, dealii::Point<dim> &end) const;

  bool respond(const Surface<dim> &surface,
               Node                node,
               const PointOfSet   &point,
               const NodePass     &pass,
               EndChanges<dim>    &changes);
  /// Moves a node aside; false if there is no free place.
  bool go_aside(const Surface<dim> &surface,
                Node               &node,
                const PointOfSet   &point,
                const NodePass     &pass,
                EndChanges<dim>    &changes);
  /// Pushes a facet out of a node's way; false if its nodes cannot be moved.
  bool push(const Surface<dim> &surface,
            const Node         &node,
            const Near         &facet,
            const Meeting      &meeting,
            const NodePass     &pass,
            EndChanges<dim>    &changes) const;

  std::vector<dealii::Point<dim>> nodes;
  std::vector<Extent>             extents;
  std::vector<char>               passed;
  std::vector<Near>               near;
  std::vector<Plane>              planes;
  /// Directions in which the present node cannot be moved.
  std::array<bool, dim> fixed{};
};
} // namespace coracle::contact
