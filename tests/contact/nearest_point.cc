// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest point of a facet is never another local minimum: against the real
// roots of the quintic that its stationary points satisfy, on a million pairs
// with facets that are flat, warped, collapsed or thin; a pair's result does not depend on its
// neighbours in a pack; and each Voronoi region is named rightly.

#include <coracle/contact/nearest_point.h>

#include "../tests.h"
#include "quintic_oracle.h"

using namespace coracle::contact;
using quintic_oracle::Corners;
using quintic_oracle::Shape;
using Point  = dealii::Point<3>;
using Facet4 = std::array<Point, 4>;

quintic_oracle::Random random_number(20);

Point
random_point()
{
  const auto x = random_number.point();
  return Point(x[0], x[1], x[2]);
}

/// Points all around the facet, and some exactly on one of its edges.
std::vector<Corners>
random_pairs(const Shape shape, const unsigned int n)
{
  std::vector<Corners> pairs(n);
  for (unsigned int i = 0; i < n; ++i)
    {
      pairs[i]        = random_number.facet(shape);
      auto         p  = random_number.point();
      const double s  = 0.5 * (1 + random_number());
      const auto  &x0 = pairs[i][0], &x1 = pairs[i][1];
      if (i % 8 == 0)
        for (int d = 0; d < 3; ++d)
          p[d] = x0[d] + s * (x1[d] - x0[d]);
      for (auto &corner : pairs[i])
        for (int d = 0; d < 3; ++d)
          corner[d] -= p[d];
    }
  return pairs;
}

using Result = std::array<double, 3>;

std::vector<Result>
nearest_of(const std::vector<Corners> &pairs)
{
  std::vector<Result> results(pairs.size());
  NearestPointBatch   batch;
  batch.find(
    pairs.size(),
    [&](const std::size_t i) { return pairs[i]; },
    [&](const std::size_t i, const double xi, const double eta, const double square) {
      results[i] = {{xi, eta, square}};
    });
  return results;
}

void
compare(const Shape shape, const unsigned int n)
{
  auto       pairs   = random_pairs(shape, n);
  const auto results = nearest_of(pairs);
  double     worst   = 0;
  for (unsigned int i = 0; i < n; ++i)
    worst =
      std::max(worst, std::abs(std::sqrt(results[i][2]) - quintic_oracle::distance(pairs[i])));

  // Alone, and in another order, to the last bit.
  unsigned int differ = 0;
  for (unsigned int i = 0; i < 1000; ++i)
    {
      const auto alone = nearest_natural_point(pairs[i]);
      differ += !(alone.xi == results[i][0] && alone.eta == results[i][1]);
    }
  std::reverse(pairs.begin(), pairs.end());
  const auto reversed = nearest_of(pairs);
  for (unsigned int i = 0; i < n; ++i)
    differ += (reversed[n - 1 - i] != results[i]);
  deallog << quintic_oracle::name(shape) << ": agrees to 1e-10: " << (worst < 1e-10)
          << ", depends on neighbours: " << differ << std::endl;
}

void
regions(const double scale, const double offset)
{
  // 3 by 3 regions of a square, below and above; corners and edges by their start corner.
  const int    expected_feature[3][3] = {{0, 0, 1}, {3, 0, 1}, {3, 2, 2}};
  const double places[3]              = {-1.5, 0.3, 1.5};
  unsigned int wrong                  = 0;
  const Facet4 x                      = {{scale * Point(-1, -1, 0),
                                          scale * Point(1, -1, 0),
                                          scale * Point(1, 1, 0),
                                          scale * Point(-1, 1, 0)}};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      for (const double z : {-0.7, 0., 0.7})
        {
          const Point  p     = scale * Point(places[i] + offset, places[j] - offset, z);
          const auto   found = nearest_point(p, x);
          const Region region =
            (i == 1 && j == 1 ? Region::interior
                              : (i == 1 || j == 1 ? Region::edge : Region::vertex));
          wrong += (found.region != region ||
                    (region != Region::interior && found.feature != expected_feature[j][i]));
          const Point exact = scale * Point(std::min(1., std::max(-1., p[0] / scale)),
                                            std::min(1., std::max(-1., p[1] / scale)),
                                            0);
          wrong += !(found.place.distance(exact) < 1e-13 * scale);
        }
  // Above an edge and a vertex, up to round-off: still the edge and the vertex.
  const auto edge   = nearest_point(scale * Point(1 + offset, 0.2, 0.3), x);
  const auto vertex = nearest_point(scale * Point(1 + offset, -1 + offset, 0.3), x);
  wrong += (edge.region != Region::edge || edge.feature != 1) +
           (vertex.region != Region::vertex || vertex.feature != 1);
  deallog << "regions, scale " << scale << ", offset " << offset << ": wrong " << wrong
          << std::endl;
}

void
triangles_and_segments()
{
  unsigned int wrong = 0;
  double       worst = 0;
  for (unsigned int i = 0; i < 100000; ++i)
    {
      // A triangle as a facet with a repeated node, against the quadrilateral with two equal
      // corners.
      Facet4 x = {{random_point(), random_point(), random_point(), Point()}};
      x[3]     = x[2];
      if (i % 10 == 0)
        x[1] = x[0] + 0.3 * (x[2] - x[0]); // no area
      const Point p     = random_point();
      const auto  found = nearest_point_triangle(p, x);
      worst             = std::max(worst,
                       std::abs(std::sqrt(found.distance_square) -
                                quintic_oracle::distance(relative_corners(p, x))));
      wrong += (found.weights[3] != 0);
    }
  const std::array<dealii::Point<2>, 2> segment = {
    {dealii::Point<2>(0, 0), dealii::Point<2>(2, 0)}};
  for (const double offset : {0., 1e-12, -1e-12})
    {
      wrong += (nearest_point(dealii::Point<2>(offset, 1), segment).region != Region::vertex);
      wrong += (nearest_point(dealii::Point<2>(2 + offset, 1), segment).feature != 1);
      wrong += (nearest_point(dealii::Point<2>(1 + offset, 1), segment).region != Region::interior);
    }
  deallog << "triangles agree to 1e-9: " << (worst < 1e-9) << ", wrong " << wrong << std::endl;
}

int
main()
{
  initlog();
  for (const Shape shape : {Shape::quadrants, Shape::badly_warped, Shape::warped})
    compare(shape, 200000);
  for (const Shape shape :
       {Shape::flat, Shape::lightly_warped, Shape::sliver, Shape::needle, Shape::edge})
    compare(shape, 100000);
  for (const Shape shape : {Shape::any, Shape::pinched, Shape::nearly_edge, Shape::point})
    compare(shape, 20000);
  for (const double scale : {1., 1000.})
    for (const double offset : {0., 1e-12, -1e-12})
      regions(scale, offset);
  triangles_and_segments();
}
