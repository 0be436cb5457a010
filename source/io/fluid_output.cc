// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/fluid_output.h>

#include <limits>

namespace coracle
{
namespace
{
std::vector<double>
as_numbers(const std::vector<unsigned char> &flags)
{
  return {flags.begin(), flags.end()};
}
} // namespace

template <int dim>
FluidOutput<dim>::FluidOutput(OutputDirectory      &directory,
                              const std::string    &name,
                              const OutputSettings &settings)
  : points(directory, name, settings.particles)
  , elements(directory, name + ".elements", settings.particles.single_precision)
{}

template <int dim>
void
FluidOutput<dim>::write(const double time, const meshless::Fluid<dim> &fluid)
{
  const auto               &cloud = fluid.points;
  const std::vector<double> id(cloud.id.begin(), cloud.id.end()),
    free         = as_numbers(fluid.free_surface);
  Field position = vector_field("position", "m", cloud.position);
  Field velocity = vector_field("velocity", "m/s", fluid.velocity);
  Field number   = scalar_field("id", "1", id);
  number.exact   = true;
  const std::vector<Field> fields{scalar_field("pressure", "Pa", fluid.pressure),
                                  scalar_field("free_surface", "1", free)};
  std::vector<Field>       of_points{position, velocity, fields[0], fields[1], number};
  const bool               has_regions = !fluid.options.regions.empty();
  const auto region = as_numbers(fluid.region), of_element = as_numbers(fluid.element_region);
  if (has_regions)
    of_points.push_back(scalar_field("region", "1", region));
  points.write(time, fluid.n_fluid(), of_points);

  const auto               &mesh = fluid.mesh;
  std::vector<double>       n_nodes, regions;
  std::vector<unsigned int> cells;
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    for (unsigned int s = mesh.first_simplex[e]; s < mesh.first_simplex[e + 1]; ++s)
      {
        n_nodes.push_back(mesh.n_nodes(e));
        if (has_regions)
          regions.push_back(of_element[e]);
        cells.insert(cells.end(), mesh.simplex[s].begin(), mesh.simplex[s].end());
      }
  MeshView view;
  view.shape    = dim == 2 ? CellShape::triangle : CellShape::tetrahedron;
  view.position = position;
  view.n_cells  = n_nodes.size();
  view.cells    = cells.data();
  std::vector<Field> of_cells{scalar_field("points_of_element", "1", n_nodes)};
  if (has_regions)
    of_cells.push_back(scalar_field("region", "1", regions));
  elements.write(time, view, {velocity, fields[0], fields[1]}, of_cells);
}

template <int dim>
void
FluidOutput<dim>::add_columns(Statistics &statistics, const meshless::Fluid<dim> &fluid)
{
  const std::string &name = fluid.name();
  statistics.add_column(name + ".volume", "m^" + std::to_string(dim));
  for (const char *const column : {"volume_drift",
                                   "volume_appeared",
                                   "volume_disappeared",
                                   "points",
                                   "points.inserted",
                                   "points.taken_out",
                                   "points.left",
                                   "points.free",
                                   "points.isolated",
                                   "elements",
                                   "pressure.iterations",
                                   "pressure.residual",
                                   "pressure.unconverged"})
    statistics.add_column(name + "." + column, "");
  statistics.add_vector(name + ".lowest", "m", dim);
  statistics.add_vector(name + ".highest", "m", dim);
  if (!fluid.options.regions.empty())
    {
      statistics.add_column(name + ".viscosity.iterations", "");
      statistics.add_column(name + ".viscosity.unconverged", "");
    }
  for (const auto &region : fluid.options.regions)
    {
      statistics.add_column(name + "." + region.name + ".volume", "m^" + std::to_string(dim));
      statistics.add_vector(name + "." + region.name + ".centre", "m", dim);
      statistics.add_vector(name + "." + region.name + ".velocity", "m/s", dim);
    }
}

template <int dim>
void
FluidOutput<dim>::set_columns(Statistics                 &statistics,
                              const meshless::Fluid<dim> &fluid,
                              MPI_Comm                    comm)
{
  const auto set = [&](const std::string &column, const double value) {
    statistics.set(fluid.name() + "." + column, value);
  };
  const auto summary = fluid.summary();
  set("volume", summary.volume);
  set("volume_drift", summary.volume / fluid.initial_volume - 1.);
  set("volume_appeared", fluid.volume_appeared / fluid.initial_volume);
  set("volume_disappeared", fluid.volume_disappeared / fluid.initial_volume);
  set("points", summary.n_points);
  set("points.inserted", fluid.counts.inserted);
  set("points.taken_out", fluid.counts.taken_out);
  set("points.left", fluid.counts.left);
  set("points.free", summary.n_free);
  set("points.isolated", summary.n_isolated);
  set("elements", summary.n_elements);
  set("pressure.iterations", fluid.last_pressure_solve.iterations);
  set("pressure.residual", fluid.last_pressure_solve.residual);
  set("pressure.unconverged", fluid.unconverged_solves);
  for (unsigned int d = 0; d < dim; ++d)
    {
      double lowest = std::numeric_limits<double>::max(), highest = -lowest;
      for (std::size_t i = 0; i < fluid.n_fluid(); ++i)
        if (!fluid.isolated[i])
          {
            lowest  = std::min(lowest, fluid.points.position[i][d]);
            highest = std::max(highest, fluid.points.position[i][d]);
          }
      const std::string axis = std::string(".") + "xyz"[d];
      set("lowest" + axis, mpi::min(lowest, comm));
      set("highest" + axis, mpi::max(highest, comm));
    }
  if (fluid.options.regions.empty())
    return;
  set("viscosity.iterations", fluid.last_viscous_solve.iterations);
  set("viscosity.unconverged", fluid.unconverged_viscous_solves);
  const auto regions = fluid.region_summaries();
  for (std::size_t k = 0; k < regions.size(); ++k)
    {
      const std::string &region = fluid.options.regions[k].name;
      set(region + ".volume", regions[k].volume);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const std::string axis = std::string(".") + "xyz"[d];
          set(region + ".centre" + axis, regions[k].centre[d]);
          set(region + ".velocity" + axis, regions[k].velocity[d]);
        }
    }
}

template <int dim>
void
FluidOutput<dim>::add_energies(const meshless::Fluid<dim> &fluid,
                               MPI_Comm                    comm,
                               EnergyBooks                &energies)
{
  const auto &books = fluid.books();
  energies.kinetic += mpi::sum(books.kinetic, comm);
  energies.internal += mpi::sum(books.internal, comm);
  energies.damping += mpi::sum(books.damping, comm);
  energies.transfer += mpi::sum(books.transfer, comm);
  energies.boundary += mpi::sum(books.boundary, comm);
  energies.external_work += mpi::sum(books.external_work, comm);
}

template <int dim>
BodyReport<dim>
FluidOutput<dim>::report(const meshless::Fluid<dim> &fluid)
{
  const auto summary = fluid.summary();
  return {fluid.name(), summary.mass, summary.centre, summary.velocity, {}};
}

template <int dim>
void
FluidOutput<dim>::set_probe(const PointProbe<dim>      &probe,
                            const meshless::Fluid<dim> &fluid,
                            Statistics                 &statistics)
{
  // Drops have no mass of their own, but count.
  std::vector<double> mass(fluid.mass.begin(), fluid.mass.begin() + fluid.n_fluid());
  for (double &m : mass)
    m = std::max(m * fluid.options.density, 1e-300);
  ParticleView view;
  view.n_particles = fluid.n_fluid();
  view.position    = vector_field("position", "m", fluid.points.position);
  view.velocity    = vector_field("velocity", "m/s", fluid.velocity);
  view.mass        = mass.data();
  view.pressure    = fluid.pressure.data();
  probe.set_columns(view, statistics);
}

template <int dim>
void
FluidOutput<dim>::serialize(Archive &archive)
{
  points.serialize(archive);
  elements.serialize(archive);
}

template class FluidOutput<2>;
template class FluidOutput<3>;
} // namespace coracle
