// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/bucket_search.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// Buckets per facet and point that are enough; more would mostly be empty.
constexpr double buckets_per_item = 4;
} // namespace

void
BucketSearch::build(const std::vector<Box> &facet_boxes, const Box &around)
{
  boxes     = &facet_boxes;
  all       = around;
  mean_size = 0;
  for (const Box &box : facet_boxes)
    {
      double size = 0;
      for (int d = 0; d < 3; ++d)
        size = std::max(size, box.upper[d] - box.lower[d]);
      mean_size += size / facet_boxes.size();
    }
}

template <int dim>
void
BucketSearch::find(const PointSet<dim> &points, Candidates &list)
{
  if (boxes->empty())
    return;
  const double radius = collect_points(points);
  if (near.empty())
    return;
  choose_buckets(dim, radius);
  sort_points(points);
  pair_facets(points, radius);
  list_by_point(points, list);
}

// Points that meet the box around all facets; the largest radius among them.
template <int dim>
double
BucketSearch::collect_points(const PointSet<dim> &points)
{
  near.clear();
  double radius = 0;
  for (unsigned int i = 0; i < points.n_points; ++i)
    if (!points.is_hole(i) && overlap(point_box(points, i), all))
      {
        near.push_back(i);
        radius = std::max(radius, points.radius(i));
      }
  return radius;
}

// Eq. 33, with the domain so large that all of these points lie in it.
void
BucketSearch::choose_buckets(const unsigned int dim, const double radius)
{
  domain = all;
  for (unsigned int d = 0; d < dim; ++d)
    {
      domain.lower[d] -= radius;
      domain.upper[d] += radius;
    }
  const double enough = buckets_per_item * (boxes->size() + near.size()) + 1;
  double       size   = mean_size, total;
  do
    {
      total = 1;
      for (int d = 0; d < 3; ++d)
        {
          // Sizes of zero, and quotients beyond the numbers there are, must not reach the cast.
          const double width = domain.upper[d] - domain.lower[d];
          const double count = size > 0 ? std::min(std::max(1., width / size), 2 * enough) : 1.;
          n[d]               = static_cast<unsigned int>(count);
          total *= n[d];
        }
      size *= 1.5;
  } while (total > enough);
}

// Eq. 35. Monotone in x even with round-off, so that ranges of buckets miss nothing.
unsigned int
BucketSearch::index(const double x, const int d) const
{
  const double width = domain.upper[d] - domain.lower[d];
  if (n[d] == 1 || !(x > domain.lower[d]))
    return 0;
  const double place = std::floor(n[d] * ((x - domain.lower[d]) / width));
  return place >= n[d] ? n[d] - 1 : static_cast<unsigned int>(place);
}

// Eq. 34, then a counting sort.
template <int dim>
void
BucketSearch::sort_points(const PointSet<dim> &points)
{
  bucket.resize(near.size());
  sorted.resize(near.size());
  bucket_begin.assign(std::size_t(n[0]) * n[1] * n[2] + 1, 0);
  for (std::size_t i = 0; i < near.size(); ++i)
    {
      unsigned int place = 0;
      for (int d = dim - 1; d >= 0; --d)
        place = place * n[d] + index(points.position[d][near[i]], d);
      bucket[i] = place;
      ++bucket_begin[place + 1];
    }
  for (std::size_t b = 1; b < bucket_begin.size(); ++b)
    bucket_begin[b] += bucket_begin[b - 1];
  auto next = bucket_begin;
  for (std::size_t i = 0; i < near.size(); ++i)
    sorted[next[bucket[i]]++] = near[i];
}

template <int dim>
void
BucketSearch::pair_facets(const PointSet<dim> &points, const double radius)
{
  pairs.clear();
  for (unsigned int f = 0; f < boxes->size(); ++f)
    {
      const Box                  &box = (*boxes)[f];
      std::array<unsigned int, 3> first{{0, 0, 0}}, last{{0, 0, 0}};
      for (int d = 0; d < dim; ++d)
        {
          // Overlap is decided with rounded sums: a few units more, so that none is missed.
          const double margin =
            radius + 8 * std::numeric_limits<double>::epsilon() *
                       (std::abs(box.lower[d]) + std::abs(box.upper[d]) + radius);
          first[d] = index(box.lower[d] - margin, d);
          last[d]  = index(box.upper[d] + margin, d);
        }
      for (unsigned int k = first[2]; k <= last[2]; ++k)
        for (unsigned int j = first[1]; j <= last[1]; ++j)
          {
            // Buckets along x follow one another, and so do their points.
            const std::size_t row = (std::size_t(k) * n[1] + j) * n[0];
            for (std::size_t i = bucket_begin[row + first[0]]; i < bucket_begin[row + last[0] + 1];
                 ++i)
              if (overlap(point_box(points, sorted[i]), box))
                pairs.emplace_back(sorted[i], f);
          }
    }
}

// Pairs come facet by facet; a counting sort by point leaves facets ascending.
template <int dim>
void
BucketSearch::list_by_point(const PointSet<dim> &points, Candidates &list)
{
  pair_begin.assign(points.n_points + 1, 0);
  for (const auto &[point, facet] : pairs)
    ++pair_begin[point + 1];
  for (unsigned int i = 0; i < points.n_points; ++i)
    pair_begin[i + 1] += pair_begin[i];
  list.facet.resize(pairs.size());
  for (const auto &[point, facet] : pairs)
    list.facet[pair_begin[point]++] = facet;
  // Each entry now tells where its point's facets end.
  for (const unsigned int i : near)
    if (pair_begin[i] > list.begin.back())
      {
        list.point.push_back(i);
        list.begin.push_back(pair_begin[i]);
      }
}

template void BucketSearch::find(const PointSet<2> &, Candidates &);
template void BucketSearch::find(const PointSet<3> &, Candidates &);
} // namespace coracle::contact
