// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/contact/audit_path.h>
#include <coracle/contact/global_search.h>

namespace coracle::contact
{
/// A point that went through a facet.
template <int dim>
struct Crossing
{
  std::uint64_t id;
  /// Where it went through [m], and when within the step [1].
  dealii::Point<dim> place;
  double             time;
  unsigned int       body;
  std::uint64_t      facet_key;
  /// Index of the point set and of the point in it, until points are renumbered.
  unsigned int set, point;
  /// The side of the facet that the point left: +1 where the normal points.
  int side;
};

/**
 * Independent check that no point passes through a surface: the straight path of
 * each candidate point from the start to the end of a step against the facets,
 * whose nodes move on straight paths likewise. Shares no code with the local
 * search or the solver. A bilinear facet is taken as four triangles around its
 * middle, or the parts of it near the path are, so that no triangle is farther
 * from it than 1e-9 of its size.
 *
 * Where the path meets a facet's moving plane is a root of a quadratic (2-D) or
 * cubic (3-D) in time. A closed body is crossed from outside only, a sheet both
 * ways. A point nearer than 4e-9 of the facet's size at an end of the step is
 * still on the side that it belongs to: one that starts exactly on the surface
 * and goes in is counted, one that ends on it is not until it goes on. How edges
 * and vertices are met says PathAudit; what counts, section "Audit" of doc/theory.md.
 */
template <int dim>
class Audit
{
public:
  /// At the start of the step: keeps what it needs of positions. Facets and candidates must be the
  /// same at finish().
  void start(const Surface<dim>                    &surface,
             const std::vector<PointSet<dim>>      &points,
             const std::vector<const Candidates *> &candidates);

  /// At the end of the step, before points are renumbered or their sides forgotten.
  /// @return number of crossings of this rank's points in this step
  unsigned int finish(const Surface<dim> &surface, const std::vector<PointSet<dim>> &points);

  /// All crossings since the start of the run on this rank, and the first few of them.
  unsigned long                     n_crossings() const { return total; }
  const std::vector<Crossing<dim>> &first_crossings() const { return first; }

  /// Of the last step, on this rank.
  const std::vector<Crossing<dim>> &crossings() const { return last; }

  /// How many there were; the first ones are forgotten.
  void serialize(Archive &archive) { archive.share("n_crossings", total); }

  static constexpr unsigned int n_kept = 5;

private:
  /// Facets of one point among the candidates.
  struct CandidateRange
  {
    const unsigned int *facet;
    std::size_t         begin, end;
  };
  void
  add_facets(const Surface<dim> &surface, const unsigned int body, const CandidateRange &range);
  /// -1, +1, or 0 where the point may belong to either.
  static int
  side_of(const SurfaceBody &body, const PointSet<dim> &points, const unsigned int point);

  PathAudit<dim>                               path_audit;
  std::vector<dealii::Point<dim>>              nodes;
  std::vector<std::vector<dealii::Point<dim>>> starts;
  std::vector<const Candidates *>              candidates;
  std::vector<Crossing<dim>>                   first, last;
  unsigned long                                total = 0;
};
} // namespace coracle::contact
