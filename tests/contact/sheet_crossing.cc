// SPDX-License-Identifier: GPL-3.0-or-later
// The sheets between two points are found with no gap and none twice: against the sides of a folded
// sheet that is a graph over the plane, also for ways exactly through its vertices and edges, for
// points on it, and for two sheets at once.
#include <coracle/contact/sheet_crossing.h>

#include <numeric>
#include <random>

#include "tests.h"

using namespace coracle::contact;

class Random
{
public:
  double operator()() { return generator() / 4294967296.; }
  /// A whole number below n, for ways through vertices.
  int below(const int n) { return static_cast<int>(n * (*this)()); }

private:
  std::mt19937 generator{4711};
};

// Knots at whole numbers 0 ... n, heights over them; facets in random order. Flatter in 3-D: at a
// sharp vertex the side of a point on the sheet may be either (but the same for all ways).
template <int dim>
struct Graph
{
  static constexpr int n = dim == 2 ? 24 : 8;

  explicit Graph(Random &random)
  {
    heights.resize(dim == 2 ? n + 1 : (n + 1) * (n + 1));
    for (double &h : heights)
      h = dim == 2 ? random.below(9) - 4 : random.below(3) - 1;
  }

  double knot(const int i, const int j = 0) const { return heights[i + (n + 1) * j]; }

  double height(const dealii::Point<dim> &x) const
  {
    const int    i = std::clamp(static_cast<int>(std::floor(x[0])), 0, n - 1);
    const double u = x[0] - i;
    if constexpr (dim == 2)
      return (1 - u) * knot(i) + u * knot(i + 1);
    else
      {
        // Four triangles around the middle: planes through it and two corners.
        const int    j = std::clamp(static_cast<int>(std::floor(x[1])), 0, n - 1);
        const double v = x[1] - j;
        const double a = knot(i, j), b = knot(i + 1, j), c = knot(i + 1, j + 1), d = knot(i, j + 1);
        const double m     = 0.25 * (a + b + c + d);
        const bool   lower = v <= u, left = u + v <= 1;
        if (lower && left)
          return a + u * (b - a) + v * (2 * m - a - b);
        if (!lower && !left)
          return d + u * (c - d) + (1 - v) * (2 * m - c - d);
        if (left)
          return a + v * (d - a) + u * (2 * m - a - d);
        return b + v * (c - b) + (1 - u) * (2 * m - b - c);
      }
  }

  void add_to(Surface<dim> &surface, const int sheet, Random &random) const
  {
    SurfaceBody body;
    body.kind  = SurfaceKind::sheet;
    body.sheet = sheet;
    surface.bodies.push_back(body);
    const unsigned int first = surface.nodes.size();
    for (unsigned int k = 0; k < heights.size(); ++k)
      {
        SurfaceNode<dim> node;
        node.position[0]       = k % (n + 1);
        node.position[1]       = k / (n + 1);
        node.position[dim - 1] = heights[k];
        surface.nodes.push_back(node);
      }
    std::vector<unsigned int> order(dim == 2 ? n : n * n);
    std::iota(order.begin(), order.end(), 0);
    for (unsigned int i = order.size() - 1; i > 0; --i)
      std::swap(order[i], order[random.below(i + 1)]);
    for (const unsigned int f : order)
      {
        Facet<dim>         facet;
        const unsigned int a = first + (dim == 2 ? f : f % n + (n + 1) * (f / n));
        // The normal points up.
        if constexpr (dim == 2)
          facet.nodes = {{a + 1, a}};
        else
          facet.nodes = {{a, a + 1, a + n + 2, a + n + 1}};
        facet.body = surface.bodies.size() - 1;
        surface.facets.push_back(facet);
      }
  }

  std::vector<double> heights;
};

template <int dim>
void
test()
{
  Random           random;
  const Graph<dim> one(random), two(random);
  Surface<dim>     surface;
  one.add_to(surface, 0, random);
  two.add_to(surface, 1, random);
  SheetCrossing<dim> crossing;
  crossing.reinit(surface);
  std::vector<unsigned int> all(crossing.n_simplices());
  std::iota(all.begin(), all.end(), 0);
  const typename SheetCrossing<dim>::List list{all.data(), all.data() + all.size()};

  const int n_trials = dim == 2 ? 20000 : 4000;
  for (const bool whole : {false, true})
    {
      int                wrong = 0, n_on = 0;
      std::array<int, 4> counts{};
      for (int trial = 0; trial < n_trials; ++trial)
        {
          std::array<dealii::Point<dim>, 2> x;
          std::array<std::uint64_t, 2>      above{};
          for (auto &p : x)
            {
              for (int d = 0; d < dim - 1; ++d)
                p[d] = whole ? random.below(Graph<dim>::n + 1) : Graph<dim>::n * random();
              const int top = dim == 2 ? 5 : 2;
              p[dim - 1]    = whole ? random.below(2 * top + 1) - top : top * (2 * random() - 1);
            }
          for (int i = 0; i < 2; ++i)
            {
              // A point on a sheet counts as above it.
              n_on += (x[i][dim - 1] == one.height(x[i])) + (x[i][dim - 1] == two.height(x[i]));
              above[i] =
                (x[i][dim - 1] >= one.height(x[i])) + 2 * (x[i][dim - 1] >= two.height(x[i]));
            }
          const auto side  = [](const int) { return 1.; };
          const auto found = crossing.between(crossing.clear_of(x[0], list, 1e-6, side),
                                              crossing.clear_of(x[1], list, 1e-6, side),
                                              list);
          // Vertical ways of points on the margin of the graph may pass beside it when moved off.
          bool inside = true;
          for (const auto &p : x)
            {
              for (int d = 0; d < dim - 1; ++d)
                inside = inside && p[d] > 0 && p[d] < Graph<dim>::n;
              // Where the sheets cross, a point cannot always be above both.
              inside = inside && !(p[dim - 1] == one.height(p) && p[dim - 1] == two.height(p));
            }
          if (inside)
            {
              wrong += found != (above[0] ^ above[1]);
              ++counts[found];
            }
        }
      deallog << dim << "d, " << (whole ? "whole numbers" : "anywhere") << ": wrong " << wrong
              << ", some points on a sheet " << (n_on > 100)
              << ", sheets between: none, either, both " << (counts[0] > 100) << (counts[1] > 100)
              << (counts[2] > 100) << (counts[3] > 100) << std::endl;
    }

  // The side that is remembered decides for a point on the sheet, whatever round-off says.
  int wrong = 0;
  for (int trial = 0; trial < 1000; ++trial)
    {
      dealii::Point<dim> p;
      for (int d = 0; d < dim - 1; ++d)
        p[d] = 0.5 + (Graph<dim>::n - 1) * random();
      p[dim - 1] = one.height(p);
      auto top   = p;
      top[dim - 1] += 100;
      for (const double remembered : {1., -1.})
        {
          const auto clear =
            crossing.clear_of(p, list, 1e-6, [&](const int) { return remembered; });
          wrong += (crossing.between(clear, top, list) & 1) != (remembered < 0);
        }
    }
  deallog << dim << "d, on the sheet: wrong " << wrong << std::endl;
}

int
main()
{
  initlog();
  test<2>();
  test<3>();
}
