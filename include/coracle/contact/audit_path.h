// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/surface.h>

#include <array>
#include <vector>

namespace coracle::contact
{
/// Places at the start and at the end of a step; straight in between.
template <int dim>
using Path = std::array<dealii::Point<dim>, 2>;

/// Vertices of a segment (2-D) or triangle (3-D) at the start and at the end of a step.
template <int dim>
using MovingSimplex = std::array<std::array<dealii::Point<dim>, dim>, 2>;

/// A facet near a path.
template <int dim>
struct MovingFacet
{
  /// In the surface, and its nodes there.
  unsigned int                                      index;
  std::array<unsigned int, vertices_per_facet<dim>> nodes;
  /// Of the vertices at the start and at the end.
  std::array<std::array<dealii::Point<dim>, vertices_per_facet<dim>>, 2> x;
  // What follows PathAudit::add works out.
  /// Extent then, or 1e-3 of the coordinates if these are that much larger: what lengths round-off
  /// is small against [m].
  std::array<double, 2> size;
  /// May the path's start or end be on it?
  std::array<bool, 2> may_touch;
};

/// One meeting of a path with a facet.
template <int dim>
struct PathEvent
{
  double time;
  /// +1: from the side of the normal to the other; -1: the other way.
  int direction;
  /// Index among the facets near the path, and the part of it that was met.
  unsigned int       facet;
  MovingSimplex<dim> simplex;
};

/**
 * Meetings of a path with a simplex, appended to `events` with this `facet`.
 *
 * @param doubt a length that errors of round-off in places are below [m]
 * @return false where such an error may decide whether there is a meeting: near an edge, or where
 *   the path touches the plane
 */
template <int dim>
bool meet_simplex(const Path<dim>             &path,
                  const MovingSimplex<dim>    &x,
                  const double                 doubt,
                  const unsigned int           facet,
                  std::vector<PathEvent<dim>> &events);

/// Unit normal of the simplex if the point is nearer to it than `distance`; else 0.
template <int dim>
dealii::Tensor<1, dim> normal_if_on(const dealii::Point<dim>                  &p,
                                    const std::array<dealii::Point<dim>, dim> &x,
                                    const double                               distance);

/// Distance of the path from the plane of the simplex at a time in [0, 1]; positive where the
/// normal points.
template <int dim>
double distance_from_plane(const Path<dim> &path, const MovingSimplex<dim> &x, const double time);

/**
 * Meetings of one point's path with one body's facets.
 *
 * A point that starts or ends on the surface is thought moved off it, to the
 * side that it belongs to, by a rule that knows nothing of the step, so that the next step
 * starts where this one ended. Where round-off could decide whether a facet
 * is met, or which of two neighbours, the whole path is thought moved a little
 * until it cannot; what such a path touches, and no deeper than it was moved,
 * counts as not met. So the meetings of a path that comes to the other side of a
 * body or sheet always add up to one.
 */
template <int dim>
class PathAudit
{
public:
  /// Forgets all facets.
  void begin(const Path<dim> &path);

  /// One more facet of the body, if it can be met at all.
  void add(const MovingFacet<dim> &facet);

  /**
   * Meetings, in the order of time.
   * @param side that the point belongs to: +1 where normals point, -1, or 0 if that is not known;
   * it then comes from where it does not go
   */
  const std::vector<PathEvent<dim>> &meetings(const int side);

  const MovingFacet<dim> &facet(const PathEvent<dim> &event) const { return near[event.facet]; }

private:
  void                   touch(const unsigned int end);
  dealii::Tensor<1, dim> way_off(const unsigned int end, const int side);
  int                    side_of_touched() const;
  bool                   in_valley(const int side) const;
  bool                   meet_all(const Path<dim> &moved, const double doubt);
  void                   drop_touches(const Path<dim> &moved, const double depth);

  Path<dim>                     path;
  double                        length = 0;
  std::vector<MovingFacet<dim>> near;
  std::vector<PathEvent<dim>>   events, most;

  /// A simplex that the point is on or beside: unit normal, unit vector towards the middle, index
  /// in near; height of the point above it [m].
  struct Touched
  {
    dealii::Tensor<1, dim> normal, inward;
    unsigned int           facet;
    bool                   is_on;
    double                 height;
  };
  std::vector<Touched> touched;
};
} // namespace coracle::contact
