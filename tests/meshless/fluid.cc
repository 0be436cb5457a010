// SPDX-License-Identifier: GPL-3.0-or-later
// Between points at random places, water at rest has its hydrostatic pressure to round-off; linear
// fields have their exact gradient, divergence (between simplices) and no Laplacian; sloshing water
// keeps its volume; a drop that is thrown keeps momentum and volume and falls as a stone does; a
// block of squares or cubes falls as a whole, without pressure.
#include <coracle/base/mpi.h>

#include "tank.h"

using namespace tank;

template <int dim>
void
hydrostatic()
{
  const unsigned int n = dim == 2 ? 20 : 8;
  Fluid<dim>         fluid("water", box<dim>(n), comm);
  fill<dim>(
    fluid, corner<dim>(0, 0), corner<dim>(1, 0.75), intervals<dim>(n, 3 * n / 4), 0.2, rest<dim>);
  advance(fluid, 3, 0.01);
  double worst = 0, fastest = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      const double exact = 1e4 * (0.75 - fluid.points.position[i][dim - 1]);
      worst              = std::max(worst, std::fabs(fluid.pressure[i] - exact) / 7500);
      fastest            = std::max(fastest, fluid.velocity[i].norm());
    }
  deallog << "pressure of water at rest to 1e-9: " << (mpi::max(worst, comm) < 1e-9) << std::endl;
  deallog << "it stays at rest to 1e-9 m/s: " << (mpi::max(fastest, comm) < 1e-9) << std::endl;
}

template <int dim>
void
linear_fields()
{
  const unsigned int n = dim == 2 ? 12 : 6;
  Fluid<dim>         fluid("water", box<dim>(n), comm);
  fill<dim>(fluid, corner<dim>(0, 0), corner<dim>(1, 1), intervals<dim>(n, n), 0.2, rest<dim>);
  ElementRules<dim> rules;
  rules.reinit(fluid.points, fluid.mesh);
  const FluidOperators<dim> apply(fluid.mesh, rules, fluid.halo);
  dealii::Tensor<1, dim>    slope;
  dealii::Tensor<2, dim>    rate;
  for (unsigned int i = 0; i < dim; ++i)
    {
      slope[i] = 1 + i;
      for (unsigned int j = 0; j < dim; ++j)
        rate[i][j] = 1 + i + 3 * j;
    }
  std::vector<double>                 p, flow;
  std::vector<dealii::Tensor<1, dim>> u, gradient, laplacian;
  for (const auto &x : fluid.points.position)
    {
      p.push_back(slope * x);
      u.push_back(rate * x);
    }
  apply.gradient(p, gradient);
  apply.divergence(u, flow);
  apply.laplacian(u, laplacian);
  // The quadrature of polyhedra is of second order only.
  std::vector<double> in_polyhedron(fluid.points.size());
  for (unsigned int e = 0; e < fluid.mesh.n_elements(); ++e)
    if (!fluid.mesh.is_simplex(e))
      for (unsigned int k = fluid.mesh.first_node[e]; k < fluid.mesh.first_node[e + 1]; ++k)
        in_polyhedron[fluid.mesh.node[k]] += 1;
  fluid.halo.sum_to_owners(in_polyhedron);
  double worst = 0, worst_flow = 0, worst_laplacian = 0, worst_polyhedron = 0;
  for (std::size_t i = 0; i < fluid.points.n_own; ++i)
    {
      const double m = fluid.volume[i];
      worst          = std::max(worst, (gradient[i] / m - slope).norm());
      if (fluid.walls[i] == 0)
        {
          double &worst_here = in_polyhedron[i] > 0 ? worst_polyhedron : worst_flow;
          worst_here         = std::max(worst_here, std::fabs(flow[i] / m + trace(rate)));
          worst_laplacian    = std::max(worst_laplacian, laplacian[i].norm() / m);
        }
    }
  deallog << "gradient: " << (mpi::max(worst, comm) < 1e-11)
          << ", divergence: " << (mpi::max(worst_flow, comm) < 1e-11)
          << ", at polyhedra to 3 %: " << (mpi::max(worst_polyhedron, comm) < 0.03 * trace(rate))
          << ", Laplacian: " << (mpi::max(worst_laplacian, comm) < 1e-9) << std::endl;
}

template <int dim>
void
sloshing()
{
  const unsigned int n       = dim == 2 ? 16 : 6;
  auto               options = box<dim>(n);
  options.time_weight        = 0.5;
  options.refill.enabled     = false;
  Fluid<dim> fluid("water", options, comm);
  fill<dim>(fluid,
            corner<dim>(0, 0),
            corner<dim>(1, 0.5),
            intervals<dim>(n, n / 2),
            0.1,
            [](const dealii::Point<dim> &x) {
              const double           k = dealii::numbers::PI;
              dealii::Tensor<1, dim> v;
              v[0]       = -0.2 * std::sin(k * x[0]) * std::cosh(k * x[dim - 1]) / std::sinh(k / 2);
              v[dim - 1] = 0.2 * std::cos(k * x[0]) * std::sinh(k * x[dim - 1]) / std::sinh(k / 2);
              return v;
            });
  const auto energy = [&] {
    const auto &e = fluid.books();
    return mpi::sum(e.kinetic + e.internal + e.damping + e.transfer + e.boundary - e.external_work,
                    comm);
  };
  const double initial = energy();
  advance(fluid, 40, 0.005);
  const double drift = fluid.summary().volume / fluid.initial_volume - 1 -
                       (fluid.volume_appeared - fluid.volume_disappeared) / fluid.initial_volume;
  deallog << "water moves: " << (mpi::max(fluid.books().kinetic, comm) > 1e-3 * initial)
          << ", keeps its volume: " << (std::fabs(drift) < (dim == 2 ? 1e-7 : 1e-5))
          << ", energy is booked: " << (std::fabs(energy() / initial - 1) < 1e-9) << std::endl;
}

template <int dim>
void
drop()
{
  const unsigned int n       = dim == 2 ? 16 : 8;
  auto               options = box<dim>(n);
  options.time_weight        = 0.5;
  Fluid<dim> fluid("water", options, comm);
  const auto spin = [](const dealii::Point<dim> &x) {
    dealii::Tensor<1, dim> v;
    v[0]       = 0.3 - 2 * (x[dim - 1] - 0.5);
    v[dim - 1] = 2 * (x[0] - 0.5);
    return v;
  };
  fill<dim>(fluid,
            corner<dim>(0.25, 0.25),
            corner<dim>(0.75, 0.75),
            intervals<dim>(n / 2, n / 2),
            0.1,
            spin);
  const auto start = fluid.summary();
  advance(fluid, 10, 0.005);
  const auto             end    = fluid.summary();
  dealii::Tensor<1, dim> gained = end.velocity - start.velocity;
  gained[dim - 1] += 10 * 0.05;
  // What new elements make of momentum and outline is small, and measured.
  const double change = (fluid.volume_appeared - fluid.volume_disappeared) / start.volume;
  deallog << "a drop keeps its momentum: " << (gained.norm() < (dim == 2 ? 1e-4 : 1e-2))
          << ", its volume: " << (std::fabs(end.volume / start.volume - 1 - change) < 1e-4)
          << std::endl;
}

template <int dim>
void
block()
{
  const unsigned int n = dim == 2 ? 16 : 8;
  Fluid<dim>         fluid("water", box<dim>(n), comm);
  const auto         thrown = [](const dealii::Point<dim> &) {
    dealii::Tensor<1, dim> v;
    v[0] = 0.3;
    return v;
  };
  fill<dim>(fluid,
            corner<dim>(0.25, 0.25),
            corner<dim>(0.75, 0.75),
            intervals<dim>(n / 2, n / 2),
            0.,
            thrown);
  advance(fluid, 10, 0.005);
  dealii::Tensor<1, dim> exact;
  exact[0]       = 0.3;
  exact[dim - 1] = -10 * 0.05;
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < fluid.n_fluid(); ++i)
    {
      worst   = std::max(worst, (fluid.velocity[i] - exact).norm());
      largest = std::max(largest, std::fabs(fluid.pressure[i]));
    }
  deallog << "a block falls as a whole to 1e-9 m/s: " << (mpi::max(worst, comm) < 1e-9)
          << ", without pressure to 1e-6 Pa: " << (mpi::max(largest, comm) < 1e-6) << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  hydrostatic<dim>();
  linear_fields<dim>();
  sloshing<dim>();
  drop<dim>();
  block<dim>();
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
