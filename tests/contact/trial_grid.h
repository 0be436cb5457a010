// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/messages.h>
#include <coracle/contact/point_set.h>
#include <coracle/contact/rows.h>

#include <algorithm>
#include <cmath>
#include <sstream>

/// Material points without stress on a regular grid of cells of size 1 that all ranks hold.
namespace trial
{
using namespace coracle::contact;

template <int dim>
void
sum_over_ranks(std::vector<dealii::Tensor<1, dim>> &values, MPI_Comm communicator)
{
  if (!values.empty())
    MPI_Allreduce(
      MPI_IN_PLACE, &values[0][0], dim * values.size(), MPI_DOUBLE, MPI_SUM, communicator);
}

/// FLIP with 5 % PIC; slip faces around.
template <int dim>
class GridPoints
{
public:
  using Vector = dealii::Tensor<1, dim>;

  static constexpr unsigned int n_cells = 28, n_line = n_cells + 1;
  static constexpr unsigned int n_nodes = (dim == 2 ? n_line * n_line : n_line * n_line * n_line);

  explicit GridPoints(MPI_Comm communicator)
    : communicator(communicator)
    , mass(n_nodes)
    , velocity(n_nodes)
    , old_velocity(n_nodes)
    , impulse(n_nodes)
    , correction(n_nodes)
  {
    for (int d = 0; d < dim; ++d)
      origin[d] = -0.5 * n_cells;
  }

  void add(const unsigned int id, const dealii::Point<dim> &x, const Vector &v, const Vector &a)
  {
    for (int d = 0; d < dim; ++d)
      {
        position[d].push_back(x[d]);
        next[d].push_back(x[d]);
        speed[d].push_back(v[d]);
      }
    acceleration.push_back(a);
    ids.push_back(id);
    side.resize(n_sheets);
    for (auto &s : side)
      s.push_back(0);
  }

  unsigned int size() const { return ids.size(); }

  dealii::Point<dim> x(const unsigned int p) const
  {
    dealii::Point<dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = position[d][p];
    return result;
  }

  template <typename Draw>
  void move_origin(const Draw &draw)
  {
    for (int d = 0; d < dim; ++d)
      origin[d] += draw();
  }

  /// Positions, velocities and accelerations through a linear map.
  template <typename Map>
  void transform(const Map &map)
  {
    for (unsigned int p = 0; p < size(); ++p)
      {
        Vector v;
        for (int d = 0; d < dim; ++d)
          v[d] = speed[d][p];
        const Vector y = map(Vector(x(p))), w = map(v);
        acceleration[p] = map(acceleration[p]);
        for (int d = 0; d < dim; ++d)
          {
            position[d][p] = next[d][p] = y[d];
            speed[d][p]                 = w[d];
          }
      }
  }

  PointSet<dim> set()
  {
    PointSet<dim> s;
    s.n_points        = size();
    s.constant_radius = radius;
    s.ids             = ids.data();
    for (auto &column : side)
      s.side.push_back(column.data());
    for (int d = 0; d < dim; ++d)
      {
        s.position[d] = position[d].data();
        s.velocity[d] = speed[d].data();
      }
    return s;
  }

  template <typename Action>
  void for_each_node(const dealii::Point<dim> &place, const Action &action) const
  {
    std::array<unsigned int, dim> cell;
    std::array<double, dim>       inside;
    for (int d = 0; d < dim; ++d)
      {
        const double in = std::max(0., std::min(n_cells - 1e-9, place[d] - origin[d]));
        cell[d]         = static_cast<unsigned int>(in);
        inside[d]       = in - cell[d];
      }
    for (unsigned int c = 0; c < (1u << dim); ++c)
      {
        double       weight = 1;
        unsigned int node   = 0;
        for (int d = dim - 1; d >= 0; --d)
          {
            const bool upper = (c >> d) & 1;
            weight *= upper ? inside[d] : 1 - inside[d];
            node = node * n_line + cell[d] + upper;
          }
        action(node, weight);
      }
  }

  /// Mass and momentum with what acceleration adds in dt, then velocities of the nodes.
  void gather(const double dt)
  {
    std::fill(mass.begin(), mass.end(), 0.);
    std::fill(velocity.begin(), velocity.end(), Vector());
    std::fill(impulse.begin(), impulse.end(), Vector());
    std::fill(correction.begin(), correction.end(), Vector());
    for (unsigned int p = 0; p < size(); ++p)
      for_each_node(x(p), [&](const unsigned int node, const double w) {
        mass[node] += w;
        for (int d = 0; d < dim; ++d)
          velocity[node][d] += w * speed[d][p];
      });
    MPI_Allreduce(MPI_IN_PLACE, mass.data(), mass.size(), MPI_DOUBLE, MPI_SUM, communicator);
    sum_over_ranks(velocity, communicator);
    for (unsigned int i = 0; i < n_nodes; ++i)
      old_velocity[i] = velocity[i] = (mass[i] > 0 ? velocity[i] / mass[i] : Vector());
    std::vector<Vector> push(n_nodes);
    for (unsigned int p = 0; p < size(); ++p)
      for_each_node(x(p), [&](const unsigned int node, const double w) {
        push[node] += w * dt * acceleration[p];
      });
    sum_over_ranks(push, communicator);
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (int d = 0; d < dim; ++d)
        if (fixed(i, d))
          velocity[i][d] = 0;
        else if (mass[i] > 0)
          velocity[i][d] += push[i][d] / mass[i];
  }

  Unknown<dim> unknown(const unsigned int node) const
  {
    Unknown<dim> result;
    result.velocity = velocity[node];
    for (int d = 0; d < dim; ++d)
      result.inverse_mass[d] = (fixed(node, d) || mass[node] <= 0 ? 0. : 1 / mass[node]);
    result.key   = (1ull << 62) + node;
    result.owner = node % n_ranks(communicator);
    return result;
  }

  void add_impulse(const unsigned int node, const Vector &p, const Vector &c)
  {
    impulse[node] += p;
    correction[node] += c;
  }

  /// Collective. Velocities of points, and where they go.
  void move(const double dt)
  {
    sum_over_ranks(impulse, communicator);
    sum_over_ranks(correction, communicator);
    for (unsigned int i = 0; i < n_nodes; ++i)
      {
        const auto u = unknown(i);
        for (int d = 0; d < dim; ++d)
          {
            velocity[i][d] += u.inverse_mass[d] * impulse[i][d];
            correction[i][d] *= u.inverse_mass[d];
          }
      }
    for (unsigned int p = 0; p < size(); ++p)
      {
        Vector v, change, shift;
        for_each_node(x(p), [&](const unsigned int node, const double w) {
          v += w * velocity[node];
          change += w * (velocity[node] - old_velocity[node]);
          shift += w * correction[node];
        });
        for (int d = 0; d < dim; ++d)
          {
            speed[d][p] = 0.95 * (speed[d][p] + change[d]) + 0.05 * v[d];
            next[d][p]  = position[d][p] + dt * v[d] + shift[d];
          }
      }
  }

  /// Columns of the next positions.
  std::vector<std::array<double *, dim>> ends()
  {
    std::vector<std::array<double *, dim>> result(1);
    for (int d = 0; d < dim; ++d)
      result[0][d] = next[d].data();
    return result;
  }

  void take_positions()
  {
    for (int d = 0; d < dim; ++d)
      position[d] = next[d];
  }

  unsigned long n_over_ranks() const
  {
    unsigned long n = size();
    MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
    return n;
  }

  unsigned int n_sheets = 0;
  double       radius   = 0;

private:
  bool fixed(unsigned int node, const int direction) const
  {
    for (int d = 0; d < direction; ++d)
      node /= n_line;
    node %= n_line;
    return node == 0 || node == n_cells;
  }

  MPI_Comm                             communicator;
  dealii::Point<dim>                   origin;
  std::array<std::vector<double>, dim> position, next, speed;
  std::vector<Vector>                  acceleration;
  std::vector<std::uint64_t>           ids;
  std::vector<std::vector<double>>     side;
  std::vector<double>                  mass;
  std::vector<Vector>                  velocity, old_velocity, impulse, correction;
};
} // namespace trial
