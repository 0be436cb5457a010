// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/structure/boundary_conditions.h>
#include <coracle/structure/node_columns.h>
#include <coracle/structure/selection.h>

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
            std::max(extent[d], std::fabs(mesh.nodes[n][d] - mesh.nodes[mesh.facets[f].nodes[0]][d]));
      for (int d = 0; d < dim; ++d)
        flatness[d] = std::max(flatness[d], extent[d] / extent.norm());
    }
  for (unsigned int d = 0; d < dim; ++d)
    if (mpi::max(flatness[d], mesh.communicator()) < 1e-6)
      return d;
  throw section.error("Type",
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
BoundaryConditions<dim>::BoundaryConditions(const Parameters         &body,
                                            const StructureMesh<dim> &mesh)
{
  const Parameters section = body.section("Boundary conditions");
  for (const std::string &name : section.section_names())
    conditions.push_back(read(section.section(name), mesh));
}

template <int dim>
typename BoundaryConditions<dim>::Condition
BoundaryConditions<dim>::read(const Parameters &section, const StructureMesh<dim> &mesh) const
{
  const Selection<dim> selection(section, false);
  const std::string    type = section.choice("Type");
  Condition            condition;
  condition.nodes = selection.nodes(mesh);
  if (type == "symmetric")
    {
      condition.directions[normal_axis(section, selection.facets(mesh), mesh)] = true;
      return condition;
    }

  const std::vector<std::string> axes = {"x", "y", "z"};
  const auto words = read_words(section, "Directions", {axes.begin(), axes.begin() + dim});
  for (int d = 0; d < dim; ++d)
    condition.directions[d] = words.empty() || words.count(axes[d]) > 0;
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
      if (condition.directions[d])
        for (const unsigned int n : condition.nodes)
          nodes[NodeColumns<dim>::inverse_mass + d][n] = 0;
}

template <int dim>
void
BoundaryConditions<dim>::prescribe_velocities(Columns     &nodes,
                                              const double time,
                                              const double dt) const
{
  using Columns_ = NodeColumns<dim>;
  for (const Condition &condition : conditions)
    {
      if (condition.function)
        condition.function->set_time(condition.is_displacement ? time + dt : time + dt / 2);
      for (const unsigned int n : condition.nodes)
        {
          dealii::Point<dim> reference;
          for (int d = 0; d < dim; ++d)
            reference[d] = nodes[Columns_::reference + d][n];
          for (int d = 0; d < dim; ++d)
            if (condition.directions[d])
              {
                const double value =
                  condition.function ? condition.function->value(reference, d) : 0.;
                nodes[Columns_::velocity + d][n] =
                  condition.is_displacement ?
                    (value - (nodes[Columns_::position + d][n] - reference[d])) / dt :
                    value;
              }
        }
    }
}

template class BoundaryConditions<2>;
template class BoundaryConditions<3>;
} // namespace coracle
