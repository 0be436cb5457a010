// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/global_minimum.h>
#include <coracle/contact/local_minimum.h>
#include <coracle/contact/nearest_point_boxes.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
using Bilinear1 = Bilinear<double>;

double
norm(const Vector<3, double> &a)
{
  return std::sqrt(dot(a, a));
}

/// The box [xi - dx, xi + dx] x [eta - dy, eta + dy] in natural coordinates.
struct NaturalBox
{
  double xi, eta, dx, dy;

  NaturalPoint<double> point(const NaturalPoint<double> &inner) const
  {
    return {clamp(xi + dx * inner.xi, -1., 1.), clamp(eta + dy * inner.eta, -1., 1.)};
  }
};

/// The box as a facet of its own.
Bilinear1
part(const Bilinear1 &f, const NaturalBox &box)
{
  const auto middle = evaluate(f, {box.xi, box.eta});
  Bilinear1  g;
  for (int d = 0; d < 3; ++d)
    {
      g.r[d] = middle.place[d];
      g.b[d] = box.dx * middle.t_xi[d];
      g.c[d] = box.dy * middle.t_eta[d];
      g.h[d] = box.dx * box.dy * f.h[d];
    }
  return g;
}

class BoxSearch
{
public:
  BoxSearch(const Bilinear1 &facet, const NaturalPoint<double> &start)
    : facet(facet), best(start), best_distance(norm(evaluate(facet, start).place))
  {}

  void examine(const NaturalBox &box)
  {
    const auto   g = part(facet, box);
    const double b = norm(g.b), c = norm(g.c);
    if (norm(g.r) - (b + c + norm(g.h)) > best_distance || std::max(box.dx, box.dy) < smallest_box)
      return;
    const DistanceAlongEta<double> distance(g);
    const auto                     found = local_minimum(g, distance, best_sample<3>(distance));
    const auto                     proof = prove_global(g, found, 6);
    if (proof.distance_square < best_distance * best_distance)
      {
        best          = box.point(found);
        best_distance = std::sqrt(proof.distance_square);
      }
    if (proof.holds > 0)
      return;
    const bool   along_xi = b > c;
    const double dx = (along_xi ? 0.5 : 1) * box.dx, dy = (along_xi ? 1 : 0.5) * box.dy;
    for (const int side : {-1, 1})
      examine({box.xi + (along_xi ? side * dx : 0), box.eta + (along_xi ? 0 : side * dy), dx, dy});
  }

  NaturalPoint<double> result() const { return best; }

private:
  /// What a box this small may hide is of the order of its size squared.
  static constexpr double smallest_box = 1e-6;

  const Bilinear1     &facet;
  NaturalPoint<double> best;
  double               best_distance;
};
} // namespace

NaturalPoint<double>
nearest_point_boxes(const Bilinear<double> &facet, const NaturalPoint<double> &best)
{
  BoxSearch search(facet, best);
  search.examine({0, 0, 1, 1});
  return search.result();
}
} // namespace coracle::contact
