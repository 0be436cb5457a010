// SPDX-License-Identifier: GPL-3.0-or-later
// Particles in a linear velocity field: exact densities, no stress from rigid rotation, work equal
// to stored energy, cell means equal to the particles' own divergence.
#include <coracle/coupling/particle_stress.h>

#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
ParticleNeeds
needs_of(const MaterialVariant &material)
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
  return needs;
}

// Particles at random places, in cells of two sizes, some of them strays.
template <int dim>
std::unique_ptr<MaterialPoints<dim>>
make_points(const Scene<dim> &scene, const MaterialVariant &material, const ParticleShape shape)
{
  using Layout = ParticleLayout<dim>;
  auto points  = std::make_unique<MaterialPoints<dim>>("body", needs_of<dim>(material));
  add_particles(scene, 200, shape == ParticleShape::gimp ? 0.02 : 0., *points);
  const double density = std::visit([](const auto &m) { return m.reference_density(); }, material);
  for (std::size_t row = 0; row < points->n_rows(); ++row)
    {
      for (unsigned int c = Layout::stress; c < points->columns.n_columns(); ++c)
        points->column(c)[row] = 0;
      points->column(Layout::density)[row] = density;
    }
  initialise_particle_stress<dim>(material, *points);
  sort_by_leaf(scene.octree, shape == ParticleShape::gimp ? 0.5 : 0., *points);
  // Every fifth particle is listed under a cell that it is not in.
  if (shape == ParticleShape::linear)
    {
      std::vector<int> cell(points->n_rows());
      for (std::size_t row = 0; row < points->n_rows(); ++row)
        cell[row] = points->id(row) % 5 == 0 ? 0 : scene.octree.find(points->position(row));
      points->sort(scene.octree.n_owned_leaves(), cell);
      for (const unsigned int leaf : points->occupied_cells())
        for (unsigned int row = points->cell_begin()[leaf]; row < points->cell_begin()[leaf + 1];
             ++row)
          {
            const auto x      = points->position(row);
            bool       inside = true;
            for (int d = 0; d < dim; ++d)
              inside = inside && x[d] >= scene.octree.lower(leaf)[d] &&
                       x[d] < scene.octree.lower(leaf)[d] + scene.octree.size(leaf);
            if (!inside)
              points->strays.push_back({row, scene.octree.find(x)});
          }
    }
  return points;
}

// Nodal velocities v = L x.
template <int dim>
NodeRecords
linear_velocity(const Octree<dim> &octree, const dealii::Tensor<2, dim> &l)
{
  NodeRecords records(octree.n_nodes());
  for (unsigned int node = 0; node < octree.n_nodes(); ++node)
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        records[node][1 + d] += l[d][e] * octree.position(node)[e];
  return records;
}

template <int dim>
double
largest_stress(const MaterialPoints<dim> &points)
{
  double result = 0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    for (int k = 0; k < points.layout().n_stress; ++k)
      result = std::max(result, std::fabs(points.column(ParticleLayout<dim>::stress + k)[row]));
  return result;
}

template <int dim>
void
test_expansion(const MaterialVariant &material,
               const ParticleShape    shape,
               const VolumeStrain     volume)
{
  using Layout = ParticleLayout<dim>;
  Scene<dim>             scene(dyadic_box<dim>());
  const auto             points = make_points(scene, material, shape);
  dealii::Tensor<2, dim> l;
  for (int d = 0; d < dim; ++d)
    l[d][d] = 1. + d;
  const double divergence = trace(l), dt = 1e-3, density = points->column(Layout::density)[0];
  double       work = 0, volumes = 0;
  StressSweep  sweep;
  const int    n = 20;
  for (int i = 0; i < n; ++i)
    {
      sweep = update_particle_stress<dim>(scene.octree,
                                          linear_velocity(scene.octree, l),
                                          1,
                                          material,
                                          {shape, volume, 0.3, dt},
                                          *points);
      work += sweep.work;
    }
  const double expected = density / std::pow(1 + dt * divergence, n);
  bool         same = true, one_stress = true;
  for (std::size_t row = 0; row < points->n_rows(); ++row)
    {
      same = same && std::fabs(points->column(Layout::density)[row] / expected - 1) < 1e-13;
      for (int k = 0; k < points->layout().n_stress; ++k)
        one_stress = one_stress && std::fabs(points->column(Layout::stress + k)[row] -
                                             points->column(Layout::stress + k)[0]) <
                                     1e-10 * largest_stress(*points);
      volumes += points->column(Layout::mass)[row] / density;
    }
  // Work per reference volume against the energy that the final state holds.
  std::visit(
    [&](const auto &model) {
      Motion<dim, double> motion{};
      for (int d = 0; d < dim; ++d)
        motion.deformation_gradient[d][d] = std::pow(1 + dt * l[d][d], n);
      motion.density = expected;
      Symmetric<dim, double> stress{};
      for (int k = 0; k < points->layout().n_stress && points->layout().n_stress > 1; ++k)
        stress[k] = points->column(Layout::stress + k)[0];
      const double energy = model.energy_density(motion, stress) * density / expected;
      deallog << "expansion: density " << same << ", one stress " << one_stress
              << ", work is stored " << (std::fabs(work / (energy * volumes) - 1) < 0.08)
              << ", strays " << !points->strays.empty() << std::endl;
      double kinetic = points->kinetic_energy(), smallest = 1e300, fastest = 0;
      for (std::size_t row = 0; row < points->n_rows(); ++row)
        {
          double square = 0;
          for (int d = 0; d < dim; ++d)
            square += std::pow(points->column(Layout::velocity + d)[row], 2);
          const double h = scene.octree.size(scene.octree.find(points->position(row)));
          fastest        = std::max(fastest, (model.sound_speed(expected) + std::sqrt(square)) / h);
          smallest       = std::min(smallest, h);
        }
      deallog << "rate and kinetic energy: " << (std::fabs(sweep.rate / fastest - 1) < 1e-10) << ' '
              << (std::fabs(sweep.kinetic / kinetic - 1) < 1e-12) << std::endl;
    },
    material);
}

template <int dim>
void
test_rotation(const MaterialVariant &material, const ParticleShape shape)
{
  // Step by step a rotation about z: in each, particles go from x to R x.
  Scene<dim>             scene(dyadic_box<dim>());
  const auto             points = make_points(scene, material, shape);
  const double           dt = 1e-3, angle = 0.05;
  dealii::Tensor<2, dim> l;
  l[0][0] = l[1][1] = (std::cos(angle) - 1) / dt;
  l[1][0]           = std::sin(angle) / dt;
  l[0][1]           = -l[1][0];
  for (unsigned int i = 0; i < 40; ++i)
    update_particle_stress<dim>(scene.octree,
                                linear_velocity(scene.octree, l),
                                1,
                                material,
                                {shape, VolumeStrain::particle, 0, dt},
                                *points);
  deallog << "rotation by 2 rad gives no stress: " << (largest_stress(*points) < 1e-8 * 1e6)
          << std::endl;
}

template <int dim>
void
test_bad_row()
{
  const MaterialVariant material =
    Fluid<WeaklyCompressible, false>(WeaklyCompressible(1000, 50, 0), 0, 0, 0);
  Scene<dim>             scene(dyadic_box<dim>());
  auto                   points = make_points(scene, material, ParticleShape::linear);
  dealii::Tensor<2, dim> l;
  l[0][0]            = -1;
  const auto records = linear_velocity(scene.octree, l);
  const auto sweep   = [&](const double dt) {
    return update_particle_stress<dim>(scene.octree,
                                       records,
                                       1,
                                       material,
                                       {ParticleShape::linear, VolumeStrain::particle, 0, dt},
                                       *points);
  };
  deallog << "sound state: " << sweep(0.5).bad_row << std::endl;
  points->column(ParticleLayout<dim>::velocity)[17] = std::nan("");
  deallog << "a velocity is no number: " << sweep(1e-3).bad_row << std::endl;
  points->column(ParticleLayout<dim>::velocity)[17] = 0;
  points->remove(17);
  points->column(ParticleLayout<dim>::density)[17] = std::nan("");
  deallog << "a hole does not count: " << sweep(1e-3).bad_row << std::endl;
  // Asked to lose more than its volume, a fluid stays sound; a solid is named.
  deallog << "fluid squeezed beyond nothing: " << sweep(2.).bad_row << std::endl;
  const MaterialVariant rubber        = NeoHookean(ElasticConstants(1100, 1e6, 0.4));
  const auto            rubber_points = make_points(scene, rubber, ParticleShape::linear);
  const auto            turned =
    update_particle_stress<dim>(scene.octree,
                                records,
                                1,
                                rubber,
                                {ParticleShape::linear, VolumeStrain::particle, 0, 2.},
                                *rubber_points);
  deallog << "solid turned inside out: " << (turned.bad_row >= 0) << std::endl;
}

template <int dim>
void
test()
{
  const ElasticConstants                                     rubber(1100, 1e6, 0.4);
  const std::vector<std::pair<std::string, MaterialVariant>> materials = {
    {"fluid", Fluid<WeaklyCompressible, false>(WeaklyCompressible(1000, 50, 1e9), 0, 0, 0)},
    {"elastic", LinearElastic(rubber)},
    {"neo-Hookean", NeoHookean(rubber)}};
  for (const auto &[name, material] : materials)
    for (const auto shape : {ParticleShape::linear, ParticleShape::gimp})
      {
        deallog.push(std::to_string(dim) + "d " + name +
                     (shape == ParticleShape::gimp ? " gimp" : " linear"));
        for (const auto volume : {VolumeStrain::particle, VolumeStrain::cell_mean})
          test_expansion<dim>(material, shape, volume);
        if (name != "fluid")
          test_rotation<dim>(material, shape);
        deallog.pop();
      }
  test_bad_row<dim>();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
