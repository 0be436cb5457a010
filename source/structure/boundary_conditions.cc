// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/structure/boundary_conditions.h>
#include <coracle/structure/node_columns.h>
#include <coracle/structure/selection.h>

#include <algorithm>
#include <iterator>

namespace coracle
{
namespace
{
/// The direction that the facets' normals point in, which must be an axis, the same on all ranks.
template <int dim>
unsigned int
normal_axis(const Parameters                &section,
            const std::vector<unsigned int> &facets,
            const StructureMesh<dim>        &mesh)
{
  // Extent of each facet along the axes: none along its normal.
  std::array<double, dim> flatness{};
  for (const unsigned int f : facets)
    {
      dealii::Tensor<1, dim> extent;
      for (const unsigned int n : mesh.facets[f].nodes)
        for (int d = 0; d < dim; ++d)
          extent[d] =
            std::max(extent[d],
                     std::fabs(mesh.nodes[n][d] - mesh.nodes[mesh.facets[f].nodes[0]][d]));
      for (int d = 0; d < dim; ++d)
        flatness[d] = std::max(flatness[d], extent[d] / extent.norm());
    }
  for (unsigned int d = 0; d < dim; ++d)
    if (mpi::max(flatness[d], mesh.communicator()) < 1e-6)
      return d;
  throw section.error(
    "Type",
    "symmetry on a surface that is not a plane across an axis",
    "faces with other normals",
    "select faces with one normal along x, y or z, or use `fixed` with Directions");
}
} // namespace

template <int dim>
void
BoundaryConditions<dim>::declare(Declaration &body_section)
{
  Declaration &section =
    body_section.named_sections("Boundary conditions", "condition", "Motion that is prescribed");
  Selection<dim>::declare(section);
  section.choice("Type",
                 "fixed",
                 {"fixed", "symmetric", "velocity", "displacement"},
                 "fixed: the nodes stay; symmetric: they stay in their plane across an axis; "
                 "velocity, displacement: they follow a function");
  const char *directions = "which ones are prescribed: some of x, y, z; empty for all";
  section.when("Type", "fixed").text("Directions", "", directions);
  for (const auto &[type, name, unit] :
       {std::array<std::string, 3>{{"velocity", "Velocity", "m/s"}},
        std::array<std::string, 3>{{"displacement", "Displacement", "m"}}})
    {
      Declaration &moved = section.when("Type", type);
      moved.text("Directions", "", directions);
      moved.function(name, "0", unit, "components in x, y, z, t, of the unloaded position");
    }
}

template <int dim>
BoundaryConditions<dim>::BoundaryConditions(const Parameters &body, const StructureMesh<dim> &mesh)
{
  const Parameters section = body.section("Boundary conditions");
  for (const std::string &name : section.section_names())
    {
      Condition added = read(section.section(name), mesh);
      for (Condition &earlier : conditions)
        for (int d = 0; d < dim; ++d)
          {
            std::vector<unsigned int> kept;
            std::set_difference(earlier.nodes[d].begin(),
                                earlier.nodes[d].end(),
                                added.nodes[d].begin(),
                                added.nodes[d].end(),
                                std::back_inserter(kept));
            earlier.nodes[d] = kept;
          }
      conditions.push_back(std::move(added));
    }
}

template <int dim>
typename BoundaryConditions<dim>::Condition
BoundaryConditions<dim>::read(const Parameters &section, const StructureMesh<dim> &mesh) const
{
  const Selection<dim>  selection(section, false);
  const std::string     type = section.choice("Type");
  Condition             condition;
  std::array<bool, dim> prescribed{};
  if (type == "symmetric")
    prescribed[normal_axis(section, selection.facets(mesh), mesh)] = true;
  else
    {
      const std::vector<std::string> axes = {"x", "y", "z"};
      const auto words = read_words(section, "Directions", {axes.begin(), axes.begin() + dim});
      for (int d = 0; d < dim; ++d)
        prescribed[d] = words.empty() || words.count(axes[d]) > 0;
    }
  for (const unsigned int n : selection.nodes(mesh))
    if (n < mesh.n_owned_nodes())
      for (int d = 0; d < dim; ++d)
        if (prescribed[d])
          condition.nodes[d].push_back(n);

  condition.is_displacement = (type == "displacement");
  if (type == "velocity")
    condition.function = section.template function<dim>("Velocity", dim);
  else if (type == "displacement")
    condition.function = section.template function<dim>("Displacement", dim);
  return condition;
}

template <int dim>
void
BoundaryConditions<dim>::constrain(Columns &nodes) const
{
  for (const Condition &condition : conditions)
    for (int d = 0; d < dim; ++d)
      for (const unsigned int n : condition.nodes[d])
        nodes[NodeColumns<dim>::inverse_mass + d][n] = 0;
}

template <int dim>
double
BoundaryConditions<dim>::velocity(const Condition   &condition,
                                  Columns           &nodes,
                                  const unsigned int n,
                                  const int          d,
                                  const double       dt) const
{
  if (!condition.function)
    return 0;
  dealii::Point<dim> reference;
  for (int i = 0; i < dim; ++i)
    reference[i] = nodes[NodeColumns<dim>::reference + i][n];
  const double value = condition.function->value(reference, d);
  if (!condition.is_displacement)
    return value;
  return (value - (nodes[NodeColumns<dim>::position + d][n] - reference[d])) / dt;
}

template <int dim>
void
BoundaryConditions<dim>::prescribe_velocities(Columns     &nodes,
                                              const double time,
                                              const double dt,
                                              const double duration,
                                              RankSums    &work) const
{
  using Node = NodeColumns<dim>;
  for (const Condition &condition : conditions)
    {
      if (condition.function)
        condition.function->set_time(condition.is_displacement ? time + dt : time + dt / 2);
      for (int d = 0; d < dim; ++d)
        for (const unsigned int n : condition.nodes[d])
          {
            double      &v     = nodes[Node::velocity + d][n];
            const double after = velocity(condition, nodes, n, d, dt), mean = 0.5 * (v + after),
                         internal = duration * nodes[Node::internal + d][n] * mean;
            work.add(0, -internal);
            work.add(1, nodes[Node::mass][n] * (after - v) * mean - internal);
            v = after;
          }
    }
}

template class BoundaryConditions<2>;
template class BoundaryConditions<3>;
} // namespace coracle
