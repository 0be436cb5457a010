// SPDX-License-Identifier: GPL-3.0-or-later
// The viscous system gives back the velocity from which its right side was made, on any number of
// ranks, one without points among them: components that are held stay zero, a fluid as thin as
// water needs a few iterations, honey more, and what does not converge says so.
#include <coracle/meshless/diffusion_system.h>

#include "clouds.h"

using namespace clouds;
using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

/// This rank's part; the last of several ranks has nothing.
template <int dim>
PointCloud<dim>
part(const PointCloud<dim> &whole)
{
  const unsigned int n_with = std::max(1u, mpi::n_ranks(comm) - 1);
  PointCloud<dim>    result;
  for (unsigned int i = 0; i < whole.size(); ++i)
    if (i % n_with == mpi::rank(comm))
      {
        add(result, whole.position[i], whole.spacing[i]);
        result.id.back() = whole.id[i];
      }
  return result;
}

template <int dim>
void
test()
{
  using Vector                    = dealii::Tensor<1, dim>;
  const auto                whole = random<dim>(dim == 2 ? 400 : 600, 7);
  auto                      cloud = part(whole);
  const double              h     = whole.spacing[0];
  const TessellationOptions options{1.8, 1e-6};
  Halo                      halo(comm);
  halo.rebuild(cloud, options.halo_width(h));
  const auto        mesh = tessellate(cloud, options, comm);
  ElementRules<dim> rules;
  rules.reinit(cloud, mesh);
  const FluidOperators<dim> operators(mesh, rules, halo);
  std::vector<double>       mass;
  operators.lumped_volume(mass);
  mass.resize(cloud.n_own);

  std::vector<unsigned char> held(cloud.n_own);
  std::vector<Vector>        exact(cloud.n_own), flux;
  for (unsigned int i = 0; i < cloud.n_own; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      if (!(mass[i] > 0) || cloud.id[i] % (5 + d) == 0)
        held[i] |= 1 << d;
      else
        exact[i][d] = std::sin(double(cloud.id[i]) + 2. * d);
  auto known = exact;
  halo.update(known);
  operators.laplacian(known, flux);
  for (const double thickness : {1e-4, 100.})
    {
      const double        b = thickness * h * h;
      std::vector<Vector> f(cloud.n_own), u(cloud.n_own);
      for (unsigned int i = 0; i < cloud.n_own; ++i)
        f[i] = mass[i] * exact[i] + b * flux[i];
      DiffusionSystem<dim> system(operators, halo, comm);
      system.set(mass, b, held);
      const auto report = system.solve(f, u, {1e-12, 1000, 0});
      double     error = 0, moved = 0;
      for (unsigned int i = 0; i < cloud.n_own; ++i)
        {
          error = std::max(error, (u[i] - exact[i]).norm());
          for (unsigned int d = 0; d < dim; ++d)
            if (held[i] >> d & 1)
              moved = std::max(moved, std::fabs(u[i][d]));
        }
      deallog << dim << "-D, b / h^2 = " << thickness << ": solved "
              << (mpi::max(error, comm) < 1e-8) << ", held " << (mpi::max(moved, comm) == 0)
              << ", few iterations " << (report.iterations < 10) << ", converged "
              << report.converged;
      std::fill(u.begin(), u.end(), Vector());
      deallog << ", in one iteration " << system.solve(f, u, {1e-12, 1, 0}).converged << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
