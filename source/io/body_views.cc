// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/body_views.h>

namespace coracle
{
Field
columns_field(const std::string &name,
              const std::string &unit,
              const Columns     &columns,
              const unsigned int first,
              const unsigned int n)
{
  Field field{name, unit, {}, 1, false};
  for (unsigned int i = 0; i < n; ++i)
    field.components.push_back(columns[first + i]);
  return field;
}

template <int dim>
NodeView
node_view(const StructuralBody<dim> &body, std::vector<std::uint64_t> &keys)
{
  using Node = NodeColumns<dim>;
  NodeView view;
  view.n_nodes   = body.mesh().n_owned_nodes();
  view.reference = columns_field("reference", "m", body.nodes(), Node::reference, dim);
  view.current   = columns_field("position", "m", body.nodes(), Node::position, dim);
  view.velocity  = columns_field("velocity", "m/s", body.nodes(), Node::velocity, dim);
  keys.clear();
  for (unsigned int node = 0; node < view.n_nodes; ++node)
    keys.push_back(body.key(node));
  view.keys = keys.data();
  return view;
}

template <int dim>
ParticleView
particle_view(const MaterialPoints<dim> &points, std::vector<double> &pressure)
{
  using Layout = ParticleLayout<dim>;
  ParticleView view;
  view.n_particles = points.n_rows();
  view.position    = columns_field("position", "m", points.columns, Layout::position, dim);
  view.velocity    = columns_field("velocity", "m/s", points.columns, Layout::velocity, dim);
  view.mass        = points.column(Layout::mass);
  view.pressure    = points.column(Layout::stress);
  if (points.layout().n_stress > 1)
    {
      pressure.clear();
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        pressure.push_back(-(points.column(Layout::stress)[row] +
                             points.column(Layout::stress + 1)[row] +
                             points.column(Layout::stress + 2)[row]) /
                           3.);
      view.pressure = pressure.data();
    }
  return view;
}

template NodeView     node_view(const StructuralBody<2> &, std::vector<std::uint64_t> &);
template NodeView     node_view(const StructuralBody<3> &, std::vector<std::uint64_t> &);
template ParticleView particle_view(const MaterialPoints<2> &, std::vector<double> &);
template ParticleView particle_view(const MaterialPoints<3> &, std::vector<double> &);
} // namespace coracle
