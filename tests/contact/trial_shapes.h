// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/surface.h>

#include <random>
#include <string>

/// Surfaces of random trials: drawn as profiles in the plane, drawn out along z in space.
namespace trial
{
using namespace coracle::contact;
using P2 = dealii::Point<2>;

/// One seed gives one scene, on any number of ranks.
struct Random
{
  explicit Random(const unsigned long seed) : generator(seed) {}
  double uniform(const double a, const double b)
  {
    return a + (b - a) * (generator() >> 11) * 0x1p-53;
  }
  double log_uniform(const double a, const double b) { return a * std::pow(b / a, uniform(0, 1)); }
  unsigned int integer(const unsigned int n) { return generator() % n; }
  bool         chance(const double p) { return uniform(0, 1) < p; }

  std::mt19937_64 generator;
};

/// Nodes and segments in the plane; a node belongs to a group that moves as one.
struct Profile
{
  std::string                              name;
  std::vector<P2>                          nodes;
  std::vector<unsigned int>                group;
  std::vector<std::array<unsigned int, 2>> segments;
  /// Body of each segment.
  std::vector<unsigned int> body;
  unsigned int              n_bodies = 1, n_groups = 1;
  SurfaceKind               kind = SurfaceKind::sheet;
  /// Facets are drawn with this length.
  double facet = 1;
  /// Of the second group: "" (as the first), "flap" (swings about the first node of the group),
  /// "closing" (comes nearer), "twist" (turns about the x axis, growing with x; space only).
  std::string special;
};

/// Appends the straight way from node a to b in n parts; returns the last node.
inline unsigned int
add_line(Profile           &p,
         const unsigned int a,
         const P2          &end,
         const unsigned int n,
         const unsigned int group = 0,
         const unsigned int body  = 0)
{
  const P2     begin = p.nodes[a];
  unsigned int last  = a;
  for (unsigned int i = 1; i <= n; ++i)
    {
      p.nodes.push_back(begin + (double(i) / n) * (end - begin));
      p.group.push_back(group);
      p.segments.push_back({{last, static_cast<unsigned int>(p.nodes.size()) - 1}});
      p.body.push_back(body);
      last = p.nodes.size() - 1;
    }
  return last;
}

inline unsigned int
add_start(Profile &p, const P2 &x, const unsigned int group = 0)
{
  p.nodes.push_back(x);
  p.group.push_back(group);
  return p.nodes.size() - 1;
}

/// Closes the loop: the last node becomes the first.
inline void
close_loop(Profile &p)
{
  p.segments.back()[1] = p.segments.front()[0];
  p.nodes.pop_back();
  p.group.pop_back();
}

inline unsigned int
parts(const double length, const double facet)
{
  return std::min(40., std::max(1., std::round(length / facet)));
}

constexpr unsigned int n_shapes = 12;

/// Lengths in cells.
inline Profile
draw_profile(Random &random, const unsigned int shape)
{
  Profile      p;
  const double f = p.facet = random.log_uniform(1. / 16, 16.);
  const double length      = std::max(f, std::min(40 * f, random.uniform(2., 6.)));
  switch (shape)
    {
      case 0:
        p.name = "plate";
        add_line(p, add_start(p, P2(-length / 2, 0)), P2(length / 2, 0), parts(length, f));
        break;
        case 1: {
          p.name              = "folds";
          const double   fold = std::min(random.log_uniform(0.05, 3.), length / 2);
          const double   rise = fold * random.log_uniform(0.2, 4.);
          const unsigned n    = std::min(20., std::max(2., length / fold));
          unsigned int   last = add_start(p, P2(-0.5 * n * fold, 0));
          for (unsigned int i = 1; i <= n; ++i)
            last = add_line(p,
                            last,
                            P2((i - 0.5 * n) * fold, i % 2 ? rise : 0.),
                            std::min(6u, parts(std::hypot(fold, rise), f)));
          break;
        }
        case 2: {
          p.name                    = "junction";
          const unsigned int centre = add_start(p, P2(0, 0));
          double             angle  = random.uniform(0, 6);
          for (unsigned int i = 0; i < 3; ++i)
            {
              add_line(p,
                       centre,
                       P2(0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)),
                       parts(0.5 * length, f));
              angle += random.uniform(0.4, 2.6);
            }
          break;
        }
      case 3:
        case 4: {
          p.name           = (shape == 3 ? "thin box" : "needle");
          p.kind           = SurfaceKind::closed;
          const double b   = random.log_uniform(1e-3, shape == 3 ? 2. : 0.3);
          unsigned int end = add_start(p, P2(-length / 2, -b / 2));
          if (shape == 3)
            {
              end = add_line(p, end, P2(length / 2, -b / 2), parts(length, f));
              end = add_line(p, end, P2(length / 2, b / 2), parts(b, f));
              end = add_line(p, end, P2(-length / 2, b / 2), parts(length, f));
            }
          else
            {
              end = add_line(p, end, P2(length / 2, 0), parts(length, f));
              end = add_line(p, end, P2(-length / 2, b / 2), parts(length, f));
            }
          add_line(p, end, P2(-length / 2, -b / 2), parts(b, f));
          close_loop(p);
          break;
        }
        case 5: {
          p.name              = "slivers";
          const unsigned n    = parts(std::min(length, 6.), f);
          unsigned int   last = add_start(p, P2(-0.5 * n * f, 0));
          for (unsigned int i = 0; i < n; ++i)
            {
              const P2 x = p.nodes[last] + P2(0.999 * f, f * random.uniform(-0.3, 0.3));
              last       = add_line(p, last, x, 1);
              last       = add_line(p, last, x + P2(0.001 * f, 0), 1);
            }
          break;
        }
        case 6: {
          p.name                  = "flap";
          p.special               = "flap";
          p.n_groups              = 2;
          const unsigned int n    = parts(length / 2, f);
          const unsigned int last = add_line(p, add_start(p, P2(-length / 2, 0)), P2(0, 0), n);
          add_line(p, last, P2(length / 2, 0), n, 1);
          break;
        }
      case 7:
        p.name     = "twist";
        p.special  = "twist";
        p.n_groups = 2;
        add_line(p, add_start(p, P2(-length / 2, 0), 1), P2(length / 2, 0), parts(length, f), 1);
        break;
      case 8:
        p.name     = "closing";
        p.special  = "closing";
        p.n_groups = p.n_bodies = 2;
        add_line(p, add_start(p, P2(-length / 2, -1)), P2(length / 2, -1), parts(length, f));
        add_line(p, add_start(p, P2(-length / 2, 1), 1), P2(length / 2, 1), parts(length, f), 1, 1);
        break;
        case 9: {
          p.name                  = "container";
          const unsigned int n    = 3 + random.integer(30);
          const double       r    = std::min(5., std::max(0.3, f * n / 6.3));
          unsigned int       last = add_start(p, P2(r, 0));
          for (unsigned int i = 1; i <= n; ++i)
            last = add_line(p,
                            last,
                            P2(r * std::cos(i * 2 * M_PI / n), r * std::sin(i * 2 * M_PI / n)),
                            1);
          close_loop(p);
          break;
        }
        case 10: {
          p.name                   = "star";
          p.kind                   = SurfaceKind::closed;
          const unsigned int n     = 2 * (2 + random.integer(6));
          const double       r     = std::min(5., std::max(0.3, f));
          const double       inner = r * random.uniform(0.1, 0.9);
          unsigned int       last  = add_start(p, P2(r, 0));
          for (unsigned int i = 1; i <= n; ++i)
            {
              const double s = (i % 2 ? inner : r), angle = i * 2 * M_PI / n;
              last = add_line(p, last, P2(s * std::cos(angle), s * std::sin(angle)), 1);
            }
          close_loop(p);
          break;
        }
        default: {
          // A spiral: both faces and tight curves.
          p.name                   = "spiral";
          const unsigned int n     = 8 + random.integer(30);
          const double       pitch = random.log_uniform(0.1, 1.), turn = random.uniform(0.2, 0.8);
          double             angle = 2;
          unsigned int       last  = add_start(p, P2(pitch * angle, 0));
          for (unsigned int i = 1; i <= n && pitch * angle < 12; ++i)
            {
              angle += turn;
              last = add_line(p,
                              last,
                              P2(pitch * angle * std::cos(angle - 2),
                                 pitch * angle * std::sin(angle - 2)),
                              1);
            }
          break;
        }
    }
  return p;
}

/// What edges of facets that have become longer or shorter pull at their nodes, as springs of
/// stiffness one [m].
template <int dim>
std::vector<dealii::Tensor<1, dim>>
pull_of_edges(const Surface<dim> &surface, const std::vector<dealii::Point<dim>> &drawn)
{
  std::vector<dealii::Tensor<1, dim>> pull(surface.nodes.size());
  for (const auto &f : surface.facets)
    for (unsigned int k = 0; k < f.nodes.size(); ++k)
      {
        const unsigned int a = f.nodes[k], b = f.nodes[(k + 1) % f.nodes.size()];
        const auto         stretch =
          (surface.nodes[b].position - drawn[b]) - (surface.nodes[a].position - drawn[a]);
        pull[a] += stretch;
        pull[b] -= stretch;
      }
  return pull;
}
} // namespace trial
