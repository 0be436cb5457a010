// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/nearest_point_strips.h>

namespace coracle::contact
{
namespace
{
double
norm(const Vector<3, double> &a)
{
  return std::sqrt(dot(a, a));
}

Vector<3, double>
evaluate(const Bilinear<double> &f, const double xi, const double eta)
{
  Vector<3, double> x;
  for (int d = 0; d < 3; ++d)
    x[d] = f.r[d] + xi * f.b[d] + eta * (f.c[d] + xi * f.h[d]);
  return x;
}

/// The part [xi - dx, xi + dx] x [eta - dy, eta + dy] as a facet of its own.
Bilinear<double>
part(const Bilinear<double>     &f,
     const NaturalPoint<double> &middle,
     const double                dx,
     const double                dy)
{
  Bilinear<double> g;
  for (int d = 0; d < 3; ++d)
    {
      g.r[d] = f.r[d] + middle.xi * f.b[d] + middle.eta * (f.c[d] + middle.xi * f.h[d]);
      g.b[d] = dx * (f.b[d] + middle.eta * f.h[d]);
      g.c[d] = dy * (f.c[d] + middle.xi * f.h[d]);
      g.h[d] = dx * dy * f.h[d];
    }
  return g;
}

/// The same facet with xi and eta exchanged.
Bilinear<double>
transposed(const Bilinear<double> &f)
{
  return {f.r, f.c, f.b, f.h};
}

/**
 * Sign of d|x - x_p|^2/d eta if it is the same on the whole square, else 0.
 * The derivative grows with eta and is a parabola in xi.
 */
int
slope_sign(const Bilinear<double> &f)
{
  const auto extreme = [&f](const double eta, const double sign) {
    // sign * derivative at xi, its smallest value on [-1,1]
    Vector<3, double> a, b;
    for (int d = 0; d < 3; ++d)
      {
        a[d] = f.r[d] + eta * f.c[d];
        b[d] = f.b[d] + eta * f.h[d];
      }
    const double q0 = sign * dot(a, f.c), q1 = sign * (dot(b, f.c) + dot(a, f.h)),
                 q2 = sign * dot(b, f.h);
    double smallest = q0 + q2 - std::abs(q1);
    if (q2 > 0 && std::abs(q1) < 2 * q2)
      smallest = q0 - 0.25 * q1 * q1 / q2;
    return smallest;
  };
  return extreme(-1, 1) > 0 ? 1 : (extreme(1, -1) > 0 ? -1 : 0);
}

class Search
{
public:
  explicit Search(const Bilinear<double> &facet)
    : facet(facet), tolerance(1e-10 * (norm(facet.b) + norm(facet.c) + norm(facet.h)))
  {
    for (const double eta : {-1., 1., 0.})
      offer({best_xi(facet, eta), eta});
    offer(minimise_convex(facet));
  }

  void examine(const double eta, const double half_width)
  {
    const Bilinear<double> strip = part(facet, {0, eta}, 1, half_width);
    offer({best_xi(strip, 0.), eta});

    // No point of the strip is farther than `reach` from the point of its middle line with the same
    // xi.
    const double reach    = std::max(norm(evaluate({strip.c, strip.h, {}, {}}, 1, 0)),
                                  norm(evaluate({strip.c, strip.h, {}, {}}, -1, 0)));
    const double distance = norm(evaluate(strip, best_xi(strip, 0.), 0));
    if (distance - reach > best_distance - tolerance || half_width < 1e-12)
      return;

    const auto   range = xi_range(strip, best_distance + reach);
    const double xi = 0.5 * (range[0] + range[1]), dx = 0.5 * (range[1] - range[0]);
    const auto   box  = part(strip, {xi, 0}, dx, 1);
    const auto   take = [&](const double box_xi, const double box_eta) {
      offer({xi + dx * box_xi, eta + half_width * box_eta});
    };
    if (const int sign = slope_sign(box))
      return take(best_xi(box, double(-sign)), -sign);
    if (const int sign = slope_sign(transposed(box)))
      return take(-sign, best_xi(transposed(box), double(-sign)));
    if (convexity(box) >= 0.)
      {
        const auto found = minimise_convex(box);
        return take(found.xi, found.eta);
      }
    examine(eta - 0.5 * half_width, 0.5 * half_width);
    examine(eta + 0.5 * half_width, 0.5 * half_width);
  }

  NaturalPoint<double> result() const { return best; }

private:
  void offer(const NaturalPoint<double> &candidate)
  {
    const double distance = norm(evaluate(facet, candidate.xi, candidate.eta));
    if (distance < best_distance)
      {
        best_distance = distance;
        best          = candidate;
      }
  }

  /// Where the strip's middle line is nearer to the point than `distance`.
  static std::array<double, 2> xi_range(const Bilinear<double> &strip, const double distance)
  {
    const double bb = dot(strip.b, strip.b) + 1e-300, xi = -dot(strip.r, strip.b) / bb;
    const auto   foot   = evaluate(strip, xi, 0);
    const double square = std::max(0., distance * distance - dot(foot, foot)) / bb;
    const double dx     = 1.0000001 * std::sqrt(square) + 1e-12;
    return {{clamp(xi - dx, -1., 1.), clamp(xi + dx, -1., 1.)}};
  }

  const Bilinear<double> &facet;
  const double            tolerance;
  NaturalPoint<double>    best{0, 0};
  double                  best_distance = 1e300;
};
} // namespace

NaturalPoint<double>
minimise_by_strips(const Bilinear<double> &facet)
{
  Search search(facet);
  search.examine(0, 1);
  return search.result();
}
} // namespace coracle::contact
