// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/global_search.h>
#include <coracle/contact/nearest_point_pack.h>
#include <coracle/contact/options.h>
#include <coracle/contact/surface_topology.h>

namespace coracle::contact
{
/**
 * The contacts of points: the local minima of the distance to the whole surface
 * within the band.
 *
 * A facet's interior minimum counts; an edge or vertex counts only where it is a
 * minimum for all facets that share it, and then once, however many facets they
 * are. So a flat plate of many facets makes one contact and a valley two.
 *
 * Side: a point is outside a closed body or inside, by the pseudonormal at the
 * nearest of its minima. Outside, only the minima that are seen from outside
 * count (those of a far face are hidden by the near one); inside, only the
 * nearest one, with negative gap. For a sheet the same holds with the side that
 * the point belongs to, which is fixed when the point comes near and forgotten
 * when it is gone or goes round the sheet's rim.
 *
 * Self contact: a node lies on its own surface, and facets it belongs to are no
 * candidates. What it sees from within is the far side of its own wall; only
 * minima seen from outside count. So a node must not get behind another part of
 * its own body: the contact distance must be wider than what a step's second
 * order effects can close.
 *
 * The other methods (LocalMethod) take each pair of point and facet for itself and
 * know no sides; see local_search_per_facet.cc. They are there to compare with.
 *
 * The contacts depend on positions and keys, not on how facets are numbered or
 * spread over ranks.
 *
 * Band: R + 2 dt times the relative speed of point and facet, but at least a
 * quarter of the greatest relative speed, so that a point at rest which is hit
 * within the step is not overlooked, and a tenth of the point's radius, so that
 * one that rests beside a surface is not when it is set in motion.
 */
template <int dim>
class LocalSearch
{
public:
  /// Of a point's radius: what the band is at least beyond R.
  static constexpr double least_band = 0.1;

  /// Greatest speeds [m/s] of candidate points and of facet nodes, and the step [s].
  struct Motion
  {
    double dt          = 0;
    double point_speed = 0;
    double node_speed  = 0;
    /// Greatest contact radius of points [m].
    double radius = 0;
    /// Distance beyond R within which a side is kept and contacts are looked for [m].
    double travel() const
    {
      return std::max(least_band * radius, 2 * dt * (point_speed + node_speed));
    }
  };

  explicit LocalSearch(const LocalMethod method = LocalMethod::nearest_on_surface) : method(method)
  {}

  /// To be called when facets have come, gone or been renumbered.
  void reinit(const Surface<dim> &surface);

  /// To be called when nodes have moved, before find().
  void update();

  /// Appends the contacts of one set's candidates, in their order.
  void find(const PointSet<dim>       &points,
            const unsigned int         set,
            const Candidates          &candidates,
            const Motion              &motion,
            std::vector<Contact<dim>> &contacts);

  const SurfaceTopology<dim> &topology() const { return connections; }

private:
  /// A point and a facet near enough to look at closely.
  struct Pair
  {
    unsigned int      point;
    unsigned int      facet;
    NearestPoint<dim> nearest;
  };

  /// A minimum of the distance with its side.
  struct Minimum
  {
    unsigned int                                pair;
    typename SurfaceTopology<dim>::Pseudonormal pseudonormal;
    /// +1 where the pseudonormal points at the point, -1 on the other side, 0 on the surface.
    int side;
  };

  void
  collect_pairs(const PointSet<dim> &points, const Candidates &candidates, const double travel);
  /// Drops pairs out of reach, and sorts each point's by body and key of the facet.
  void arrange_pairs(const PointSet<dim> &points, const double travel);

  void find_on_surface(const PointSet<dim>       &points,
                       const unsigned int         set,
                       const Candidates          &candidates,
                       const Motion              &motion,
                       std::vector<Contact<dim>> &contacts);
  void measure_pairs(const PointSet<dim> &points, const double travel);
  void
  minima_of_body(const dealii::Point<dim> &x_p, const std::size_t begin, const std::size_t end);
  /// For a node of the body itself: what it sees from within is its own far wall and no contact.
  void keep_outer_minima();
  /// Side that the point belongs to, for a sheet kept up to date in its column; 0 where it may be
  /// either.
  int own_side(const PointSet<dim> &points, const unsigned int point, const Minimum &nearest) const;
  void contacts_of_body(const PointSet<dim>       &points,
                        const unsigned int         set,
                        const Motion              &motion,
                        std::vector<Contact<dim>> &contacts) const;

  void nearest_per_facet(const PointSet<dim>       &points,
                         const unsigned int         set,
                         const Motion              &motion,
                         std::vector<Contact<dim>> &contacts);
  void perpendicular_feet(const PointSet<dim>       &points,
                          const unsigned int         set,
                          const Motion              &motion,
                          std::vector<Contact<dim>> &contacts);

  /// Distance beyond which a pair is out of the band [m].
  double reach(const PointSet<dim> &points, const Pair &pair, const double travel) const;
  /// The pair's contact but for normal and gap.
  Contact<dim>
  start_contact(const PointSet<dim> &points, const unsigned int set, const Pair &pair) const;
  /// Velocity of the point against the facet's place [m/s].
  dealii::Tensor<1, dim> relative_velocity(const PointSet<dim> &points, const Pair &pair) const;
  bool                   within_band(const PointSet<dim> &points,
                                     const Pair          &pair,
                                     const Motion        &motion,
                                     const Contact<dim>  &contact) const;

  std::array<dealii::Point<dim>, vertices_per_facet<dim>> vertices(const unsigned int facet) const;

  LocalMethod          method;
  const Surface<dim>  *surface = nullptr;
  SurfaceTopology<dim> connections;

  /// A ball around each facet, and a layer: no part of the facet is farther than `warp` from the
  /// plane through the centre.
  struct Ball
  {
    dealii::Point<dim>     centre;
    double                 radius;
    dealii::Tensor<1, dim> normal;
    double                 warp;
  };
  std::vector<Ball> balls;

  std::vector<Pair>         pairs;
  std::vector<unsigned int> quadrilaterals;
  NearestPointBatch         batch;
  std::vector<Minimum>      minima;
};
} // namespace coracle::contact
