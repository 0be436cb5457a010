// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest point of a facet is never another local minimum: against the real
// roots of the quintic that its stationary points satisfy, on a million pairs
// with facets that are flat, warped, collapsed or thin; and each Voronoi region is named rightly.

#include <coracle/contact/nearest_point.h>

#include <random>

#include "../tests.h"

using namespace coracle::contact;
using Point  = dealii::Point<3>;
using Facet4 = std::array<Point, 4>;

/// Polynomials, lowest power first.
using Polynomial = std::vector<double>;

Polynomial
operator*(const Polynomial &a, const Polynomial &b)
{
  Polynomial c(a.size() + b.size() - 1);
  for (unsigned int i = 0; i < a.size(); ++i)
    for (unsigned int j = 0; j < b.size(); ++j)
      c[i + j] += a[i] * b[j];
  return c;
}

Polynomial
derivative(const Polynomial &a)
{
  Polynomial c;
  for (unsigned int i = 1; i < a.size(); ++i)
    c.push_back(i * a[i]);
  return c;
}

double
value(const Polynomial &a, const double x)
{
  double result = 0;
  for (unsigned int i = a.size(); i-- > 0;)
    result = result * x + a[i];
  return result;
}

/// Real roots in [-1, 1] (and the zeros of all derivatives, which do no harm).
std::vector<double>
roots(const Polynomial &a)
{
  if (a.size() < 2)
    return {};
  std::vector<double> result, stops = roots(derivative(a));
  result = stops;
  stops.push_back(-1);
  stops.push_back(1);
  std::sort(stops.begin(), stops.end());
  for (unsigned int i = 0; i + 1 < stops.size(); ++i)
    {
      double low = stops[i], high = stops[i + 1];
      if (value(a, low) * value(a, high) >= 0)
        continue;
      const bool rising = value(a, high) > 0;
      for (unsigned int k = 0; k < 50; ++k)
        ((value(a, 0.5 * (low + high)) > 0) == rising ? high : low) = 0.5 * (low + high);
      result.push_back(0.5 * (low + high));
    }
  return result;
}

double
distance_to_segment(const Point &p, const Point &a, const Point &b)
{
  const double length = (b - a).norm_square();
  const double s      = length > 0 ? std::max(0., std::min(1., (p - a) * (b - a) / length)) : 0.;
  return p.distance(a + s * (b - a));
}

double
oracle(const Point &p, const Facet4 &x)
{
  // x = a0 + eta a1 + xi (b0 + eta b1)
  const dealii::Tensor<1, 3> a0 = 0.25 * ((x[0] - p) + (x[1] - p) + (x[2] - p) + (x[3] - p)),
                             a1 = 0.25 * ((x[2] - x[0]) + (x[3] - x[1])),
                             b0 = 0.25 * ((x[1] - x[0]) + (x[2] - x[3])),
                             b1 = 0.25 * ((x[0] - x[1]) + (x[2] - x[3]));
  const Polynomial A = {a0 * a0, 2 * (a0 * a1), a1 * a1}, B = {b0 * b0, 2 * (b0 * b1), b1 * b1},
                   q = {-(a0 * b0), -(a0 * b1) - a1 * b0, -(a1 * b1)};
  Polynomial quintic = derivative(A) * B * B;
  const auto second = q * derivative(q) * B, third = q * q * derivative(B);
  for (unsigned int i = 0; i < quintic.size(); ++i)
    quintic[i] += third[i] - 2 * second[i];

  double best = std::numeric_limits<double>::max();
  for (unsigned int k = 0; k < 4; ++k)
    best = std::min(best, distance_to_segment(p, x[k], x[(k + 1) % 4]));
  for (const double eta : roots(quintic))
    {
      const double bb = value(B, eta), xi = bb > 0 ? value(q, eta) / bb : 0.;
      if (std::abs(xi) <= 1)
        best = std::min(best, (a0 + eta * a1 + xi * (b0 + eta * b1)).norm());
    }
  return best;
}

std::mt19937                     generator(20);
std::uniform_real_distribution<> uniform(-1, 1);

Point
random_point()
{
  return Point(uniform(generator), uniform(generator), uniform(generator));
}

void
compare(const std::string                   &name,
        const unsigned int                   n,
        const double                         warp,
        const std::function<void(Facet4 &)> &spoil)
{
  const Facet4 square = {
    {Point(-.5, -.5, 0), Point(.5, -.5, 0), Point(.5, .5, 0), Point(-.5, .5, 0)}};
  double worst = 0;
  for (unsigned int i = 0; i < n; ++i)
    {
      Facet4 x = square;
      for (auto &v : x)
        v += warp * random_point();
      spoil(x);
      // Points all around, and some exactly on the facet's diagonal surface line.
      const Point p =
        (i % 8 == 0 ? x[0] + 0.5 * (1 + uniform(generator)) * (x[1] - x[0]) : random_point());
      const double found = std::sqrt(nearest_point(p, x).distance_square);
      worst              = std::max(worst, std::abs(found - oracle(p, x)));
    }
  deallog << name << ": agrees to 1e-9: " << (worst < 1e-9) << std::endl;
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
      worst = std::max(worst, std::abs(std::sqrt(found.distance_square) - oracle(p, x)));
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
  const auto nothing = [](Facet4 &) {};
  compare("flat square", 100000, 0, nothing);
  compare("slightly warped", 200000, 0.05, nothing);
  compare("warped", 200000, 0.3, nothing);
  compare("badly warped", 200000, 1, nothing);
  compare("any four points", 50000, 5, nothing);
  compare("two equal corners", 100000, 0.3, [](Facet4 &x) { x[2] = x[1]; });
  compare("opposite corners equal", 20000, 0.3, [](Facet4 &x) { x[2] = x[0]; });
  compare("collapsed to an edge", 100000, 0.3, [](Facet4 &x) {
    x[3] = x[0];
    x[2] = x[1];
  });
  compare("nearly collapsed", 20000, 0.3, [](Facet4 &x) {
    x[3] = x[0] + 1e-9 * random_point();
    x[2] = x[1] + 1e-9 * random_point();
  });
  compare("collapsed to a point", 20000, 0.3, [](Facet4 &x) { x[1] = x[2] = x[3] = x[0]; });
  for (const double scale : {1., 1000.})
    for (const double offset : {0., 1e-12, -1e-12})
      regions(scale, offset);
  triangles_and_segments();
}
