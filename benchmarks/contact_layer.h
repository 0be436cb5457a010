// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact_system.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace coracle::benchmarks
{
/**
 * Contact as a run goes on: two layers of particles, eight a cell, that lie on a
 * plate and slide over it, while waves of pressure press them on it. The plate's
 * nodes are springs, so that it moves; the particles' unknowns are nodes of a
 * uniform grid of cells as large as the facets. Cells are in Morton order, as in
 * an octree, and particles count as sorted anew every ten steps.
 *
 * Nothing here is part of contact but what happens between start and end of a
 * timed part; the rest stands for the grid and the structure.
 */
class ContactLayer
{
public:
  struct Options
  {
    unsigned int n_cells;
    double       friction;
  };

  /// Processor time [s] of the parts of all steps since reset(), and what they were for.
  struct Times
  {
    double search_anew = 0, search = 0, rows = 0, solve = 0, check = 0, audit = 0;
    /// Sums over steps: contacts, candidates, contacts of the steps that searched anew, iterations.
    double       contacts = 0, candidates = 0, contacts_anew = 0, iterations = 0;
    unsigned int most_iterations = 0, not_converged = 0;
  };

  explicit ContactLayer(const Options &options) : n(options.n_cells)
  {
    make_plate(options.friction);
    make_points();
    const std::size_t n_nodes = 3 * (n_plate + 1) * (n_plate + 1);
    grid.resize(n_nodes);
    for (std::size_t i = 0; i < n_nodes; ++i)
      {
        for (unsigned int d = 0; d < 3; ++d)
          grid[i].inverse_mass[d] = 1. / (1000 * size * size * size);
        grid[i].velocity = sliding();
        grid[i].key      = (std::uint64_t(1) << 40) + i;
      }
  }

  /// One step of contact and what goes with it.
  void step()
  {
    predict();
    if (n_steps % 10 == 0)
      contacts.points_renumbered();
    const unsigned int n_searches = contacts.report().n_rebuilds;
    const double       search     = timed([&] { contacts.find(plate, sets, dt); });
    const bool         anew       = contacts.report().n_rebuilds > n_searches;
    (anew ? times.search_anew : times.search) += search;
    times.rows += timed([&] { build_rows(); });
    times.solve += timed([&] { contacts.solve({}, dt); });
    const auto &solver = contacts.report().solver.velocity;
    times.contacts += contacts.contacts().size();
    times.contacts_anew += anew * contacts.contacts().size();
    times.candidates += contacts.report().n_candidates;
    times.iterations += solver.iterations;
    times.most_iterations = std::max(times.most_iterations, solver.iterations);
    times.not_converged += !solver.converged;
    move();
    times.check += timed([&] { contacts.resolve_in_time(plate, sets, {{end_columns()}}); });
    auto ends = sets;
    for (unsigned int d = 0; d < 3; ++d)
      ends[0].position[d] = end[d].data();
    times.audit += timed([&] { contacts.audit(plate, ends); });
    std::swap(position, end);
    update_set();
    ++n_steps;
  }

  void reset() { times = Times(); }

  Times                     times;
  contact::ContactSystem<3> contacts{contact::ContactOptions(), MPI_COMM_SELF};
  static constexpr double   size = 0.02, dt = 1e-4;

private:
  static constexpr unsigned int margin = 4;

  template <typename Part>
  static double timed(const Part &part)
  {
    const auto now = [] {
      timespec t;
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
      return t.tv_sec + 1e-9 * t.tv_nsec;
    };
    const double begin = now();
    part();
    return now() - begin;
  }

  static dealii::Tensor<1, 3> sliding() { return dealii::Tensor<1, 3>({5., 3., 0.}); }

  static double height(const double x, const double y)
  {
    return 0.1 * size * std::sin(9 * x) * std::cos(7 * y);
  }

  void make_plate(const double friction)
  {
    n_plate = n + 2 * margin;
    plate.bodies.resize(1);
    plate.bodies[0].friction = friction;
    for (unsigned int j = 0; j <= n_plate; ++j)
      for (unsigned int i = 0; i <= n_plate; ++i)
        {
          contact::SurfaceNode<3> node;
          node.position = dealii::Point<3>(i * size, j * size, height(i * size, j * size));
          node.key      = plate.nodes.size();
          for (unsigned int d = 0; d < 3; ++d)
            node.inverse_mass[d] = 1. / (7800 * 0.002 * size * size);
          plate.nodes.push_back(node);
        }
    for (unsigned int j = 0; j < n_plate; ++j)
      for (unsigned int i = 0; i < n_plate; ++i)
        {
          const unsigned int k = j * (n_plate + 1) + i;
          plate.facets.push_back(
            {{{k, k + 1, k + n_plate + 2, k + n_plate + 1}}, 0, plate.facets.size()});
        }
    rest = plate.nodes;
  }

  static std::uint64_t spread(std::uint64_t a)
  {
    std::uint64_t result = 0;
    for (unsigned int bit = 0; bit < 20; ++bit)
      result |= ((a >> bit) & 1) << (2 * bit);
    return result;
  }

  void make_points()
  {
    std::vector<std::pair<std::uint64_t, unsigned int>> cells;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
        cells.emplace_back(spread(i) | (spread(j) << 1), j * n + i);
    std::sort(cells.begin(), cells.end());
    sets.resize(1);
    sets[0].constant_radius = 0.25 * size;
    // Places scatter by a tenth of a cell, the same on every machine.
    std::uint64_t random  = 1;
    const auto    scatter = [&random] {
      random = random * 6364136223846793005ull + 1442695040888963407ull;
      return 0.1 * (double(random >> 11) / double(1ull << 53) - 0.5);
    };
    for (const auto &cell : cells)
      {
        sets[0].group_begin.push_back(position[0].size());
        for (unsigned int k = 0; k < 8; ++k)
          {
            const double x = size * (margin + cell.second % n + 0.25 + 0.5 * (k & 1) + scatter()),
                         y = size *
                             (margin + cell.second / n + 0.25 + 0.5 * ((k >> 1) & 1) + scatter());
            position[0].push_back(x);
            position[1].push_back(y);
            position[2].push_back(size * (0.25 + 0.5 * (k >> 2)) + height(x, y));
          }
      }
    sets[0].group_begin.push_back(position[0].size());
    sets[0].n_points = position[0].size();
    for (unsigned int d = 0; d < 3; ++d)
      {
        velocity[d].assign(position[0].size(), sliding()[d]);
        end[d].resize(position[0].size());
      }
    update_set();
  }

  void update_set()
  {
    for (unsigned int d = 0; d < 3; ++d)
      {
        sets[0].position[d] = position[d].data();
        sets[0].velocity[d] = velocity[d].data();
      }
  }

  std::array<double *, 3> end_columns() { return {{end[0].data(), end[1].data(), end[2].data()}}; }

  /// Waves of pressure on the layer, on average 500 m/s^2; springs of the plate.
  void predict()
  {
    for (std::size_t i = 0; i < grid.size(); ++i)
      {
        const std::size_t at = i % plate.nodes.size();
        const auto       &x  = rest[at].position;
        grid[i].velocity[2] -=
          dt * 500 * (1 + 1.5 * std::sin(20 * x[0] + 13 * x[1] - 400 * n_steps * dt));
      }
    for (std::size_t i = 0; i < plate.nodes.size(); ++i)
      plate.nodes[i].velocity =
        0.95 * plate.nodes[i].velocity - dt * 4e5 * (plate.nodes[i].position - rest[i].position);
  }

  template <typename Action>
  void for_each_node(const unsigned int p, const Action &action) const
  {
    double       w[3];
    unsigned int cell[3];
    for (unsigned int d = 0; d < 3; ++d)
      {
        const double x = position[d][p] / size + (d == 2 ? 0.5 : 0.);
        cell[d]        = std::clamp<int>(x, 0, d == 2 ? 1 : n_plate - 1);
        w[d]           = x - cell[d];
      }
    for (unsigned int k = 0; k < 8; ++k)
      action(((cell[2] + (k >> 2)) * (n_plate + 1) + cell[1] + ((k >> 1) & 1)) * (n_plate + 1) +
               cell[0] + (k & 1),
             (k & 1 ? w[0] : 1 - w[0]) * (k & 2 ? w[1] : 1 - w[1]) * (k & 4 ? w[2] : 1 - w[2]));
  }

  void build_rows()
  {
    contacts.build_rows(
      [this](const unsigned int, const unsigned int p, auto &entries) {
        for_each_node(p, [&](const unsigned int node, const double weight) {
          entries.push_back({node, weight});
        });
      },
      [this](const unsigned int i) { return grid[i]; });
  }

  void move()
  {
    contacts.point_impulses([&](const unsigned int i, const auto &impulse, const auto &) {
      for (unsigned int d = 0; d < 3; ++d)
        grid[i].velocity[d] += grid[i].inverse_mass[d] * impulse[d];
    });
    std::vector<dealii::Tensor<1, 3>> impulse(plate.nodes.size()), correction(plate.nodes.size());
    contacts.surface_impulses(impulse, correction);
    for (std::size_t i = 0; i < plate.nodes.size(); ++i)
      {
        auto &node = plate.nodes[i];
        for (unsigned int d = 0; d < 3; ++d)
          {
            node.velocity[d] += node.inverse_mass[d] * impulse[i][d];
            node.position[d] += dt * node.velocity[d] + node.inverse_mass[d] * correction[i][d];
          }
      }
    for (unsigned int p = 0; p < position[0].size(); ++p)
      {
        dealii::Tensor<1, 3> v;
        for_each_node(p, [&](const unsigned int node, const double weight) {
          v += weight * grid[node].velocity;
        });
        for (unsigned int d = 0; d < 3; ++d)
          {
            velocity[d][p] = v[d];
            end[d][p]      = position[d][p] + dt * v[d];
          }
      }
  }

  const unsigned int                   n;
  unsigned int                         n_plate = 0, n_steps = 0;
  contact::Surface<3>                  plate;
  std::vector<contact::SurfaceNode<3>> rest;
  std::array<std::vector<double>, 3>   position, velocity, end;
  std::vector<contact::PointSet<3>>    sets;
  std::vector<contact::Unknown<3>>     grid;
};
} // namespace coracle::benchmarks
