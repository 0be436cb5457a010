// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/audit.h>
#include <coracle/contact/continuous_check.h>
#include <coracle/contact/facet_exchange.h>
#include <coracle/contact/local_search.h>
#include <coracle/contact/row_builder.h>
#include <coracle/contact/solver.h>

#include <functional>

namespace coracle::contact
{
/// Contact as a line of the statistics; the same on all ranks.
struct ContactReport
{
  unsigned long n_contacts = 0;
  /// Smallest g - R of all contacts [m]; 0 if there are none.
  double       worst_gap = 0;
  SolverReport solver;
  /// Work of the contacts since the start [J], and the sum over those steps in which it was
  /// positive: energy from nowhere, none with law `split`.
  double work = 0, energy_fed = 0;
  /// Points that went through a surface since the start, found by the audit.
  unsigned long n_penetrations = 0;
  /// Since the start: ends of points that the continuous check changed, those of them for which it
  /// found no free way, and points of this rank that would have gone beyond their candidates.
  unsigned long n_resolved = 0, n_failed = 0, n_held = 0;
  /// The greatest change of an end in this step [m].
  double largest_shift = 0;
  /// How often candidates were looked for anew, and how many pairs of point and facet this rank
  /// keeps.
  unsigned int  n_rebuilds   = 0;
  unsigned long n_candidates = 0;

  void serialize(Archive &archive)
  {
    archive.same("n_contacts", n_contacts);
    archive.same("worst_gap", worst_gap);
    archive.same("work", work);
    archive.same("energy_fed", energy_fed);
    archive.same("n_penetrations", n_penetrations);
    archive.same("n_resolved", n_resolved);
    archive.same("n_failed", n_failed);
    archive.share("n_held", n_held);
    archive.same("largest_shift", largest_shift);
    archive.same("n_rebuilds", n_rebuilds);
    archive.share("n_candidates", n_candidates);
    const Archive::Section section(archive, "solver");
    solver.serialize(archive);
  }
};

/**
 * Contact of a step, from surfaces and points to impulses:
 *
 *   contacts.find(surface, points, dt);                  // 5: facets to where points are, search
 *   contacts.build_rows(point_row, unknown);             // points as sums over the caller's
 * unknowns contacts.solve(rigid_bodies, dt); contacts.point_impulses(...); // onto the caller's
 * unknowns contacts.surface_impulses(...), rigid_impulses(...)  // onto the structure
 *
 * Everything but build_rows, contacts and point_impulses is collective: ranks
 * without points or facets take part.
 */
template <int dim>
class ContactSystem
{
public:
  using Vector = dealii::Tensor<1, dim>;

  ContactSystem(const ContactOptions &options, MPI_Comm communicator);

  /// Facets or nodes have come, gone or been renumbered: search anew at the next find().
  void surface_changed() { changed = true; }
  /// Points have come, gone or been renumbered: search anew at the next find().
  void points_renumbered() { changed = true; }

  /**
   * Finds the contacts at the start of the step.
   * @param owned  facets that this rank owns, nodes at their places with their predicted velocities
   * @param points all material points of this rank, a set for each body; and surface nodes of
   * structures, a set for each body. Each node that may touch is a point on one rank, which has it
   * in `owned`
   */
  void find(const Surface<dim> &owned, const std::vector<PointSet<dim>> &points, const double dt);

  /// All contacts of this rank's points, sorted by set and point.
  const std::vector<Contact<dim>> &contacts() const { return list; }

  /// The facets that contacts refer to; not the same numbering as the owned surface.
  const Surface<dim> &surface() const { return facets.surface(); }

  /// Facets that the points of a set may touch.
  const Candidates &candidates(const unsigned int set) const { return search.candidates(set); }

  /**
   * Rows of all contacts; those of surface nodes' side need nothing of the caller.
   * @param point_row (set, point, entries): appends the point as a sum of weight times one of the
   * caller's unknowns, numbered densely from 0; an unknown may appear repeatedly
   * @param unknown   (number): velocity, inverse mass, key and owner of one of the caller's
   * unknowns
   */
  template <typename PointRow, typename UnknownOf>
  void build_rows(const PointRow &point_row, const UnknownOf &unknown)
  {
    rows.build(list, surface(), point_row, unknown);
  }

  void solve(const std::vector<RigidUnknown<dim>> &rigid, const double dt);

  /// The rows as built, and their unknowns.
  const RowBuilder<dim> &row_builder() const { return rows; }

  /// Per contact, as acting on the point.
  const Impulses<dim> &impulses() const { return solver.impulses(); }

  /**
   * Calls action(number, impulse, correction) for each of the caller's unknowns
   * that contacts of this rank act on, with the sum over these contacts [N s, kg m].
   * An unknown on several ranks gets the sum of what they have.
   */
  template <typename Action>
  void point_impulses(const Action &action) const
  {
    for (unsigned int i = 0; i < unknown_impulse.size(); ++i)
      if (!rows.origins()[i].is_surface)
        action(rows.origins()[i].number, unknown_impulse[i], unknown_correction[i]);
  }

  /// Adds what acts on the nodes of the owned surface (not on rigid bodies) [N s, kg m].
  /// Collective.
  void surface_impulses(std::vector<Vector> &impulse, std::vector<Vector> &correction) const;

  /// What acts on a rigid body: impulse, and its moment about the centre; likewise the correction.
  struct RigidImpulse
  {
    Vector               impulse;
    dealii::Tensor<1, 3> moment;
    Vector               correction;
    dealii::Tensor<1, 3> correction_moment;
  };
  /// Per rigid body, the same on all ranks.
  const std::vector<RigidImpulse> &rigid_impulses() const { return rigid_sums; }

  /// Collective. Changes where structures end, and `owned` with them; returns whether any of this
  /// rank's does.
  using ChangeEnds = std::function<bool(const EndChanges<dim> &)>;

  /**
   * Collective. After all has moved and before positions are taken: changes the
   * ends of nodes of structures, then of points that would come too near to a facet, see
   * ContinuousCheck.
   * @param owned  as for find(), nodes at the end of the step
   * @param points as for find(), where they start
   * @param ends   columns of where points end
   * @param change called only where nodes of structures meet facets; without it they are not
   * followed
   */
  void resolve_in_time(const Surface<dim>                        &owned,
                       const std::vector<PointSet<dim>>          &points,
                       const typename ContinuousCheck<dim>::Ends &ends,
                       const ChangeEnds                          &change = {});

  /**
   * Collective. After all has moved, and before points are renumbered: counts
   * points whose path went through a facet, see Audit.
   * @param owned as for find(), nodes at the end of the step
   * @return crossings of this step on all ranks
   */
  unsigned long audit(const Surface<dim> &owned, const std::vector<PointSet<dim>> &points);

  /// The first crossings of this rank's points, for messages.
  const std::vector<Crossing<dim>> &first_crossings() const { return auditor.first_crossings(); }

  const ContactReport &report() const { return statistics; }

  /// Between steps. Candidates go on as they are, because what is found depends on them in the last
  /// digits; other ranks look for theirs at the next find().
  void serialize(Archive &archive);

private:
  /// Greatest speeds, radius and movement since the last search, over all ranks.
  struct Extremes
  {
    double changed, point_speed, node_speed, radius, movement;
  };
  Extremes measure(const Surface<dim> &owned, const std::vector<PointSet<dim>> &points) const;
  void     rebuild(const Surface<dim>               &owned,
                   const std::vector<PointSet<dim>> &points,
                   const Extremes                   &extremes,
                   const double                      travel);
  /// What the local search cannot know of contacts of surface nodes, from the first of them on;
  /// returns the end of those that anything can move.
  std::size_t complete_node_contacts(const PointSet<dim> &points, const std::size_t first);
  /// The longest way of a node since the last search, over all ranks [m].
  double        farthest_node(const Surface<dim> &owned) const;
  void          limit_travel(const Surface<dim>                        &owned,
                             const std::vector<PointSet<dim>>          &points,
                             const typename ContinuousCheck<dim>::Ends &ends);
  unsigned long limit_travel_of_nodes(const Surface<dim> &owned);
  void          resolve_nodes_in_time(const Surface<dim>               &owned,
                                      const std::vector<PointSet<dim>> &points,
                                      const ChangeEnds                 &change);
  /// What nodes ask for in one pass; returns how many are not free, on all ranks.
  unsigned long ask_nodes(const Surface<dim>               &owned,
                          const std::vector<PointSet<dim>> &points,
                          const unsigned int                pass);
  void          count_changed_nodes(const Surface<dim>                    &owned,
                                    const std::vector<PointSet<dim>>      &points,
                                    const std::vector<dealii::Point<dim>> &wanted,
                                    const unsigned long                    n_failed);
  void          sum_up(const std::vector<RigidUnknown<dim>> &rigid);
  void          sum_up_blocks(const std::vector<RigidUnknown<dim>> &rigid);

  ContactOptions       options;
  MPI_Comm             communicator;
  FacetExchange<dim>   facets;
  GlobalSearch<dim>    search;
  LocalSearch<dim>     local_search;
  RowBuilder<dim>      rows;
  Solver<dim>          solver;
  Audit<dim>           auditor;
  ContinuousCheck<dim> in_time;

  bool changed = true;
  /// How far candidates reach, beyond R, when they were looked for; how much of it is used up [m].
  double reach = 0, used = 0, used_before = 0, largest_node_shift = 0;
  /// Steps since points or facets were last renumbered, and between the last two times; 0: unknown.
  unsigned int                    steps_since_change = 0, change_interval = 0;
  std::vector<dealii::Point<dim>> positions_at_search;
  /// What nodes ask for, as numbered in surface() and among owned ones.
  EndChanges<dim> asked, changes;

  std::vector<Contact<dim>>                 list;
  std::vector<typename WarmStart<dim>::Key> keys;
  std::vector<Vector>                       unknown_impulse, unknown_correction;
  std::vector<RigidImpulse>                 rigid_sums;
  ContactReport                             statistics;
};
} // namespace coracle::contact
