// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/initial_velocity.h>
#include <coracle/coupling/material_point_body.h>
#include <coracle/grid/locate.h>
#include <coracle/particles/generate.h>

#include <sstream>

namespace coracle
{
namespace
{
ParticleNeeds
find_needs(const MaterialVariant &material, const Parameters &body, const MetSurfaces &met)
{
  ParticleNeeds needs;
  std::visit(
    [&needs](const auto &model) {
      using Material             = std::decay_t<decltype(model)>;
      needs.isotropic_stress     = Material::isotropic_stress;
      needs.deformation_gradient = Material::needs_deformation_gradient;
      needs.n_history            = Material::n_history;
    },
    material);
  needs.affine   = body.choice("Velocity transfer") == "apic";
  needs.touches  = met.can_touch;
  needs.n_sheets = met.n_sheets;
  return needs;
}
} // namespace

template <int dim>
void
MaterialPointBody<dim>::declare(Declaration &body)
{
  GenerationSettings::declare(body);
  body.text("Material", "", "Name of one of the sections in Materials.");
  body.text(
    "Velocity field",
    "common",
    "Bodies with the same word here meet without slip and without passing through each "
    "other, as in plain MPM; bodies of different fields do not feel each other on the grid. "
    "Two fluids on the two sides of a wall need different fields.");
  body.list("Initial velocity", "", "m/s", "v_0", "Of all particles; empty is rest.");
  body.function("Initial velocity function",
                "",
                "m/s",
                "One expression for each direction; used instead of the constant if not empty.");
  body.function("Initial pressure",
                "",
                "Pa",
                "Fluids only: density and mass are chosen to give this pressure at the start, for "
                "example 1000*9.81*(1-y) for water at rest under a surface at y = 1 m.");
  body.function("Body force",
                "",
                "m/s^2",
                "Acceleration besides gravity, one expression for each direction.");
  declare_method(body);
}

template <int dim>
void
MaterialPointBody<dim>::declare_method(Declaration &body)
{
  body.choice(
    "Shape functions",
    "linear",
    {"linear", "gimp"},
    "linear: a particle's mass sits at its centre; gimp: it is spread over the particle's "
    "box, which is smoother when particles cross cell faces and costs more.");
  body.choice(
    "Velocity transfer",
    "flip",
    {"flip", "apic"},
    "flip: particles take the change of the grid's velocity; apic: the velocity itself and "
    "its gradient, smoother and more dissipative.");
  body.quantity(
    "PIC fraction",
    "0.1",
    "1",
    "alpha_PIC",
    "flip only: share of the grid's velocity itself in a particle's new velocity, for a "
    "step as long as is stable in the body's cells, and less for shorter steps; damps "
    "what the grid does not see.",
    0.,
    1.);
  body.choice("Stress update",
              "musl",
              {"musl", "usf", "usl"},
              "Which velocities strain the particles: those gathered again from moved particles "
              "(musl), those at the start (usf) or at the end (usl) of the step.");
  body.choice(
    "Volume strain",
    "particle",
    {"particle", "cell mean"},
    "particle: each follows the divergence at its own place; cell mean: all particles of a "
    "cell share the mean, which keeps nearly incompressible flow from locking and forces "
    "from noise, but lets water under standing pressure begin to boil.");
  body.quantity(
    "Volume smoothing",
    "0",
    "1",
    "beta",
    "cell mean only: share of the way that a particle's volume per mass goes to its cell's "
    "mean in a step as long as is stable, and less in shorter ones; keeps the sum of "
    "volumes and takes away differences between particles that no cell feels.",
    0.,
    1.);
  body.flag(
    "Mean pressure in forces",
    false,
    "Internal forces from the mean pressure of a cell's particles instead of each one's own.");
  body.quantity("Contact radius",
                "0.5",
                "1",
                "r/d_p",
                "Radius of a particle for contact, over its size.",
                0.,
                2.);
  body.quantity(
    "Particles across a cell",
    "0",
    "1",
    "",
    "With adaptivity: particles along an edge of a cell, which splitting and merging keep up in "
    "finer and coarser cells; 0: the largest number that the body starts with.",
    0.);
  body.quantity(
    "Damping", "0", "1/s", "c", "Mass-proportional damping: velocities decay as exp(-c t).", 0.);
  body.quantity("Damping until", "1e300", "s", "", "Time at which damping ends.");
}

template <int dim>
MaterialPointBody<dim>::MaterialPointBody(const Parameters      &body,
                                          const MaterialLibrary &materials,
                                          const Octree<dim>     &octree,
                                          const MetSurfaces     &met,
                                          const bool             with_particles)
  : points(body.name(), find_needs(materials.get(body.text("Material"), body), body, met))
  , material(materials.get(body.text("Material"), body))
  , volume_strain(body.choice("Volume strain") == "particle" ? VolumeStrain::particle
                                                             : VolumeStrain::cell_mean)
  , volume_smoothing(body.quantity("Volume smoothing"))
  , field_name(body.text("Velocity field"))
  , radius_factor(body.quantity("Contact radius"))
  , particles_across(body.quantity("Particles across a cell"))
  , damping_rate(body.quantity("Damping"))
  , damping_end(body.quantity("Damping until"))
{
  transfer.shape =
    body.choice("Shape functions") == "gimp" ? ParticleShape::gimp : ParticleShape::linear;
  transfer.velocity =
    body.choice("Velocity transfer") == "apic" ? VelocityTransfer::apic : VelocityTransfer::flip;
  transfer.pic_fraction     = body.quantity("PIC fraction");
  transfer.average_pressure = body.flag("Mean pressure in forces");
  const std::string update  = body.choice("Stress update");
  stress_update             = update == "usf"   ? StressUpdate::usf
                              : update == "usl" ? StressUpdate::usl
                                                : StressUpdate::musl;
  if (body.is_set("Body force"))
    body_force = body.function<dim>("Body force", dim);
  if (with_particles)
    generate(body, octree);
}

template <int dim>
void
MaterialPointBody<dim>::generate(const Parameters &body, const Octree<dim> &octree)
{
  using Layout         = ParticleLayout<dim>;
  const double density = std::visit([](const auto &m) { return m.reference_density(); }, material);
  const auto   is_mine = [&octree](const dealii::Point<dim> &x) {
    const int leaf = octree.find(x);
    return leaf >= 0 && leaf < static_cast<int>(octree.n_owned_leaves());
  };
  check_inside_box(body, octree.box());
  const auto   made = generate_particles<dim>(body,
                                            is_mine,
                                            octree.owned_region(),
                                            octree.triangulation.get_communicator());
  const double size = std::pow(made.volume, 1. / dim);
  // A particle's box reaches into neighbouring cells, which is all that a rank knows besides its
  // own.
  if (transfer.shape == ParticleShape::gimp && size > 2 * octree.smallest_cell_size())
    throw body.error("Particle spacing",
                     "particles are larger than two cells",
                     "boxes of " + std::to_string(size) + " m, smallest cells of " +
                       std::to_string(octree.smallest_cell_size()) + " m",
                     "choose a smaller spacing, Shape functions = linear, or larger cells");

  const InitialVelocity<dim> velocity(body);

  points.columns.resize(made.positions.size());
  for (std::size_t row = 0; row < made.positions.size(); ++row)
    {
      const dealii::Tensor<1, dim> v = velocity(made.positions[row]);
      for (int d = 0; d < dim; ++d)
        {
          points.column(Layout::position + d)[row]      = made.positions[row][d];
          points.column(Layout::next_position + d)[row] = made.positions[row][d];
          points.column(Layout::velocity + d)[row]      = v[d];
        }
      points.column(Layout::mass)[row]    = density * made.volume;
      points.column(Layout::density)[row] = density;
      points.column(Layout::size)[row]    = size;
      points.column(Layout::id)[row]      = made.ids[row];
    }
  points.ledger.created = made.positions.size();
  set_initial_pressure(body);
  initialise_particle_stress<dim>(material, points);
  sort_by_leaf(octree, margin_of_shape(), points);
  find_rates(octree);
  if (particles_across == 0)
    {
      double largest = 0;
      for (const unsigned int leaf : points.occupied_cells())
        largest = std::max(largest, octree.size(leaf));
      particles_across = mpi::max(largest, octree.triangulation.get_communicator()) / size;
    }
}

template <int dim>
void
MaterialPointBody<dim>::find_rates(const Octree<dim> &octree)
{
  using Layout         = ParticleLayout<dim>;
  double largest_rate  = 0;
  sweep.diffusion_rate = 0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      if (points.is_hole(row))
        continue;
      double square = 0;
      for (int d = 0; d < dim; ++d)
        square += std::pow(points.column(Layout::velocity + d)[row], 2);
      const double c =
        std::visit([&](
                     const auto &m) { return m.sound_speed(points.column(Layout::density)[row]); },
                   material);
      const double h = octree.size(octree.find(points.position(row)));
      largest_rate   = std::max(largest_rate, (c + std::sqrt(square)) / h);
      sweep.diffusion_rate =
        std::max(sweep.diffusion_rate,
                 std::visit([](const auto &m) { return m.diffusivity(); }, material) / (h * h));
    }
  sweep.rate = largest_rate;
}

template <int dim>
void
MaterialPointBody<dim>::set_initial_pressure(const Parameters &body)
{
  using Layout = ParticleLayout<dim>;
  if (!body.is_set("Initial pressure"))
    return;
  if (points.layout().n_stress != 1 &&
      !std::holds_alternative<Fluid<WeaklyCompressible, true>>(material) &&
      !std::holds_alternative<Fluid<Tait, true>>(material))
    throw body.error("Initial pressure",
                     "an initial pressure needs a fluid",
                     "the material of '" + name() + "' is not a fluid",
                     "remove the entry or choose a fluid");
  const auto pressure = body.function<dim>("Initial pressure", 1);
  std::visit(
    [&](const auto &model) {
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        {
          // Newton on p(rho) = p0; dp/drho = c^2.
          const double        wanted = pressure->value(points.position(row));
          Motion<dim, double> motion{};
          motion.density = model.reference_density();
          for (unsigned int i = 0; i < 20; ++i)
            {
              Symmetric<dim, double> stress;
              double                 history[8] = {};
              model.template update<dim>(motion, stress, history);
              const double c = model.sound_speed(motion.density);
              motion.density += (wanted + stress.trace() / 3.) / (c * c);
            }
          points.column(Layout::mass)[row] *= motion.density / points.column(Layout::density)[row];
          points.column(Layout::density)[row] = motion.density;
        }
    },
    material);
}

template <int dim>
double
MaterialPointBody<dim>::damp(const double time, const double dt, MPI_Comm comm)
{
  if (damping_rate == 0 || time >= damping_end)
    return 0;
  const double factor = std::exp(-damping_rate * dt);
  RankSums     kinetic(1, points.reproducible);
  if (points.reproducible)
    kinetic.add(0, points.exact_kinetic_energy());
  else
    kinetic.add(0, points.kinetic_energy());
  const double before = kinetic.share(comm)[0];
  for (int d = 0; d < dim; ++d)
    {
      double *const v = points.column(ParticleLayout<dim>::velocity + d);
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        v[row] *= factor;
    }
  return before * (1. - factor * factor);
}

template <int dim>
void
MaterialPointBody<dim>::serialize(Archive &archive)
{
  const Archive::Section section(archive, "body " + name());
  points.serialize(archive);
  archive.largest("rate", sweep.rate);
  archive.largest("diffusion_rate", sweep.diffusion_rate);
  archive.share("internal_energy", internal_energy);
  archive.same("particles_across", particles_across);
}

template class MaterialPointBody<2>;
template class MaterialPointBody<3>;
} // namespace coracle
