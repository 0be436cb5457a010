// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/diffusion_system.h>
#include <coracle/meshless/fluid.h>

#include <algorithm>
#include <sstream>

namespace coracle::meshless
{
namespace
{
/// Share of E M^-1 E^T that holds pressures of the surface that nothing else determines, those of a
/// single element: they are 0 where the pressure is linear.
constexpr double surface_share = 1e-3;
} // namespace

template <int dim>
double
Fluid<dim>::step_limit() const
{
  // |v| dt + g dt^2 / 2 = C h.
  const double g    = options.gravity.norm();
  double       step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      const double v = velocity[i].norm(), move = options.largest_move * points.spacing[i];
      if (v > 0 || g > 0)
        step = std::min(step, 2 * move / (v + std::sqrt(v * v + 2 * g * move)));
    }
  for (const auto &node : structures.surface.nodes)
    step =
      std::min(step,
               options.largest_move * options.spacing / std::max(node.velocity.norm(), 1e-300));
  return mpi::min(step, comm);
}

template <int dim>
void
Fluid<dim>::advance(const double time,
                    const double dt,
                    TimingTable &timed,
                    const double push_duration)
{
  push_time = push_duration > 0 ? push_duration : dt;
  // Of structures too that of the step before: without the fluid a body that floats would fall.
  moving  = velocity;
  last_dt = dt;
  surface_pressure.resize(points.size());
  carry_points();
  for (unsigned int iteration = 0; iteration < options.n_iterations; ++iteration)
    {
      timed("elements", [&] { move_elements(dt, iteration, timed); });
      timed("predictor", [&] { predict(time, dt); });
      timed("pressure", [&] { solve_pressure(dt, iteration, timed); });
      timed("correction", [&] { correct(dt); });
    }
  timed("move", [&] {
    move(dt);
    find_moved_boundary();
  });
  check_numbers();
}

// Elements halfway along the motion known so far. Connections stay, so that the pattern and, in the
// plane, the preconditioner of the first iteration serve them all.
template <int dim>
void
Fluid<dim>::move_elements(const double dt, const unsigned int iteration, TimingTable &timed)
{
  scratch.resize(moving.size());
  for (std::size_t i = 0; i < moving.size(); ++i)
    scratch[i] = 0.5 * dt * moving[i];
  moved_rules.set_moved(rules, mesh, scratch);
  FluidOperators<dim>(mesh, moved_rules, halo).lumped_volume(moved_volume);
  find_masses(moved_rules, moved_volume, moved_mass);
  find_surface_areas();
  if (iteration == 0)
    timed("pattern", [&] {
      pressure_system.reinit(mesh, halo);
      if (!options.regions.empty())
        viscous_system.reinit(mesh, viscosity, halo);
    });
}

template <int dim>
void
Fluid<dim>::predict(const double time, const double dt)
{
  std::vector<Vector> acceleration(points.n_own, options.gravity);
  if (body_force)
    {
      body_force->set_time(time + 0.5 * dt);
      for (std::size_t i = 0; i < points.n_own; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          acceleration[i][d] += body_force->value(points.position[i] + scratch[i], d);
    }
  predicted = velocity;
  for (std::size_t i = 0; i < points.n_own; ++i)
    predicted[i] += dt * acceleration[i];
  if (!options.regions.empty())
    diffuse_regions(dt, acceleration);
  else if (options.viscosity > 0)
    diffuse(dt, acceleration);
  halo.update(predicted);
}

// Viscosity acts on what forces leave to it once the pressure known so far has taken its part: what
// pressure balances must not be smoothed, and what it does not must be, or a driven channel would
// be too fast by theta dt f. Where walls hold the velocity viscosity changes nothing.
template <int dim>
void
Fluid<dim>::diffuse(const double dt, const std::vector<Vector> &acceleration)
{
  const double              nu = options.viscosity / options.density;
  const FluidOperators<dim> apply(mesh, moved_rules, halo);
  std::vector<Vector>       force, balanced(acceleration), change(points.n_own);
  apply.laplacian(velocity, force);
  // Before the first solution, as if pressure balanced everything.
  if (pressure_solves > 0)
    {
      apply.gradient(pressure, gradient);
      for (std::size_t i = 0; i < points.n_own; ++i)
        if (!isolated[i])
          balanced[i] =
            (gradient[i] - pressure[i] * surface_area[i]) / (options.density * moved_volume[i]);
    }
  std::vector<unsigned char> held(points.n_own);
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      force[i] = dt * (moved_volume[i] * (acceleration[i] - balanced[i]) - nu * force[i]);
      for (unsigned int d = 0; d < dim; ++d)
        held[i] |= is_held(i, d) << d;
    }
  DiffusionSystem<dim> system(apply, halo, comm);
  system.set({moved_volume.begin(), moved_volume.begin() + points.n_own},
             options.time_weight * dt * nu,
             held);
  unconverged_solves += !system.solve(force, change, options.solver).converged;
  for (std::size_t i = 0; i < points.n_own; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      if (!(held[i] >> d & 1))
        predicted[i][d] = velocity[i][d] + change[i][d] + dt * balanced[i][d];
}

template <int dim>
bool
Fluid<dim>::is_held(const std::size_t row, const unsigned int d) const
{
  bool held = isolated[row] || is_structure(row);
  for (unsigned int face = 0; face < 2 * dim; ++face)
    if (walls[row] >> face & 1)
      held |= options.walls[face] == Wall::stick || face / 2 == d;
  return held;
}

template <int dim>
void
Fluid<dim>::solve_pressure(const double dt, const unsigned int iteration, TimingTable &timed)
{
  const double theta = options.time_weight, factor = options.density / (theta * dt);
  for (std::size_t i = 0; i < points.size(); ++i)
    scratch[i] = factor * (theta * predicted[i] + (1 - theta) * velocity[i]);
  FluidOperators<dim>(mesh, moved_rules, halo).divergence(scratch, right_side);
  // The rate at which volume is to change [1/s], little in a step; regions take no part.
  if (options.regions.empty())
    swelling_volume = moved_volume;
  else
    FluidOperators<dim>(mesh, moved_rules, halo).lumped_volume(swelling_volume, outside_regions);
  double swelling =
    options.volume_relaxation > 0
      ? std::clamp(dt / options.volume_relaxation * (initial_volume / current_volume - 1.),
                   -1e-3,
                   1e-3) /
          dt
      : 0.;
  if (dim == 3)
    swelling -= mpi::sum(fitting_flow, comm) / current_volume;
  std::vector<double> surface(points.n_own);
  for (std::size_t i = 0; i < points.n_own; ++i)
    if (!no_pressure[i])
      {
        right_side[i] += factor * swelling * swelling_volume[i] - surface_area[i] * scratch[i];
        surface[i] = (1 + surface_share) * surface_area[i].norm_square() / moved_mass[i];
      }
  for (const auto &point : carried)
    if (const std::size_t i = point.row; !no_pressure[i])
      {
        right_side[i] -= factor * (wall_area[i] * structures.velocity_of(point));
        surface[i] +=
          options.density * push_time / (theta * dt) * structures.softness(point, wall_area[i]);
      }
  timed("matrix", [&] {
    pressure_system.assemble(mesh, moved_rules, surface, 1., no_pressure, relative_lightness);
  });
  // In space flat elements change so much between iterations that the old one does not fit.
  if (iteration == 0 || dim == 3)
    timed("multigrid", [&] { pressure_system.prepare(options.solver); });
  surface_pressure.resize(points.size());
  pushed.resize(points.size());
  last_pressure_solve = timed("solve", [&] {
    return pressure_system.solve(right_side,
                                 pressure,
                                 options.solver,
                                 [this](double *result, const double *p) {
                                   add_surface_terms(result, p);
                                   add_structures(result, p);
                                 });
  });
  ++pressure_solves;
  pressure_iterations += last_pressure_solve.iterations;
  unconverged_solves += !last_pressure_solve.converged;
  halo.update(pressure);
}

// Drops may leave all faces, points of the free surface those that gravity pulls them from.
template <int dim>
unsigned int
Fluid<dim>::held_walls(const std::size_t row) const
{
  if (isolated[row])
    return 0;
  unsigned int held = walls[row];
  if (free_surface[row])
    for (unsigned int face = 0; face < 2 * dim; ++face)
      if ((face % 2 == 0 ? 1. : -1.) * options.gravity[face / 2] > 0)
        held &= ~(1u << face);
  return held;
}

template <int dim>
void
Fluid<dim>::set_wall_velocity(const std::size_t row, Vector &v) const
{
  const unsigned int held = held_walls(row);
  for (unsigned int face = 0; face < 2 * dim; ++face)
    if (held >> face & 1)
      {
        if (options.walls[face] == Wall::stick)
          v = 0;
        else
          v[face / 2] = 0;
      }
}

template <int dim>
void
Fluid<dim>::correct(const double dt)
{
  FluidOperators<dim>(mesh, moved_rules, halo).gradient(pressure, gradient);
  corrected = predicted;
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (!isolated[i])
      {
        gradient[i] -= pressure[i] * surface_area[i];
        corrected[i] -= dt / (options.density * moved_mass[i]) * gradient[i];
      }
  if (!options.regions.empty())
    stiffen(dt);
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      if (!isolated[i])
        set_wall_velocity(i, corrected[i]);
      moving[i] = options.time_weight * corrected[i] + (1 - options.time_weight) * velocity[i];
    }
  move_structures();
  halo.update(moving);
  halo.update(corrected);
}

// A point that reaches a face of the box is on it from now on; a drop may leave again.
template <int dim>
void
Fluid<dim>::move(const double dt)
{
  book_step(dt);
  const auto corners = options.box.get_boundary_points();
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      dealii::Point<dim> x      = points.position[i] + dt * moving[i];
      unsigned int       on     = held_walls(i);
      const double       before = corrected[i].norm_square();
      for (unsigned int face = 0; face < 2 * dim; ++face)
        {
          const unsigned int d      = face / 2;
          const double       place  = face % 2 == 0 ? corners.first[d] : corners.second[d];
          const bool         beyond = face % 2 == 0 ? x[d] <= place : x[d] >= place;
          if (options.walls[face] == Wall::open || !(beyond || (on >> face & 1)))
            continue;
          x[d] = place;
          on |= 1u << face;
          if (options.walls[face] == Wall::stick)
            corrected[i] = 0;
          else
            corrected[i][d] = 0;
        }
      const double stopped =
        0.5 * options.density * moved_mass[i] * (before - corrected[i].norm_square());
      energy.boundary += stopped;
      energy.kinetic -= stopped;
      for (unsigned int d = 0; d < dim; ++d)
        {
          columns[Layout::position + d][i] = x[d];
          columns[Layout::velocity + d][i] = corrected[i][d];
        }
      columns[Layout::pressure][i] = pressure[i];
      columns[Layout::walls][i]    = on;
      columns[Layout::sliding][i]  = 0;
    }
  for (std::size_t k = 0; k < carried.size(); ++k)
    if (const std::size_t i = carried[k].row;
        i < n_cloud && stays_on_structure(i, carried_normal[k]))
      columns[Layout::sliding][i] = 1;
}

template <int dim>
void
Fluid<dim>::find_moved_boundary()
{
  PointCloud<dim> moved = points;
  new_positions(moved.position);
  moved_boundary = boundary_of(moved, mesh);
}

// With the masses of the halfway elements. What walls take is what they change of the corrected
// velocity; viscosity's share is measured before the other forces come.
template <int dim>
void
Fluid<dim>::book_step(const double dt)
{
  double kinetic = 0;
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      const double mass  = options.density * moved_mass[i];
      const Vector mean  = 0.5 * (velocity[i] + corrected[i]);
      Vector       force = options.gravity;
      if (body_force)
        for (unsigned int d = 0; d < dim; ++d)
          force[d] += body_force->value(points.position[i] + 0.5 * dt * moving[i], d);
      const Vector push  = -(isolated[i] ? 0. : dt) * gradient[i];
      const Vector stiff = stiffened.empty() ? Vector() : stiffened[i];
      const Vector pressed =
        isolated[i] ? predicted[i] : predicted[i] - dt / mass * gradient[i] + stiff;
      const double work = dt * mass * (force * moving[i]);
      energy.external_work += work;
      energy.internal -= push * mean;
      energy.boundary += mass * (pressed - corrected[i]) * mean;
      energy.damping -= mass * (predicted[i] - velocity[i] - dt * force + stiff) * mean;
      energy.transfer += work - dt * mass * (force * mean);
      kinetic += 0.5 * mass * (corrected[i].norm_square() - velocity[i].norm_square());
    }
  energy.kinetic += kinetic;
}

template <int dim>
void
Fluid<dim>::check_numbers()
{
  if (failure)
    return;
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (!std::isfinite(corrected[i].norm_square()) || !std::isfinite(pressure[i]))
      {
        std::ostringstream details;
        details << "point " << points.id[i] << " of '" << body_name << "' at ("
                << points.position[i] << ") m: velocity (" << corrected[i] << ") m/s, pressure "
                << pressure[i] << " Pa";
        failure.emplace("the motion of the meshless fluid is not a number",
                        details.str(),
                        "lower Largest move of the body, and look at what happens there before");
        return;
      }
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
