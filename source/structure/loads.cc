// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/structure/facet_integrals.h>
#include <coracle/structure/loads.h>
#include <coracle/structure/node_columns.h>
#include <coracle/structure/selection.h>

#include <cmath>

namespace coracle
{
template <int dim>
void
Loads<dim>::declare(Declaration &body_section)
{
  Declaration &section = body_section.named_sections("Loads", "load", "Forces besides gravity");
  section.choice("Type",
                 "pressure",
                 {"pressure", "traction", "acceleration"},
                 "pressure follows the surface as it moves; traction keeps its direction and acts "
                 "on the unloaded area; acceleration acts on all mass");
  Declaration &pressure = section.when("Type", "pressure");
  Selection<dim>::declare(pressure);
  pressure.function(
    "Pressure",
    "0",
    "Pa",
    "positive into the body, in x, y, z, t of the middle of a facet where it is now");
  Declaration &traction = section.when("Type", "traction");
  Selection<dim>::declare(traction);
  traction.function("Traction",
                    "0",
                    "Pa",
                    "components in x, y, z, t of the middle of a facet where it was unloaded");
  section.when("Type", "acceleration")
    .function("Acceleration", "0", "m/s^2", "components in x, y, z, t of the node where it is now");
}

template <int dim>
Loads<dim>::Loads(const Parameters &body, const StructureMesh<dim> &mesh)
  : n_owned_nodes(mesh.n_owned_nodes())
{
  const Parameters section = body.section("Loads");
  for (const std::string &name : section.section_names())
    loads.push_back(read(section.section(name), mesh));
}

template <int dim>
typename Loads<dim>::Load
Loads<dim>::read(const Parameters &section, const StructureMesh<dim> &mesh) const
{
  const std::string type = section.choice("Type");
  Load              load;
  if (type == "acceleration")
    {
      load.kind     = Kind::acceleration;
      load.function = section.template function<dim>("Acceleration", dim);
      return load;
    }
  load.kind     = (type == "pressure" ? Kind::pressure : Kind::traction);
  load.function = (type == "pressure" ? section.template function<dim>("Pressure", 1)
                                      : section.template function<dim>("Traction", dim));
  for (const unsigned int f : Selection<dim>(section, true).facets(mesh))
    load.facets.push_back(mesh.facets[f].nodes);
  return load;
}

template <int dim>
void
Loads<dim>::add_forces(Columns &nodes, const double time, const SumGrid &grid) const
{
  for_each_force(nodes, time, [&](const unsigned int node, const int d, const double force) {
    nodes[NodeColumns<dim>::external + d][node] += grid.round(force);
  });
}

template <int dim>
double
Loads<dim>::largest_force(const Columns &nodes, const double time) const
{
  double result = 0;
  for_each_force(nodes, time, [&](const unsigned int, const int, const double force) {
    result = std::max(result, std::abs(force));
  });
  return result;
}

template <int dim>
template <typename Give>
void
Loads<dim>::for_each_force(const Columns &nodes, const double time, const Give &give) const
{
  for (const Load &load : loads)
    {
      load.function->set_time(time);
      if (load.kind == Kind::acceleration)
        for_each_node_force(load, nodes, give);
      else
        for_each_facet_force(load, nodes, give);
    }
}

template <int dim>
template <typename Give>
void
Loads<dim>::for_each_facet_force(const Load &load, const Columns &nodes, const Give &give) const
{
  const bool         follows = (load.kind == Kind::pressure);
  const unsigned int from    = follows ? NodeColumns<dim>::position : NodeColumns<dim>::reference;
  for (const auto &facet : load.facets)
    {
      FacetCorners<dim>  corners;
      dealii::Point<dim> middle;
      for (std::size_t n = 0; n < facet.size(); ++n)
        {
          for (int d = 0; d < dim; ++d)
            corners[n][d] = nodes[from + d][facet[n]];
          middle += corners[n] / double(facet.size());
        }
      const auto areas = nodal_areas<dim>(corners);
      for (std::size_t n = 0; n < facet.size(); ++n)
        for (int d = 0; d < dim; ++d)
          give(facet[n],
               d,
               follows ? -load.function->value(middle) * areas[n][d]
                       : load.function->value(middle, d) * areas[n].norm());
    }
}

template <int dim>
template <typename Give>
void
Loads<dim>::for_each_node_force(const Load &load, const Columns &nodes, const Give &give) const
{
  for (unsigned int n = 0; n < n_owned_nodes; ++n)
    {
      dealii::Point<dim> x;
      for (int d = 0; d < dim; ++d)
        x[d] = nodes[NodeColumns<dim>::position + d][n];
      for (int d = 0; d < dim; ++d)
        give(n, d, nodes[NodeColumns<dim>::mass][n] * load.function->value(x, d));
    }
}

template class Loads<2>;
template class Loads<3>;
} // namespace coracle
