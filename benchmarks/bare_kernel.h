// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/aligned_vector.h>

#include <coracle/base/columns.h>
#include <coracle/grid/corner_shape.h>

#include <chrono>
#include <numeric>

namespace coracle::benchmarks
{
/**
 * What the machine can do: water in a box of equal cells, one mapping a step,
 * grid to particles and the next particles to grid fused into one sweep, and
 * nothing else: no octree, second mapping, strays beyond a neighbour, migration,
 * ledger or energy books. The full step is compared with this in the same run.
 */
class BareKernel
{
public:
  BareKernel(const unsigned int n_cells_per_metre)
    : n(n_cells_per_metre), nz(n + n / 4), h(1. / n), dt(0.3 * h / sound_speed), columns(8)
  {
    for (auto &records : nodes)
      records.resize((n + 1) * (n + 1) * (nz + 1));
    columns.resize(8 * n * n * n);
    std::size_t row = 0;
    for (unsigned int c = 0; c < n * n * n; ++c)
      for (unsigned int p = 0; p < 8; ++p, ++row)
        {
          const unsigned int cell[] = {c % n, c / n % n, c / n / n};
          for (unsigned int d = 0; d < 3; ++d)
            columns[d][row] = (cell[d] + 0.25 + 0.5 * ((p >> d) & 1)) * h;
          columns[6][row] = density;
          columns[7][row] = density * h * h * h / 8;
        }
    sort();
    sweep<false, true>();
  }

  /// Nanoseconds a particle-step, sorting every tenth step included.
  double run(const unsigned int n_steps)
  {
    const auto start = std::chrono::steady_clock::now();
    for (unsigned int s = 1; s <= n_steps; ++s)
      {
        update_nodes();
        if (s % 10 == 0)
          {
            sweep<true, false>();
            sort();
            sweep<false, true>();
          }
        else
          sweep<true, true>();
      }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return seconds.count() * 1e9 / columns.size() / n_steps;
  }

private:
  static constexpr double sound_speed = 20, density = 1000, gravity = -9.81;

  unsigned int node(const unsigned int i, const unsigned int j, const unsigned int k) const
  {
    return i + (n + 1) * (j + (n + 1) * k);
  }

  std::array<unsigned int, 8>
  corners(const unsigned int i, const unsigned int j, const unsigned int k) const
  {
    std::array<unsigned int, 8> result;
    for (unsigned int c = 0; c < 8; ++c)
      result[c] = node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
    return result;
  }

  unsigned int cell_of(const std::size_t row) const
  {
    unsigned int c[3];
    for (unsigned int d = 0; d < 3; ++d)
      c[d] = std::min<unsigned int>(columns[d][row] / h, (d == 2 ? nz : n) - 1);
    return c[0] + n * (c[1] + n * c[2]);
  }

  void sort()
  {
    const unsigned int n_cells = n * n * nz;
    begin.assign(n_cells + 2, 0);
    source.resize(columns.size());
    std::vector<unsigned int> cell(columns.size());
    for (std::size_t row = 0; row < columns.size(); ++row)
      ++begin[(cell[row] = cell_of(row)) + 2];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (std::size_t row = 0; row < columns.size(); ++row)
      source[begin[cell[row] + 1]++] = row;
    columns.reorder(source);
  }

  void update_nodes()
  {
    for (unsigned int k = 0; k <= nz; ++k)
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          {
            const NodeRecord &from = nodes[0][node(i, j, k)];
            NodeRecord       &to   = nodes[1][node(i, j, k)];
            to                     = NodeRecord();
            if (from[0] <= 1e-12)
              continue;
            const unsigned int at[] = {i, j, k}, end[] = {n, n, nz};
            for (unsigned int d = 0; d < 3; ++d)
              {
                const double v = from[1 + d] / from[0];
                to[3 + d]      = dt * (from[4 + d] / from[0] + (d == 2 ? gravity : 0.));
                if (at[d] == 0 || at[d] == end[d])
                  to[3 + d] = -v;
                to[d] = v + to[3 + d];
              }
          }
    std::fill(nodes[0].begin(), nodes[0].end(), NodeRecord());
  }

  template <bool take, bool give>
  void sweep()
  {
    if (give && !take)
      std::fill(nodes[0].begin(), nodes[0].end(), NodeRecord());
    for (unsigned int c = 0; c + 1 < begin.size(); ++c)
      if (begin[c] < begin[c + 1])
        sweep_cell<take, give>(c);
  }

  template <bool take, bool give>
  void sweep_cell(const unsigned int cell)
  {
    const unsigned int at[]          = {cell % n, cell / n % n, cell / n / n};
    const auto         nodes_of_cell = corners(at[0], at[1], at[2]);
    CornerSums<3>      sums;
    for (unsigned int row = begin[cell]; row < begin[cell + 1]; row += pack_size)
      {
        const int        n_lanes = std::min<unsigned int>(pack_size, begin[cell + 1] - row);
        Vector<3, Pack8> x, v, xi;
        Pack8            rho = load<Pack8>(columns[6] + row);
        const Pack8      m   = load<Pack8>(columns[7] + row);
        for (int d = 0; d < 3; ++d)
          {
            x[d]  = load<Pack8>(columns[d] + row);
            v[d]  = load<Pack8>(columns[3 + d] + row);
            xi[d] = x[d] * (1. / h) - double(at[d]);
          }
        if constexpr (take)
          {
            move(nodes_of_cell, xi, x, v, rho);
            for (int d = 0; d < 3; ++d)
              {
                store_first(columns[d] + row, x[d], n_lanes);
                store_first(columns[3 + d] + row, v[d], n_lanes);
                xi[d] = x[d] * (1. / h) - double(at[d]);
              }
            store_first(columns[6] + row, rho, n_lanes);
          }
        if constexpr (give)
          {
            const Pack8 pressure        = sound_speed * sound_speed * (rho - density),
                        volume_per_size = m / rho / h;
            for (int l = 0; l < n_lanes; ++l)
              {
                const bool inside = xi[0][l] >= 0 && xi[0][l] < 1 && xi[1][l] >= 0 &&
                                    xi[1][l] < 1 && xi[2][l] >= 0 && xi[2][l] < 1;
                if (__builtin_expect(inside, 1))
                  add({{xi[0][l], xi[1][l], xi[2][l]}},
                      {{v[0][l], v[1][l], v[2][l]}},
                      m[l],
                      pressure[l],
                      volume_per_size[l],
                      sums);
                else
                  give_stray(
                    row + l, {{v[0][l], v[1][l], v[2][l]}}, m[l], pressure[l], volume_per_size[l]);
              }
          }
      }
    if constexpr (give)
      sums.give_to(nodes[0], nodes_of_cell);
  }

  void move(const std::array<unsigned int, 8> &nodes_of_cell,
            const Vector<3, Pack8>            &xi,
            Vector<3, Pack8>                  &x,
            Vector<3, Pack8>                  &v,
            Pack8                             &rho) const
  {
    const PackShape<3> shape(xi);
    Vector<3, Pack8>   velocity{};
    Pack8              divergence{};
    for (int c = 0; c < 8; ++c)
      {
        const NodeRecord &record = nodes[1][nodes_of_cell[c]];
        const Pack8       w      = shape.value(c);
        for (int d = 0; d < 3; ++d)
          {
            velocity[d] += w * record[d];
            v[d] += w * record[3 + d];
            divergence += shape.gradient(c, d) * record[d];
          }
      }
    rho = rho / (1. + (dt / h) * divergence);
    for (int d = 0; d < 3; ++d)
      x[d] = max(splat<Pack8>(1e-9),
                 min(splat<Pack8>((d == 2 ? nz : n) * h - 1e-9), Pack8(x[d] + dt * velocity[d])));
  }

  static void add(const Vector<3, double> &xi,
                  const Vector<3, double> &v,
                  const double             m,
                  const double             pressure,
                  const double             volume_per_size,
                  CornerSums<3>           &sums)
  {
    const CornerShape<3> shape(xi);
    sums.mass += shape.value * m;
    sums.add_momentum(shape, m, v);
    sums.add_pressure(shape, pressure, volume_per_size);
  }

  void give_stray(const std::size_t        row,
                  const Vector<3, double> &v,
                  const double             m,
                  const double             pressure,
                  const double             volume_per_size)
  {
    const unsigned int cell = cell_of(row), at[] = {cell % n, cell / n % n, cell / n / n};
    Vector<3, double>  xi;
    for (int d = 0; d < 3; ++d)
      xi[d] = columns[d][row] / h - at[d];
    CornerSums<3> sums;
    add(xi, v, m, pressure, volume_per_size, sums);
    sums.give_to(nodes[0], corners(at[0], at[1], at[2]));
  }

  const unsigned int         n, nz;
  const double               h, dt;
  Columns                    columns;
  std::array<NodeRecords, 2> nodes;
  std::vector<unsigned int>  begin, source;
};
} // namespace coracle::benchmarks
