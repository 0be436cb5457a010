// SPDX-License-Identifier: GPL-3.0-or-later
// The penetration audit counts what a sub-stepping oracle counts, for random
// steps of points and moving, deforming bodies; paths through edges and vertices
// count once, also where these are saddles; points that rest on the surface for
// some steps are counted when they go in, once, and not when they leave.

#include <coracle/contact/audit.h>

#include "scene.h"

using namespace scene;

std::mt19937                     generator(11);
std::uniform_real_distribution<> uniform(-1, 1);

template <int dim>
dealii::Point<dim>
random_point(const double size)
{
  dealii::Point<dim> x;
  for (int d = 0; d < dim; ++d)
    x[d] = size * uniform(generator);
  return x;
}

/// A simplex as a body, outward facets.
template <int dim>
Surface<dim>
simplex_body(const std::array<dealii::Point<dim>, dim + 1> &x, const SurfaceKind kind)
{
  auto s = one_body<dim>(kind);
  for (const auto &p : x)
    add_node<dim>(s, p);
  if constexpr (dim == 2)
    {
      add_facet<2>(s, {{0, 1}});
      add_facet<2>(s, {{1, 2}});
      add_facet<2>(s, {{2, 0}});
    }
  else
    {
      add_facet<3>(s, {{0, 2, 1, 1}});
      add_facet<3>(s, {{0, 1, 3, 3}});
      add_facet<3>(s, {{1, 2, 3, 3}});
      add_facet<3>(s, {{2, 0, 3, 3}});
    }
  return s;
}

template <int dim>
double
volume(const std::array<dealii::Point<dim>, dim + 1> &x)
{
  if constexpr (dim == 2)
    return dealii::cross_product_2d(x[2] - x[0]) * (x[1] - x[0]);
  else
    return dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]) * (x[3] - x[0]);
}

/// Is p in the simplex? By the signs of the parts it makes of it.
template <int dim>
bool
inside(const dealii::Point<dim> &p, const std::array<dealii::Point<dim>, dim + 1> &x)
{
  const double all    = volume<dim>(x);
  bool         result = true;
  for (unsigned int k = 0; k <= dim; ++k)
    {
      auto y = x;
      y[k]   = p;
      result = result && volume<dim>(y) * all > 0;
    }
  return result;
}

/// Crossings of one step with all facets as candidates.
template <int dim>
unsigned int
count(Surface<dim>                          &s,
      const std::vector<dealii::Point<dim>> &end,
      const dealii::Point<dim>              &p0,
      const dealii::Point<dim>              &p1,
      const double                           side = 0)
{
  Points<dim> points;
  points.add(p0, dealii::Tensor<1, dim>());
  points.side[0] = side;
  Candidates candidates;
  candidates.point = {0};
  for (unsigned int f = 0; f < s.facets.size(); ++f)
    candidates.facet.push_back(f);
  candidates.begin.push_back(s.facets.size());
  Audit<dim>                       audit;
  const std::vector<PointSet<dim>> sets = {points.set()};
  audit.start(s, sets, {&candidates});
  points.move(0, p1 - p0);
  for (unsigned int i = 0; i < end.size(); ++i)
    s.nodes[i].position = end[i];
  return audit.finish(s, sets);
}

template <int dim>
void
random_steps(const unsigned int n, const unsigned int n_substeps)
{
  unsigned long odd = 0, fewer = 0, wrong_inward = 0, crossings = 0;
  for (unsigned int i = 0; i < n; ++i)
    {
      std::array<std::array<dealii::Point<dim>, dim + 1>, 2> x;
      for (unsigned int k = 0; k <= dim; ++k)
        {
          x[0][k] = random_point<dim>(1);
          x[1][k] = x[0][k] + random_point<dim>(0.3);
        }
      if (volume<dim>(x[0]) < 0)
        {
          std::swap(x[0][0], x[0][1]);
          std::swap(x[1][0], x[1][1]);
        }
      // A body turned inside out has no inside.
      if (volume<dim>(x[0]) < 0.05 || volume<dim>(x[1]) < 0.05)
        continue;
      const auto p0 = random_point<dim>(0.7), p1 = p0 + random_point<dim>(0.7);
      const std::vector<dealii::Point<dim>> end(x[1].begin(), x[1].end());

      // Oracle: inside or outside, sub-step by sub-step.
      unsigned int inward = 0, both = 0;
      bool         valid = true, old = inside<dim>(p0, x[0]);
      const bool   first = old;
      for (unsigned int k = 1; k <= n_substeps; ++k)
        {
          const double                            t = double(k) / n_substeps;
          std::array<dealii::Point<dim>, dim + 1> y;
          for (unsigned int j = 0; j <= dim; ++j)
            y[j] = x[0][j] + t * (x[1][j] - x[0][j]);
          const bool now = inside<dim>(p0 + t * (p1 - p0), y);
          valid          = valid && volume<dim>(y) > 0.01;
          inward += (now && !old);
          both += (now != old);
          old = now;
        }
      if (!valid)
        continue;
      auto sheet                 = simplex_body<dim>(x[0], SurfaceKind::sheet),
           body                  = simplex_body<dim>(x[0], SurfaceKind::closed);
      const unsigned int n_sheet = count<dim>(sheet, end, p0, p1),
                         n_body  = count<dim>(body, end, p0, p1);
      crossings += n_sheet;
      odd += ((n_sheet % 2 == 1) != (first != old));
      fewer += (n_sheet < both || n_body < inward);
      wrong_inward += (n_body != (n_sheet + (first ? 0 : 1)) / 2);
    }
  deallog << dim << "-D: enough crossings " << (crossings > n / 10) << ", parity wrong " << odd
          << ", missed " << fewer << ", inward not half of all " << wrong_inward << std::endl;
}

/// The polytope with vertices at these distances on the axes, as triangles (2-D: segments), at
/// rest.
template <int dim>
Surface<dim>
star(const std::array<double, 2 * dim> &radii)
{
  auto s = one_body<dim>(SurfaceKind::closed);
  for (int i = 0; i < 2 * dim; ++i)
    {
      dealii::Point<dim> x;
      x[i / 2] = (i % 2 == 0 ? 1 : -1) * radii[i];
      add_node<dim>(s, x);
    }
  if constexpr (dim == 2)
    for (const auto &f : {std::array<unsigned int, 2>{{0, 2}}, {{2, 1}}, {{1, 3}}, {{3, 0}}})
      add_facet<2>(s, f);
  else
    for (unsigned int i = 0; i < 8; ++i)
      {
        const unsigned int a = i & 1, b = 2 + ((i >> 1) & 1), c = 4 + (i >> 2);
        const bool         even = (a + b + c) % 2 == 0;
        add_facet<3>(s, {{a, even ? b : c, even ? c : b, even ? c : b}});
      }
  return s;
}

/// Through vertices, edges and faces towards the centre, and out of it; from exactly on the
/// surface.
template <int dim>
unsigned int
n_wrong_radial_paths(Surface<dim> &s)
{
  unsigned int wrong = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = (dim == 3 ? -1 : 0); k <= (dim == 3 ? 1 : 0); ++k)
        {
          const int          along[] = {i, j, k};
          const double       n       = std::abs(i) + std::abs(j) + std::abs(k);
          dealii::Point<dim> on;
          for (int d = 0; d < dim; ++d)
            if (along[d] != 0)
              on += s.nodes[2 * d + (along[d] < 0)].position / n;
          if (n == 0)
            continue;
          const dealii::Point<dim> in(0.3 * on), out(1.7 * on);
          wrong += (count<dim>(s, {}, out, in) != 1);
          wrong += (count<dim>(s, {}, on, in) != 1);
          wrong += (count<dim>(s, {}, on, out) != 0);
          wrong += (count<dim>(s, {}, out, on) != 0);
          wrong += (count<dim>(s, {}, in, out) != 0);
        }
  return wrong;
}

template <int dim>
void
special_paths()
{
  std::array<double, 2 * dim> radii;
  radii.fill(1);
  auto         s     = star<dim>(radii);
  unsigned int wrong = n_wrong_radial_paths<dim>(s), wrong_at_stars = 0;
  for (unsigned int i = 0; i < 2000; ++i)
    {
      for (double &r : radii)
        r = std::pow(10., 0.5 * (uniform(generator) - 1));
      auto body = star<dim>(radii);
      wrong_at_stars += n_wrong_radial_paths<dim>(body);
    }
  // Touching a vertex from outside.
  dealii::Point<dim> a, b;
  a[0] = b[0] = 1;
  a[1]        = 0.5;
  b[1]        = -0.5;
  wrong += (count<dim>(s, {}, a, b) != 0);
  // A sheet, from exactly on it, with its side known or not.
  s.bodies[0].kind  = SurfaceKind::sheet;
  s.bodies[0].sheet = 0;
  dealii::Point<dim> on, in, out;
  for (int d = 0; d < dim; ++d)
    {
      on[d]  = (d == 0 ? 0.2 : (d == 1 ? 0.5 : 0.3)) / (dim == 3 ? 1. : 0.7);
      in[d]  = 0.5 * on[d];
      out[d] = 1.5 * on[d];
    }
  wrong += (count<dim>(s, {}, on, in, 1) != 1) + (count<dim>(s, {}, on, out, 1) != 0) +
           (count<dim>(s, {}, on, out, -1) != 1) + (count<dim>(s, {}, on, in, -1) != 0) +
           (count<dim>(s, {}, on, in, 0) != 1) + (count<dim>(s, {}, on, out, 0) != 1);
  deallog << dim << "-D special paths: wrong " << wrong << ", at stars with saddles "
          << wrong_at_stars << std::endl;
}

/// A simplex that deforms from step to step, and a point.
template <int dim>
struct RestingPoint
{
  std::array<dealii::Point<dim>, dim + 1> x;
  Surface<dim>                            surface;
  /// Of the vertices in the point's place; the last has none.
  std::array<double, dim> weight;
  dealii::Point<dim>      now;

  RestingPoint()
  {
    do
      for (auto &v : x)
        v = random_point<dim>(1);
    while (volume<dim>(x) < 0.05);
    surface    = simplex_body<dim>(x, SurfaceKind::closed);
    double sum = 0;
    for (double &w : weight)
      sum += w = std::max(0., uniform(generator));
    for (double &w : weight)
      w = (sum > 0 ? w / sum : 1. / dim);
    now = place(1);
  }

  dealii::Point<dim> middle() const
  {
    dealii::Point<dim> m;
    for (const auto &v : x)
      m += v / (dim + 1);
    return m;
  }

  double shortest_edge() const
  {
    double length = 10;
    for (const auto &a : x)
      for (const auto &b : x)
        if (&a != &b)
          length = std::min(length, a.distance(b));
    return length;
  }

  /// On the surface, and off it by a share of the distance from the middle.
  dealii::Point<dim> place(const double height) const
  {
    dealii::Point<dim> on;
    for (int k = 0; k < dim; ++k)
      on += weight[k] * x[k];
    return on + height * (on - middle());
  }

  void deform()
  {
    auto moved = x;
    for (auto &v : moved)
      v += random_point<dim>(0.02);
    if (volume<dim>(moved) > 0.05)
      x = moved;
  }

  /// Crossings of the step to where body and point are next.
  unsigned int go(const dealii::Point<dim> &next)
  {
    const unsigned int found =
      count<dim>(surface, std::vector<dealii::Point<dim>>(x.begin(), x.end()), now, next);
    now = next;
    return found;
  }
};

/// A point stays with a face, edge or vertex of a body, up to 1e-9 of its shortest edge off and
/// within it, and then goes to the middle or away.
template <int dim>
void
rest_on_surface(const unsigned int n)
{
  unsigned int wrong_in = 0, wrong_out = 0, early = 0;
  for (unsigned int i = 0; i < n; ++i)
    {
      RestingPoint<dim> point;
      for (unsigned int k = 0; k < 4; ++k)
        {
          const double height = 0.5e-9 * point.shortest_edge() * uniform(generator);
          early += point.go(point.place(k == 1 ? 0 : height));
          // Of a body at rest that is convex, it is clear how often a straight path goes in.
          if (k < 3)
            point.deform();
        }
      if (i % 2 == 0)
        wrong_in += (point.go(point.middle()) != 1);
      else
        wrong_out += (point.go(point.place(1)) != 0);
    }
  deallog << dim << "-D points that rest on the surface: counted then " << early
          << ", wrong when they go in " << wrong_in << ", away " << wrong_out << std::endl;
}

int
main()
{
  initlog();
  random_steps<2>(1000000, 20);
  random_steps<3>(1000000, 20);
  special_paths<2>();
  special_paths<3>();
  rest_on_surface<2>(50000);
  rest_on_surface<3>(50000);
}
