// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/fluid.h>
#include <coracle/meshless/partition.h>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace coracle::meshless
{
template <int dim>
Fluid<dim>::Fluid(const std::string &name, const FluidOptions<dim> &options, const MPI_Comm comm)
  : columns(Layout::n_columns)
  , halo(comm)
  , options(options)
  , period(options.box, options.periodic)
  , body_name(name)
  , comm(comm)
  , pressure_system(comm)
  , viscous_system(comm)
{
  structures.slip  = options.slips_on_structures;
  structures.reach = options.spacing;
}

template <int dim>
void
Fluid<dim>::add_point(const dealii::Point<dim> &position,
                      const Vector             &velocity,
                      const std::uint64_t       id,
                      const unsigned int        region)
{
  Assert(region <= options.regions.size(), dealii::ExcMessage("No such region"));
  const std::size_t row = columns.size();
  columns.resize(row + 1);
  const auto   corners = options.box.get_boundary_points();
  unsigned int on      = 0;
  for (unsigned int d = 0; d < dim; ++d)
    {
      columns[Layout::position + d][row] = position[d];
      columns[Layout::velocity + d][row] = velocity[d];
      for (unsigned int side = 0; side < 2; ++side)
        {
          const double place = side == 0 ? corners.first[d] : corners.second[d];
          if (options.walls[2 * d + side] == Wall::open ||
              std::fabs(position[d] - place) > 1e-6 * options.spacing)
            continue;
          on |= 1u << (2 * d + side);
          columns[Layout::position + d][row] = place;
          columns[Layout::velocity + d][row] = 0;
        }
    }
  for (unsigned int face = 0; face < 2 * dim; ++face)
    if ((on >> face & 1) && options.walls[face] == Wall::stick)
      for (unsigned int d = 0; d < dim; ++d)
        columns[Layout::velocity + d][row] = 0;
  columns[Layout::spacing][row] = options.spacing;
  columns[Layout::id][row]      = id;
  columns[Layout::walls][row]   = on;
  columns[Layout::sliding][row] = 0;
  columns[Layout::region][row]  = region;
  next_id                       = std::max(next_id, id + 1);
}

template <int dim>
void
Fluid<dim>::wrap()
{
  for (std::size_t i = 0; i < columns.size() && period.any(); ++i)
    {
      dealii::Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = columns[Layout::position + d][i];
      x = period.wrapped(x);
      for (unsigned int d = 0; d < dim; ++d)
        columns[Layout::position + d][i] = x[d];
    }
}

template <int dim>
void
Fluid<dim>::fill_cloud()
{
  const std::size_t n = columns.size();
  points              = PointCloud<dim>();
  points.n_own        = n;
  n_cloud             = n;
  points.position.resize(n);
  points.spacing.resize(n);
  points.kind.assign(n, PointKind::fluid);
  points.id.resize(n);
  velocity.resize(n);
  pressure.assign(columns[Layout::pressure], columns[Layout::pressure] + n);
  walls.resize(n);
  region.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          points.position[i][d] = columns[Layout::position + d][i];
          velocity[i][d]        = columns[Layout::velocity + d][i];
        }
      points.id[i] = columns[Layout::id][i];
      // Between points of the surface elements must be smaller: surfaces join once they are near,
      // and do not fill the room between with fluid that was not there.
      const double share = options.surface_alpha / options.tessellation.alpha;
      points.spacing[i] = columns[Layout::spacing][i] * (columns[Layout::free][i] > 0 ? share : 1.);
      columns[Layout::was_free][i] = columns[Layout::free][i];
      walls[i]                     = columns[Layout::walls][i];
      region[i]                    = columns[Layout::region][i];
      if (columns[Layout::sliding][i] > 0)
        points.kind[i] = PointKind::sliding;
    }
}

template <int dim>
void
Fluid<dim>::remesh(const bool may_balance)
{
  const double old_kinetic = energy.kinetic;
  next_id                  = mpi::max(next_id, comm);
  wrap();
  fill_cloud();
  if (may_balance)
    balance();
  hold_wet_ridges();
  add_structure_points();
  halo.rebuild(points, options.tessellation.halo_width(options.spacing), period);
  halo.update(velocity);
  halo.update(pressure);
  halo.update(walls);
  mesh = tessellate(points, options.tessellation, comm);
  std::copy_n(columns[Layout::spacing], n_cloud, points.spacing.begin());
  halo.update(points.spacing);
  rules.reinit(points, mesh);
  FluidOperators<dim>(mesh, rules, halo).lumped_volume(volume);
  find_element_regions();
  find_masses(rules, volume, mass);
  find_free_surface();
  energy.kinetic = 0;
  for (std::size_t i = 0; i < n_cloud; ++i)
    energy.kinetic += 0.5 * options.density * mass[i] * velocity[i].norm_square();
  if (initial_volume > 0)
    energy.transfer += old_kinetic - energy.kinetic;
  find_volume();
}

/// Points are shared out from time to time; neighbours in space are near in memory then, too.
template <int dim>
void
Fluid<dim>::balance()
{
  const std::vector<double> weight(points.n_own, 1.);
  if (steps_since_balance++ < steps_between_balances && imbalance(weight, comm) < 1.1)
    return;
  steps_since_balance = 0;
  migrate(points, columns, partition(points, weight, comm), comm);
  fill_cloud();
}

template <int dim>
void
Fluid<dim>::find_volume()
{
  current_volume = mpi::sum(std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.), comm);
  if (initial_volume == 0)
    initial_volume = current_volume;
  // At the start, and after loading, there is nothing to compare with.
  if (moved_boundary)
    {
      const auto change = volume_change(*moved_boundary, boundary_of(points, mesh), comm, period);
      volume_appeared += change.appeared;
      volume_disappeared += change.disappeared;
    }
  moved_boundary.reset();
}

// Facets whose points are all on one face of the box, or all of structures, are wall, all other
// ones of the boundary are free surface.
template <int dim>
void
Fluid<dim>::find_free_surface()
{
  std::vector<double> n_free(points.size());
  surface_facets.clear();
  surface_elements.clear();
  wall_facets.clear();
  for (const auto &facet : mesh.boundary_facet)
    {
      unsigned int common    = ~0u;
      bool         structure = true;
      for (const unsigned int node : facet)
        {
          common &= walls[node];
          structure &= is_structure(node) || is_sliding(node);
        }
      if (structure)
        wall_facets.push_back(facet);
      else if (common == 0)
        surface_facets.push_back(facet);
      if (!structure && common == 0)
        for (const unsigned int node : facet)
          n_free[node] += 1;
    }
  halo.sum_to_owners(n_free);
  at_surface.assign(points.n_own, 0);
  free_surface.assign(points.n_own, 0);
  isolated.assign(points.n_own, 0);
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      at_surface[i]   = n_free[i] > 0;
      isolated[i]     = !mesh.has_element[i];
      free_surface[i] = !is_structure(i) && (isolated[i] || n_free[i] > 0);
      if (isolated[i])
        pressure[i] = 0;
      if (i < n_cloud)
        columns[Layout::free][i] = free_surface[i];
    }
  no_pressure = isolated;
  // Where the fluid fills the box, the pressure of one point is chosen.
  std::uint64_t lowest = std::numeric_limits<std::uint64_t>::max();
  if (mpi::max<unsigned int>(std::count(free_surface.begin(), free_surface.end(), 1) > 0, comm) ==
      0)
    {
      for (std::size_t i = 0; i < points.n_own; ++i)
        lowest = std::min(lowest, points.id[i]);
      lowest = mpi::min(lowest, comm);
      for (std::size_t i = 0; i < points.n_own; ++i)
        if (points.id[i] == lowest)
          no_pressure[i] = 1;
    }
  halo.update(at_surface);
  halo.update(free_surface);
  halo.update(isolated);
  halo.update(no_pressure);
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    if (std::any_of(mesh.node.begin() + mesh.first_node[e],
                    mesh.node.begin() + mesh.first_node[e + 1],
                    [&](const unsigned int node) { return free_surface[node]; }))
      surface_elements.push_back(e);
  halo.update(pressure);
}

template <int dim>
typename Fluid<dim>::Summary
Fluid<dim>::summary() const
{
  std::array<double, 6 + 2 * dim> sums{};
  sums[0] = n_cloud;
  sums[1] = mesh.n_elements();
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      if (i < n_cloud)
        {
          sums[2] += free_surface[i];
          sums[3] += isolated[i];
        }
      sums[4] += volume[i];
      sums[5] += mass[i];
      for (unsigned int d = 0; d < dim; ++d)
        {
          sums[6 + d] += mass[i] * points.position[i][d];
          sums[6 + dim + d] += mass[i] * velocity[i][d];
        }
    }
  std::array<double, 6 + 2 * dim> total{};
  MPI_Allreduce(sums.data(), total.data(), total.size(), MPI_DOUBLE, MPI_SUM, comm);
  Summary result;
  result.n_points   = total[0];
  result.n_elements = total[1];
  result.n_free     = total[2];
  result.n_isolated = total[3];
  result.volume     = total[4];
  result.mass       = options.density * total[5];
  for (unsigned int d = 0; d < dim && total[5] > 0; ++d)
    {
      result.centre[d]   = total[6 + d] / total[5];
      result.velocity[d] = total[6 + dim + d] / total[5];
    }
  return result;
}

template <int dim>
std::string
Fluid<dim>::describe_limit() const
{
  // Speed, id, place.
  std::array<double, 2 + dim> fastest{};
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (velocity[i].norm() > fastest[0])
      {
        fastest = {velocity[i].norm(), static_cast<double>(points.id[i])};
        for (unsigned int d = 0; d < dim; ++d)
          fastest[2 + d] = points.position[i][d];
      }
  for (const auto &other : dealii::Utilities::MPI::all_gather(comm, fastest))
    fastest = std::max(fastest, other);
  std::ostringstream text;
  text << "'" << body_name << "' asks for it, whose fastest point is number " << fastest[1]
       << " at (";
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << fastest[2 + d];
  text << ") m with " << fastest[0] << " m/s";
  return text.str();
}

template <int dim>
void
Fluid<dim>::serialize(Archive &archive)
{
  const Archive::Section section(archive, "body " + body_name);
  archive.rows("points", columns);
  // The elements are found anew, as they were.
  if (archive.loads())
    std::copy_n(columns[Layout::was_free], columns.size(), columns[Layout::free]);
  archive.share("energy.kinetic", energy.kinetic);
  archive.share("energy.internal", energy.internal);
  archive.share("energy.damping", energy.damping);
  archive.share("energy.transfer", energy.transfer);
  archive.share("energy.boundary", energy.boundary);
  archive.share("energy.external_work", energy.external_work);
  archive.same("initial_volume", initial_volume);
  archive.same("volume_appeared", volume_appeared);
  archive.same("volume_disappeared", volume_disappeared);
  archive.same("counts", counts);
  archive.same("next_id", next_id);
  archive.same("steps_since_balance", steps_since_balance);
  if (!archive.is_exact())
    steps_since_balance = steps_between_balances;
  archive.same("pressure_solves", pressure_solves);
  archive.same("pressure_iterations", pressure_iterations);
  archive.same("unconverged_solves", unconverged_solves);
  archive.same("unconverged_viscous_solves", unconverged_viscous_solves);
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
