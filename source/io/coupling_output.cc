// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/body_views.h>
#include <coracle/io/coupling_output.h>
#include <coracle/io/rotation_columns.h>

namespace coracle
{
namespace
{
template <int dim>
using Layout = ParticleLayout<dim>;

// Particles without holes: copies are made only if there are any.
template <int dim>
std::vector<unsigned int>
rows_present(const MaterialPoints<dim> &points)
{
  std::vector<unsigned int> rows;
  rows.reserve(points.n_particles());
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      rows.push_back(row);
  return rows;
}

template <int dim, typename Action>
void
for_each_structure(StructureSystem<dim> &structure, const Action &action)
{
  for (auto &body : structure.solids)
    action(body);
  for (auto &body : structure.rigids)
    action(body);
}

template <int dim>
const StructuralBody<dim> *
find_structure(StructureSystem<dim> &structure, const std::string &name)
{
  const StructuralBody<dim> *result = nullptr;
  for_each_structure(structure, [&](const StructuralBody<dim> &body) {
    if (body.name() == name)
      result = &body;
  });
  return result;
}
} // namespace

template <int dim>
CouplingOutput<dim>::CouplingOutput(const Parameters     &root,
                                    const OutputSettings &settings,
                                    OutputDirectory      &directory,
                                    Coupling<dim>        &coupling)
  : settings(settings)
  , comm(directory.communicator())
  , statistics(directory.file("statistics.csv"), directory.communicator())
{
  std::vector<std::string> names;
  for_each_structure(coupling.structure, [&](const StructuralBody<dim> &body) {
    names.push_back(body.name());
    if (settings.structures)
      structures.emplace_back(directory, body.name());
  });
  for (const auto &body : coupling.points.bodies)
    {
      names.push_back(body.name());
      particles.emplace_back(directory, body.name(), settings.particles);
    }
  for (const auto &body : coupling.fluids.bodies)
    {
      names.push_back(body.name());
      fluids.emplace_back(directory, body.name(), settings);
    }
  if (settings.octree)
    octree = std::make_unique<MeshOutput>(directory, "octree");
  add_standard_columns<dim>(statistics, names);
  for (const auto &body : coupling.points.bodies)
    add_rotation_columns<dim>(statistics, body.name());
  for (const auto &body : coupling.fluids.bodies)
    FluidOutput<dim>::add_columns(statistics, body);
  statistics.add_column("contact.iterations", "");
  statistics.add_column("contact.residual", "m/s");
  statistics.add_column("contact.worst_violation", "m/s");
  statistics.add_column("contact.work", "J");
  statistics.add_column("contact.energy_fed", "J");
  make_probes(root, coupling);
  reported_momentum.resize(names.size());
  reported_force.resize(names.size());
}

template <int dim>
void
CouplingOutput<dim>::make_probes(const Parameters &root, Coupling<dim> &coupling)
{
  std::vector<std::string> structure_names, particle_names, fluid_names;
  for_each_structure(coupling.structure, [&](const StructuralBody<dim> &body) {
    structure_names.push_back(body.name());
  });
  for (const auto &body : coupling.points.bodies)
    particle_names.push_back(body.name());
  for (const auto &body : coupling.fluids.bodies)
    fluid_names.push_back(body.name());
  particle_names.insert(particle_names.end(), fluid_names.begin(), fluid_names.end());
  std::vector<std::uint64_t> keys;
  for (const auto &description : ProbeDescription<dim>::read(
         root.section("Probes"), structure_names, particle_names, fluid_names))
    if (description.kind == ProbeKind::body_point)
      {
        const auto *const body = find_structure(coupling.structure, description.body);
        body_probes.emplace_back(description.body,
                                 BodyPointProbe<dim>(description, node_view(*body, keys), comm));
        BodyPointProbe<dim>::add_columns(description, statistics);
      }
    else if (description.kind == ProbeKind::surface)
      {
        gauges.emplace_back(description, comm);
        SurfaceGauge<dim>::add_columns(description, statistics);
      }
    else
      {
        point_probes.emplace_back(description.body, PointProbe<dim>(description, comm));
        PointProbe<dim>::add_columns(description, statistics);
      }
}

template <int dim>
void
CouplingOutput<dim>::follow_meshes(Coupling<dim> &coupling)
{
  unsigned int changes = 0;
  for_each_structure(coupling.structure,
                     [&changes](const auto &body) { changes += body.n_mesh_changes(); });
  std::vector<std::uint64_t> keys;
  if (changes != mesh_changes)
    for (auto &[body, probe] : body_probes)
      probe.find_again(node_view(*find_structure(coupling.structure, body), keys));
  mesh_changes = changes;
}

template <int dim>
void
CouplingOutput<dim>::write(Coupling<dim> &coupling)
{
  files_step     = coupling.step();
  unsigned int i = 0;
  for (auto &body : coupling.points.bodies)
    write_particles(body, particles[i++], coupling.time());
  i = 0;
  for (const auto &body : coupling.fluids.bodies)
    fluids[i++].write(coupling.time(), body);
  if (settings.structures)
    {
      i = 0;
      for (const auto &body : coupling.structure.solids)
        {
          std::vector<Symmetric<dim, double>> stress;
          for (unsigned int e = 0; e < body.mesh().n_elements(); ++e)
            stress.push_back(body.stress(e));
          write_structure(body, &stress, structures[i++], coupling.time());
        }
      for (const auto &body : coupling.structure.rigids)
        write_structure(body, nullptr, structures[i++], coupling.time());
    }
  if (octree)
    write_octree(coupling);
}

template <int dim>
void
CouplingOutput<dim>::write_particles(const MaterialPointBody<dim> &body,
                                     ParticleOutput               &output,
                                     const double                  time)
{
  const auto        &points   = body.points;
  const auto         rows     = rows_present(points);
  const unsigned int n_stress = points.layout().n_stress;
  const unsigned int first[]  = {Layout<dim>::position,
                                 Layout<dim>::velocity,
                                 static_cast<unsigned int>(Layout<dim>::stress),
                                 Layout<dim>::density,
                                 Layout<dim>::size,
                                 Layout<dim>::id};
  const unsigned int width[]  = {dim, dim, n_stress, 1, 1, 1};
  const char *const  name[]   = {
       "position", "velocity", n_stress == 1 ? "pressure" : "stress", "density", "size", "id"};
  const char *const                unit[] = {"m", "m/s", "Pa", "kg/m^3", "m", "1"};
  std::vector<std::vector<double>> copies;
  std::vector<Field>               fields;
  for (unsigned int f = 0; f < 6; ++f)
    {
      Field field{name[f], unit[f], {}, 1, first[f] == Layout<dim>::id};
      for (unsigned int c = 0; c < width[f]; ++c)
        {
          const double *column = points.column(first[f] + c);
          if (rows.size() < points.n_rows())
            {
              copies.emplace_back(rows.size() + 1);
              for (std::size_t i = 0; i < rows.size(); ++i)
                copies.back()[i] = column[rows[i]];
              column = copies.back().data();
            }
          field.components.push_back(column);
        }
      fields.push_back(field);
    }
  std::vector<double> pressure;
  if (n_stress > 1)
    {
      for (const unsigned int row : rows)
        pressure.push_back(-(points.column(Layout<dim>::stress)[row] +
                             points.column(Layout<dim>::stress + 1)[row] +
                             points.column(Layout<dim>::stress + 2)[row]) /
                           3.);
      fields.push_back(scalar_field("pressure", "Pa", pressure));
    }
  output.write(time, rows.size(), fields);
}

template <int dim>
void
CouplingOutput<dim>::write_structure(const StructuralBody<dim>                 &body,
                                     const std::vector<Symmetric<dim, double>> *stress,
                                     MeshOutput                                &output,
                                     const double                               time)
{
  using Node = NodeColumns<dim>;
  MeshView view;
  view.shape    = body.mesh().cell_dimension() == dim ? cell_shape<dim> : cell_shape<dim - 1>;
  view.position = columns_field("position", "m", body.nodes(), Node::position, dim);
  view.n_cells  = body.mesh().n_cells();
  view.cells    = body.mesh().cells();
  std::vector<dealii::Tensor<1, dim>> displacement(body.mesh().n_nodes());
  for (unsigned int node = 0; node < displacement.size(); ++node)
    displacement[node] = body.displacement(node);
  std::vector<Field> cell_fields;
  if (stress != nullptr)
    {
      Field field{"stress", "Pa", {}, Symmetric<dim, double>::size, false};
      for (int k = 0; k < Symmetric<dim, double>::size; ++k)
        field.components.push_back(stress->empty() ? nullptr : &stress->front().s[k]);
      cell_fields.push_back(field);
    }
  output.write(time,
               view,
               {vector_field("displacement", "m", displacement),
                columns_field("velocity", "m/s", body.nodes(), Node::velocity, dim),
                columns_field("contact_force", "N", body.nodes(), Node::contact_force, dim)},
               cell_fields);
}

template <int dim>
void
CouplingOutput<dim>::write_octree(const Coupling<dim> &coupling)
{
  const auto &tree = coupling.points.octree;
  MeshView    view;
  view.shape = cell_shape<dim>;
  std::vector<dealii::Point<dim>> positions(tree.n_nodes());
  for (unsigned int node = 0; node < tree.n_nodes(); ++node)
    positions[node] = tree.position(node);
  view.position = vector_field("position", "m", positions);
  view.n_cells  = tree.n_owned_leaves();
  view.cells    = view.n_cells > 0 ? tree.nodes(0).data() : nullptr;
  std::vector<double> size(view.n_cells), rank(view.n_cells, mpi::rank(comm)),
    n_particles(view.n_cells, 0.);
  for (unsigned int leaf = 0; leaf < view.n_cells; ++leaf)
    size[leaf] = tree.size(leaf);
  for (const auto &body : coupling.points.bodies)
    for (std::size_t row = 0; row < body.points.n_rows(); ++row)
      if (!body.points.is_hole(row))
        n_particles[tree.find(body.points.position(row))] += 1.;
  octree->write(coupling.time(),
                view,
                {},
                {scalar_field("cell_size", "m", size),
                 scalar_field("rank", "1", rank),
                 scalar_field("particles", "1", n_particles)});
}

template <int dim>
void
CouplingOutput<dim>::write_statistics(const Report<dim> &report, Coupling<dim> &coupling)
{
  row_step = coupling.step();
  statistics.begin_row();
  set_standard_columns(statistics, report);
  auto summary =
    report.bodies.end() - coupling.points.bodies.size() - coupling.fluids.bodies.size();
  for (const auto &body : coupling.points.bodies)
    {
      set_rotation_columns<dim>(statistics,
                                body.name(),
                                rotation_of(body.points, summary->centre, summary->velocity, comm));
      ++summary;
    }
  for (const auto &body : coupling.fluids.bodies)
    FluidOutput<dim>::set_columns(statistics, body, comm);
  const auto &solver = coupling.contacts.report().solver;
  statistics.set("contact.iterations", solver.velocity.iterations);
  statistics.set("contact.residual", solver.velocity.residual);
  statistics.set("contact.worst_violation", solver.worst_violation);
  statistics.set("contact.work", coupling.contacts.report().work);
  statistics.set("contact.energy_fed", coupling.contacts.report().energy_fed);
  follow_meshes(coupling);
  std::vector<std::uint64_t> keys;
  for (const auto &[body, probe] : body_probes)
    probe.set_columns(node_view(*find_structure(coupling.structure, body), keys), statistics);
  // A case has one meshless fluid.
  for (const auto &gauge : gauges)
    gauge.set_columns(coupling.fluids.bodies.front(), statistics);
  for (const auto &[name, probe] : point_probes)
    for (const auto &body : coupling.fluids.bodies)
      if (body.name() == name)
        FluidOutput<dim>::set_probe(probe, body, statistics);
  for (const auto &[name, probe] : point_probes)
    for (const auto &body : coupling.points.bodies)
      if (body.name() == name)
        {
          std::vector<double> pressure;
          probe.set_columns(particle_view(body.points, pressure),
                            statistics,
                            body.points.reproducible);
        }
  statistics.end_row();
}

template <int dim>
void
CouplingOutput<dim>::serialize(Archive &archive)
{
  const Archive::Section section(archive, "output");
  mpi::agree([&] { statistics.serialize(archive); }, comm);
  for (auto &series : particles)
    series.serialize(archive);
  for (auto &series : fluids)
    series.serialize(archive);
  for (auto &series : structures)
    series.serialize(archive);
  if (octree)
    octree->serialize(archive);
  for (auto &[body, probe] : body_probes)
    {
      const Archive::Section part(archive, "probe " + probe.name());
      probe.serialize(archive);
    }
  // Meshes have been loaded: nodes are looked for again.
  if (archive.loads())
    mesh_changes = -1;
  balance.serialize(archive);
  archive.same("reported_momentum", reported_momentum);
  archive.same("reported_force", reported_force);
  archive.same("reported_time", reported_time);
  archive.same("first_report", first_report);
  archive.same("files_step", files_step);
  archive.same("row_step", row_step);
}

template class CouplingOutput<2>;
template class CouplingOutput<3>;
} // namespace coracle
