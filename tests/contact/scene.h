// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact_system.h>

#include <random>

#include "../tests.h"

/// Points that are unknowns of their own (no grid), and surfaces from lists.
namespace scene
{
using namespace coracle::contact;

/// Points of mass 1 that own their columns.
template <int dim>
struct Points
{
  std::array<std::vector<double>, dim> position, velocity;
  std::vector<double>                  side, mass;
  double                               radius = 0;

  unsigned int size() const { return position[0].size(); }

  void add(const dealii::Point<dim> &x, const dealii::Tensor<1, dim> &v, const double m = 1)
  {
    for (int d = 0; d < dim; ++d)
      {
        position[d].push_back(x[d]);
        velocity[d].push_back(v[d]);
      }
    side.push_back(0);
    mass.push_back(m);
  }

  dealii::Point<dim> x(const unsigned int i) const
  {
    dealii::Point<dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = position[d][i];
    return result;
  }

  dealii::Tensor<1, dim> v(const unsigned int i) const
  {
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = velocity[d][i];
    return result;
  }

  void change_velocity(const unsigned int i, const dealii::Tensor<1, dim> &dv)
  {
    for (int d = 0; d < dim; ++d)
      velocity[d][i] += dv[d];
  }

  void move(const unsigned int i, const dealii::Tensor<1, dim> &dx)
  {
    for (int d = 0; d < dim; ++d)
      position[d][i] += dx[d];
  }

  PointSet<dim> set()
  {
    PointSet<dim> s;
    s.n_points        = size();
    s.constant_radius = radius;
    s.side            = {side.data()};
    for (int d = 0; d < dim; ++d)
      {
        s.position[d] = position[d].data();
        s.velocity[d] = velocity[d].data();
      }
    return s;
  }
};

template <int dim>
unsigned int
add_node(Surface<dim> &s, const dealii::Point<dim> &x, const double inverse_mass = 0)
{
  SurfaceNode<dim> node;
  node.position = x;
  for (int d = 0; d < dim; ++d)
    node.inverse_mass[d] = inverse_mass;
  node.key = (1ull << 32) + s.nodes.size();
  s.nodes.push_back(node);
  return s.nodes.size() - 1;
}

template <int dim>
void
add_facet(Surface<dim>                                            &s,
          const std::array<unsigned int, vertices_per_facet<dim>> &nodes,
          const unsigned int                                       body = 0)
{
  s.facets.push_back({nodes, body, s.facets.size()});
}

template <int dim>
Surface<dim>
one_body(const SurfaceKind kind, const double thickness = 0, const double friction = 0)
{
  Surface<dim> s;
  s.bodies.resize(1);
  s.bodies[0].kind      = kind;
  s.bodies[0].thickness = thickness;
  s.bodies[0].friction  = friction;
  s.bodies[0].sheet     = (kind == SurfaceKind::sheet ? 0 : -1);
  return s;
}

/// 2-D: a polyline through these places, body to the left.
inline void
add_polyline(Surface<2>                          &s,
             const std::vector<dealii::Point<2>> &places,
             const bool                           close,
             const double                         inverse_mass = 0)
{
  const unsigned int first = s.nodes.size(), n = places.size();
  for (const auto &x : places)
    add_node(s, x, inverse_mass);
  for (unsigned int i = 0; i + 1 < n; ++i)
    add_facet<2>(s, {{first + i, first + i + 1}});
  if (close)
    add_facet<2>(s, {{first + n - 1, first}});
}

/// 3-D: a grid of nx by ny facets; place(i, j) of its nodes, normal along increasing i cross
/// increasing j.
template <typename Place>
void
add_sheet(Surface<3>        &s,
          const unsigned int nx,
          const unsigned int ny,
          const Place       &place,
          const double       inverse_mass = 0)
{
  const unsigned int first = s.nodes.size();
  for (unsigned int j = 0; j <= ny; ++j)
    for (unsigned int i = 0; i <= nx; ++i)
      add_node<3>(s, place(i, j), inverse_mass);
  for (unsigned int j = 0; j < ny; ++j)
    for (unsigned int i = 0; i < nx; ++i)
      {
        const unsigned int k = first + j * (nx + 1) + i;
        add_facet<3>(s, {{k, k + 1, k + nx + 2, k + nx + 1}});
      }
}

/// One step of everything: contact, then straight motion, then the audit.
template <int dim>
void
step(ContactSystem<dim>             &contacts,
     Surface<dim>                   &surface,
     Points<dim>                    &points,
     std::vector<RigidUnknown<dim>> &rigid,
     const double                    dt)
{
  std::vector<PointSet<dim>> sets = {points.set()};
  contacts.find(surface, sets, dt);
  contacts.build_rows(
    [](const unsigned int, const unsigned int p, std::vector<Rows::Entry> &entries) {
      entries.push_back({p, 1.});
    },
    [&points](const unsigned int p) {
      Unknown<dim> unknown;
      unknown.velocity = points.v(p);
      for (int d = 0; d < dim; ++d)
        unknown.inverse_mass[d] = 1. / points.mass[p];
      unknown.key = p;
      return unknown;
    });
  contacts.solve(rigid, dt);
  std::vector<dealii::Tensor<1, dim>> correction(points.size());
  contacts.point_impulses([&](const unsigned int            p,
                              const dealii::Tensor<1, dim> &impulse,
                              const dealii::Tensor<1, dim> &c) {
    points.change_velocity(p, impulse / points.mass[p]);
    correction[p] = c / points.mass[p];
  });
  std::vector<dealii::Tensor<1, dim>> nodal(surface.nodes.size()),
    nodal_correction(surface.nodes.size());
  contacts.surface_impulses(nodal, nodal_correction);

  for (unsigned int p = 0; p < points.size(); ++p)
    points.move(p, dt * points.v(p) + correction[p]);
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    for (int d = 0; d < dim; ++d)
      {
        auto &node = surface.nodes[i];
        node.velocity[d] += node.inverse_mass[d] * nodal[i][d];
        node.position[d] += dt * node.velocity[d] + node.inverse_mass[d] * nodal_correction[i][d];
      }
  contacts.audit(surface, sets);
}
} // namespace scene
