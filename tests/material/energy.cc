// SPDX-License-Identifier: GPL-3.0-or-later
// The stress of each model is the derivative of its energy with respect to the deformation, its
// sound speed follows from the stress, and there is no energy at rest.
#include "../tests.h"
#include "models.h"

using namespace coracle;

// Psi(F) = J e is the energy per reference volume; J sigma F^-T is its derivative (first Piola
// stress).
template <int dim, typename Model>
double
stress_error(const Model &model, const double stretch)
{
  Matrix<dim, double> f = random_matrix<dim>(0.1);
  for (int i = 0; i < dim; ++i)
    f[i][i] += stretch;
  const auto energy = [&](const Matrix<dim, double> &g) {
    const auto motion = motion_at<dim>(g, model.reference_density());
    return determinant<dim, double>(g) * model.template energy_density<dim, double>(motion, {});
  };

  Symmetric<dim, double> stress;
  model.template update<dim, double>(motion_at<dim>(f, model.reference_density()), stress, nullptr);
  const auto adj   = adjugate<dim, double>(f);
  double     error = 0, size = 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      {
        double piola = 0;
        for (int k = 0; k < dim; ++k)
          piola += stress(i, k) * adj[j][k];
        auto         plus = f, minus = f;
        const double h = 1e-5;
        plus[i][j] += h;
        minus[i][j] -= h;
        error = std::max(error, std::abs((energy(plus) - energy(minus)) / (2 * h) - piola));
        size  = std::max(size, std::abs(piola));
      }
  return size > 0 ? error / size : error;
}

template <typename EOS>
double
sound_error(const EOS &eos, const double density)
{
  const double h     = 1e-3;
  const double slope = (eos.pressure(density + h) - eos.pressure(density - h)) / (2 * h);
  const double c     = eos.sound_speed(density);
  return std::abs(slope / (c * c) - 1);
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  for (const auto &variant : all_models())
    std::visit(
      [](const auto &model) {
        using Model = std::decay_t<decltype(model)>;
        if constexpr (!std::is_same_v<Model, LinearElastic>)
          {
            bool good = true;
            for (const double stretch : {0.85, 0.95, 1.0, 1.1, 1.3})
              good = good && stress_error<dim>(model, stretch) < 1e-6;
            const auto rest = motion_at<dim>(identity<dim, double>(), model.reference_density());
            deallog << Model::name << ": stress is the energy's derivative " << good
                    << ", energy at rest is zero "
                    << (model.template energy_density<dim, double>(rest, {}) == 0.) << std::endl;
          }
      },
      variant);
  deallog.pop();
}

// Small strain from rest: the work done is the energy stored, by Clapeyron.
template <int dim>
void
linear_elastic_work()
{
  const LinearElastic    solid(ElasticConstants(1100, 1e6, 0.4));
  Symmetric<dim, double> stress;
  Motion<dim, double>    motion{};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      motion.velocity_gradient[i][j] = 0.1 * (i + 1) * (j + 1) - 0.2 * (i == j);
  motion.dt      = 1e-3;
  motion.density = 1100;
  solid.update<dim, double>(motion, stress, nullptr);
  const auto strain = symmetric_part<dim, double>(motion.velocity_gradient);
  double     work   = 0;
  for (int i = 0; i < strain.size; ++i)
    work += (i < 3 ? 0.5 : 1.) * stress[i] * strain[i] * motion.dt;
  const double energy = solid.energy_density<dim, double>(motion, stress);
  deallog << "linear elastic, " << dim << "d: energy is the work done "
          << (std::abs(energy / work - 1) < 1e-12) << std::endl;
}

int
main()
{
  initlog();
  test<2>();
  test<3>();
  linear_elastic_work<2>();
  linear_elastic_work<3>();

  deallog << "c^2 = dp/drho, weakly compressible: "
          << (sound_error(WeaklyCompressible(1000, 50, 0), 1020.) < 1e-9) << std::endl;
  deallog << "c^2 = dp/drho, Tait: " << (sound_error(Tait(1000, 50, 7, 0), 1020.) < 1e-7) << ' '
          << (sound_error(Tait(1000, 50, 7.15, 0), 1100.) < 1e-7) << std::endl;

  // Neo-Hookean solid under uniaxial strain: the first Piola stress is the Cauchy stress, so that
  // waves run with rho_0 C^2 = d sigma/d stretch in the material and with c = stretch C in space.
  const NeoHookean rubber(ElasticConstants(1100, 1e6, 0.4));
  const auto       axial = [&](const double stretch) {
    auto f  = identity<3, double>();
    f[0][0] = stretch;
    Symmetric<3, double> stress;
    rubber.update<3, double>(motion_at<3>(f, 1100), stress, nullptr);
    return stress[0];
  };
  for (const double stretch : {0.7, 0.9, 1.})
    {
      const double h     = 1e-6;
      const double slope = stretch * (axial(stretch + h) - axial(stretch - h)) / (2 * h);
      const double c     = rubber.sound_speed(1100 / stretch);
      deallog << "neo-Hookean wave speed: "
              << (std::abs(slope / (c * c * 1100 / stretch) - 1) < 1e-7) << std::endl;
    }
}
