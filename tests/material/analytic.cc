// SPDX-License-Identifier: GPL-3.0-or-later
// Stresses that are known in closed form: uniaxial strain and simple shear of solids, plane strain,
// viscous flow, artificial viscosity in compression only, the tension limit; and packs equal their
// lanes.
#include "../tests.h"
#include "models.h"

using namespace coracle;

template <int dim, typename Model>
Symmetric<dim, double>
stress_of(const Model &model, const Motion<dim, double> &motion)
{
  Symmetric<dim, double> stress;
  model.template update<dim, double>(motion, stress, nullptr);
  return stress;
}

template <int dim>
void
print(const std::string &title, const Symmetric<dim, double> &s, const double scale)
{
  deallog << title;
  for (const double entry : s.s)
    deallog << ' ' << filter_out_small_numbers(entry / scale, 2e-6);
  deallog << std::endl;
}

// Plane strain: E = 1 MPa, nu = 0.25, so that lambda = mu = 0.4 MPa.
void
solids()
{
  const ElasticConstants constants(1000, 1e6, 0.25);
  Motion<2, double>      motion  = motion_at<2>({{{{1.25, 0.}}, {{0., 1.}}}}, 1000);
  motion.velocity_gradient[0][0] = 2.;
  motion.dt                      = 1e-3;
  print("linear elastic, strain 0.002 along x, [mu eps]: 3 1 1 0:",
        stress_of(LinearElastic(constants), motion),
        0.4e6 * 0.002);
  // (mu (b - 1) + lambda ln J)/J with b = 1.5625, J = 1.25
  print(
    "neo-Hookean, stretch 1.25, minus exact:",
    [&] {
      auto         s    = stress_of(NeoHookean(constants), motion);
      const double lnj  = std::log(1.25);
      const double ex[] = {0.4e6 * (0.5625 + lnj) / 1.25,
                           0.4e6 * lnj / 1.25,
                           0.4e6 * lnj / 1.25,
                           0};
      for (int i = 0; i < 4; ++i)
        s[i] -= ex[i];
      return s;
    }(),
    1e6);

  Motion<3, double> shear = motion_at<3>({{{{1., 0.5, 0.}}, {{0., 1., 0.}}, {{0., 0., 1.}}}}, 1000);
  shear.velocity_gradient[0][1] = 2e-3;
  shear.dt                      = 1e-3;
  print("linear elastic, shear 2e-6, [mu gamma]: 0 0 0 1 0 0:",
        stress_of(LinearElastic(constants), shear),
        0.8);
  print("neo-Hookean, shear 0.5, [mu]: 0.25 0 0 0.5 0 0:",
        stress_of(NeoHookean(constants), shear),
        0.4e6);

  // Jaumann's rate in simple shear without end: sigma_xy = mu sin(gamma), sigma_xx = mu (1 -
  // cos(gamma)).
  const LinearElastic  solid(constants);
  Symmetric<2, double> stress;
  const int            n = 4000;
  shear.dt               = 1.;
  Motion<2, double> sheared{};
  sheared.dt                      = 1.;
  sheared.velocity_gradient[0][1] = 3. / n;
  for (int step = 0; step < n; ++step)
    solid.update<2, double>(sheared, stress, nullptr);
  deallog << "linear elastic sheared to 3, sine and cosine to 1e-6: "
          << (std::abs(stress[3] / 0.4e6 - std::sin(3.)) < 1e-6) << ' '
          << (std::abs(stress[0] / 0.4e6 - 1 + std::cos(3.)) < 1e-6) << std::endl;
}

void
fluids()
{
  const WeaklyCompressible water(1000, 50, 6000);
  Motion<2, double>        motion = motion_at<2>(identity<2, double>(), 1000);
  motion.length                   = 0.1;
  motion.velocity_gradient[0][0]  = 3.;
  motion.velocity_gradient[0][1]  = 2.;
  motion.velocity_gradient[1][0]  = 4.;
  print("viscous flow, mu = 5, expanding at 3 / s: 20 -10 -10 30:",
        stress_of(Fluid<WeaklyCompressible, true>(water, 5., 0.1, 1.5), motion),
        1.);
  motion.velocity_gradient[0][0] = -3.;
  // rho h |d| (b1 c + b2^2 h |d|) = 1000 * 0.3 * (5 + 2.25 * 0.3)
  print("bulk viscosity, closing at 3 / s: -1702.5 three times, 0:",
        stress_of(Fluid<WeaklyCompressible, false>(water, 0, 0.1, 1.5), motion),
        1.);

  const Tait tait(1000, 50, 7, 6000), torn(1000, 50, 7, 0);
  for (const double density : {1010., 1000., 999., 997.6, 990., 500., 1e-3})
    deallog << "density " << density << ": weakly compressible " << water.pressure(density)
            << ", Tait " << tait.pressure(density) << ", without tension " << torn.pressure(density)
            << std::endl;
  // rho0 c0^2/gamma (1.1^7 - 1)
  deallog << "Tait at 10 % compression, relative to 0.9487171 rho0 c0^2/gamma: "
          << tait.pressure(1100.) * 7 / 2.5e6 / 0.9487171 << std::endl;
  // Opening at the limit does the work p_t per volume opened.
  const double opened = water.energy_density(500.) * 2 - water.energy_density(800.) * 1.25;
  deallog << "work of opening from 800 to 500 [6000 (2 - 1.25)]: " << opened / (6000 * 0.75)
          << std::endl;
}

template <int dim>
void
packs()
{
  for (const auto &variant : all_models())
    std::visit(
      [](const auto &model) {
        using Model = std::decay_t<decltype(model)>;
        Motion<dim, Pack8>                            pack{};
        Symmetric<dim, Pack8>                         stress{};
        std::array<Motion<dim, double>, pack_size>    lane{};
        std::array<Symmetric<dim, double>, pack_size> lane_stress{};
        for (int l = 0; l < pack_size; ++l)
          {
            auto f = random_matrix<dim>(0.3);
            for (int i = 0; i < dim; ++i)
              f[i][i] += 1;
            lane[l]                   = motion_at<dim>(f, model.reference_density());
            lane[l].velocity_gradient = random_matrix<dim>(100.);
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j)
                {
                  pack.deformation_gradient[i][j][l] = f[i][j];
                  pack.velocity_gradient[i][j][l]    = lane[l].velocity_gradient[i][j];
                }
            for (int i = 0; i < stress.size; ++i)
              stress[i][l] = lane_stress[l][i] = 1e5 * random_number();
            pack.density[l] = lane[l].density;
            pack.length[l]  = lane[l].length;
            pack.dt         = lane[l].dt;
          }
        model.template update<dim, Pack8>(pack, stress, nullptr);
        const Pack8 energy = model.template energy_density<dim, Pack8>(pack, stress);
        const Pack8 c      = model.sound_speed(pack.density);
        bool        same   = true;
        const auto  close  = [](const double a, const double b, const double scale) {
          return std::abs(a - b) <= 1e-12 * scale;
        };
        for (int l = 0; l < pack_size; ++l)
          {
            model.template update<dim, double>(lane[l], lane_stress[l], nullptr);
            for (int i = 0; i < stress.size; ++i)
              same = same && close(stress[i][l], lane_stress[l][i], 1e6);
            same =
              same && close(energy[l],
                            model.template energy_density<dim, double>(lane[l], lane_stress[l]),
                            1e6);
            same = same && close(c[l], model.sound_speed(lane[l].density), 100);
            if constexpr (Model::isotropic_stress)
              same = same && close(model.pressure(pack)[l], -lane_stress[l][0], 1e6);
          }
        deallog << Model::name << ", " << dim << "d: a pack equals its lanes " << same << std::endl;
      },
      variant);
}

int
main()
{
  initlog();
  solids();
  fluids();
  packs<2>();
  packs<3>();
}
