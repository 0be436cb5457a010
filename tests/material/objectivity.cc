// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid rotation, in one step by a large angle, turns the stress of every solid and fluid and adds
// nothing.
#include "../tests.h"
#include "models.h"

using namespace coracle;

/// Rotation about an axis by an angle; in 2-D about z.
template <int dim>
Matrix<dim, double>
rotation(const double angle, const std::array<double, 3> &axis)
{
  const double        c = std::cos(angle), s = std::sin(angle);
  Matrix<dim, double> r;
  if constexpr (dim == 2)
    r = {{{{c, -s}}, {{s, c}}}};
  else
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        {
          const int k = 3 - i - j;
          r[i][j] =
            (1 - c) * axis[i] * axis[j] + (i == j ? c : ((j - i + 3) % 3 == 1 ? -s : s) * axis[k]);
        }
  return r;
}

template <int dim>
double
difference(const Symmetric<dim, double> &a, const Symmetric<dim, double> &b)
{
  double result = 0;
  for (int i = 0; i < a.size; ++i)
    result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  const Matrix<dim, double> r = rotation<dim>(2.5, {{2. / 7, -3. / 7, 6. / 7}});
  Matrix<dim, double>       l = r;
  for (int i = 0; i < dim; ++i)
    l[i][i] -= 1;
  const double dt = 0.25;
  for (auto &row : l)
    for (double &entry : row)
      entry /= dt;

  // The step as a gradient at its start, brought to the middle, has no symmetric part and gives R
  // back.
  const auto mid    = mid_step_gradient<dim, double>(l, dt);
  const auto strain = symmetric_part<dim, double>(mid);
  const auto found  = incremental_rotation<dim, double>(mid, dt);
  double     error  = difference<dim>(strain, {});
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      error = std::max(error, std::abs(found[i][j] - r[i][j]));
  deallog << "rotation by 2.5 in one step found, without strain: " << (error < 1e-13) << std::endl;

  for (const auto &variant : all_models())
    std::visit(
      [&](const auto &model) {
        using Model           = std::decay_t<decltype(model)>;
        Matrix<dim, double> f = random_matrix<dim>(0.2);
        for (int i = 0; i < dim; ++i)
          f[i][i] += 0.9;
        Symmetric<dim, double> stress;
        auto                   motion = motion_at<dim>(f, model.reference_density());
        motion.velocity_gradient      = f;
        motion.dt                     = 0.1;
        model.template update<dim, double>(motion, stress, nullptr);
        if (!std::is_same_v<Model, LinearElastic>)
          {
            // A fluid forgets the stress that it had: compare with that of the turned velocity
            // gradient.
            motion.velocity_gradient = {};
            model.template update<dim, double>(motion, stress, nullptr);
          }
        const auto expected = rotated<dim, double>(stress, r);
        const auto energy   = model.template energy_density<dim, double>(motion, stress);

        motion = motion_at<dim>(product<dim, double>(r, f), model.reference_density());
        motion.velocity_gradient = mid;
        motion.dt                = dt;
        auto turned              = stress;
        model.template update<dim, double>(motion, turned, nullptr);
        const double scale = std::max({std::abs(stress[0]), std::abs(stress[3]), 1.});
        deallog << Model::name << (Model::isotropic_stress ? "" : ", full stress")
                << ": stress turned, energy kept "
                << (difference<dim>(turned, expected) < 1e-12 * scale) << ' '
                << (std::abs(model.template energy_density<dim, double>(motion, turned) - energy) <=
                    1e-12 * std::abs(energy))
                << std::endl;
      },
      variant);

  // A thousand small steps turn the stress of the hypoelastic solid by what they add up to.
  const LinearElastic    solid(ElasticConstants(1100, 1e6, 0.4));
  Symmetric<dim, double> stress;
  for (int i = 0; i < stress.size; ++i)
    stress[i] = 1e4 * (i + 1);
  Symmetric<dim, double> expected = rotated<dim, double>(stress, rotation<dim>(5., {{0, 0, 1}}));
  Motion<dim, double>    motion{};
  motion.dt                      = 1e-3;
  motion.velocity_gradient       = {};
  motion.velocity_gradient[0][1] = -2. / motion.dt * std::tan(5. / 1000 / 2);
  motion.velocity_gradient[1][0] = -motion.velocity_gradient[0][1];
  for (int step = 0; step < 1000; ++step)
    solid.update<dim, double>(motion, stress, nullptr);
  deallog << "rotation by 5 in 1000 steps: " << (difference<dim>(stress, expected) < 1e-6)
          << std::endl;
  deallog.pop();
}

int
main()
{
  initlog();
  test<2>();
  test<3>();
}
