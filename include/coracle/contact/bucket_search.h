// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/candidates.h>

#include <utility>

namespace coracle::contact
{
/**
 * Global search by bucket sorting: the box around all facets is cut into equal
 * buckets of about the mean size of a facet, points near the surface are
 * sorted into them, and each facet looks at the points of the buckets that its
 * box meets.
 *
 *   I = I_z N_x N_y + I_y N_x + I_x,  I_x = floor(N_x (x - x_min)/(x_max - x_min))
 *
 * What lies on x_max belongs to the last bucket. Unlike in the paper, facets
 * larger than a bucket look into all they reach, and pairs are kept as long as
 * the skin lasts instead of one step.
 *
 * There are never many more buckets than facets and points, so that memory
 * stays proportional to these, however small a facet is. The cost grows as
 * points times facets per bucket.
 *
 * Source: Chen, Qiu, Zhang, Lian & Liu (2015), section 3.1, Eqs. 33-35.
 */
class BucketSearch
{
public:
  /// The facets' boxes, and the box around them all; both stay the caller's.
  void build(const std::vector<Box> &boxes, const Box &all);

  template <int dim>
  void find(const PointSet<dim> &points, Candidates &list);

  /// Number of buckets in each direction at the last find().
  const std::array<unsigned int, 3> &n_buckets() const { return n; }

private:
  template <int dim>
  double collect_points(const PointSet<dim> &points);
  void   choose_buckets(const unsigned int dim, const double radius);
  template <int dim>
  void sort_points(const PointSet<dim> &points);
  template <int dim>
  void pair_facets(const PointSet<dim> &points, const double radius);
  template <int dim>
  void list_by_point(const PointSet<dim> &points, Candidates &list);

  unsigned int index(const double x, const int d) const;

  const std::vector<Box> *boxes = nullptr;
  Box                     all, domain;
  double                  mean_size = 0;

  std::array<unsigned int, 3> n{{1, 1, 1}};
  /// Points near the surface; bucket of each; the same points by bucket.
  std::vector<unsigned int> near, bucket, sorted;
  std::vector<std::size_t>  bucket_begin, pair_begin;
  /// Point and facet.
  std::vector<std::pair<unsigned int, unsigned int>> pairs;
};
} // namespace coracle::contact
