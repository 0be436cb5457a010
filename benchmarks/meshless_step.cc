// SPDX-License-Identifier: GPL-3.0-or-later
// What the meshless fluid costs a point, as points grow. Processor time:
//   meshless_step [--rows] [--dim 2|3] [points ...]   tessellation and shape functions: rows of
//     points moved by a fifth of their distance, as in a flow; --rows takes them where they were,
//     the most degenerate case
//   meshless_step --step [--dim 2|3] [points ...]     the whole step of water that sloshes in a box
#include <deal.II/base/mpi.h>

#include <coracle/meshless/cells.h>
#include <coracle/meshless/fluid.h>
#include <coracle/meshless/laplace.h>
#include <coracle/meshless/merging.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <random>

namespace coracle::meshless
{
double
now()
{
  return double(std::clock()) / CLOCKS_PER_SEC;
}

/// About n points of a box, ids along its rows.
template <int dim>
PointCloud<dim>
cloud_of(const double n, const double moved)
{
  const unsigned int side = std::lround(std::pow(n, 1. / dim));
  PointCloud<dim>    cloud;
  cloud.n_own = std::lround(std::pow(side, dim));
  std::mt19937_64                  engine(1);
  std::uniform_real_distribution<> shift(-moved, moved);
  for (std::size_t i = 0; i < cloud.n_own; ++i)
    {
      dealii::Point<dim> p;
      std::size_t        rest = i;
      for (unsigned int d = 0; d < dim; ++d, rest /= side)
        p[d] = (rest % side + shift(engine)) / side;
      cloud.position.push_back(p);
    }
  cloud.spacing.assign(cloud.n_own, 1. / side);
  cloud.kind.assign(cloud.n_own, PointKind::fluid);
  for (std::size_t i = 0; i < cloud.n_own; ++i)
    cloud.id.push_back(i);
  return cloud;
}

template <int dim>
void
measure(const double n, const double moved)
{
  const PointCloud<dim>     cloud = cloud_of<dim>(n, moved);
  const TessellationOptions options;
  // Small clouds several times, so that the clock sees them.
  const unsigned int    repetitions = std::max(1., 1e5 / n);
  std::array<double, 5> time{};
  Tessellation<dim>     tessellation;
  double                check = 0.;
  for (unsigned int r = 0; r < repetitions; ++r)
    {
      double     start = now();
      const auto lap   = [&](const unsigned int i) {
        const double end = now();
        time[i] += end - start;
        start = end;
      };
      auto delaunay_cells = delaunay(cloud.position);
      lap(0);
      const auto cells = arrange(std::move(delaunay_cells), cloud, options);
      lap(1);
      const auto element = merge_cells(cells, cloud, options, options.alpha * cloud.spacing[0]);
      lap(2);
      tessellation = tessellate(cloud, options, MPI_COMM_SELF);
      lap(3);
      LaplaceShape<dim> shape;
      for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
        {
          shape.reinit(cloud, tessellation, e);
          check += shape.weight(0) * shape.value(0, 0);
        }
      lap(4);
    }
  unsigned int merged = 0;
  for (unsigned int e = 0; e < tessellation.n_elements(); ++e)
    merged += !tessellation.is_simplex(e);
  std::cout << dim << "  " << std::setw(8) << cloud.size() << std::fixed << std::setprecision(2);
  const double points = double(repetitions) * cloud.size() * 1e-6;
  for (const double t :
       {time[3], time[0], time[1], time[2], time[3] - time[0] - time[1] - time[2], time[4]})
    std::cout << std::setw(10) << t / points;
  std::cout << std::setw(10) << tessellation.n_elements() / double(cloud.size()) << std::setw(10)
            << merged / double(tessellation.n_elements()) << (check > 0. ? "" : " ?") << std::endl;
}
/// Water in a box of unit width, as high as wide, its inner points moved at random.
template <int dim>
std::unique_ptr<Fluid<dim>>
water(const double n)
{
  const PointCloud<dim> cloud = cloud_of<dim>(n, 0.);
  const double          h     = cloud.spacing[0];
  FluidOptions<dim>     options;
  options.spacing             = h;
  options.gravity[dim - 1]    = -10;
  options.time_weight         = 0.5;
  options.solver.tolerance    = 1e-9;
  options.solver.direct_up_to = 0;
  options.tessellation.alpha  = dim == 2 ? 1.3 : 1.5;
  options.surface_alpha       = dim == 2 ? 0.85 : 1.05;
  options.refill.longest_edge = dim == 2 ? 1.7 : 1.8;
  dealii::Point<dim> upper;
  for (unsigned int d = 0; d < dim; ++d)
    upper[d] = d == dim - 1 ? 1.5 : 1. - h;
  options.box           = dealii::BoundingBox<dim>({dealii::Point<dim>(), upper});
  auto            fluid = std::make_unique<Fluid<dim>>("water", options, MPI_COMM_SELF);
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<> shift(-0.2 * h, 0.2 * h);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    {
      dealii::Point<dim> x      = cloud.position[i];
      bool               inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside &= x[d] > 0.5 * h && x[d] < 1 - 1.5 * h;
      for (unsigned int d = 0; inside && d < dim; ++d)
        x[d] += shift(engine);
      dealii::Tensor<1, dim> v;
      v[0]       = -0.1 * std::sin(M_PI * x[0]) * std::exp(M_PI * (x[dim - 1] - 1));
      v[dim - 1] = 0.1 * std::cos(M_PI * x[0]) * std::exp(M_PI * (x[dim - 1] - 1));
      fluid->add_point(x, v, i);
    }
  fluid->remesh();
  return fluid;
}

/// Parts are shares of the clock on the wall, of the processor's time of the whole.
template <int dim>
void
measure_step(const double n)
{
  const auto         fluid   = water<dim>(n);
  const unsigned int n_steps = std::clamp<double>(2e5 / n, 2, 10);
  const double       dt      = 0.2 * fluid->options.spacing;
  unsigned int       first   = 0;
  TimingTable        before, timed;
  double             start = 0, time = 0;
  std::uint64_t      iterations = 0;
  for (unsigned int step = 0; step <= n_steps; ++step)
    {
      // The first solution starts from nothing, and its squares are cut up by the second step.
      TimingTable &table = step == 0 ? before : timed;
      if (step == 1)
        {
          first      = fluid->pressure_iterations;
          start      = now();
          iterations = fluid->pressure_iterations;
        }
      table("step", [&] {
        fluid->advance(time, dt, table);
        table("refill", [&] { fluid->refill(); });
        table("tessellation", [&] { fluid->remesh(); });
      });
      time += dt;
    }
  const double cost  = (now() - start) / n_steps / fluid->n_fluid() * 1e6;
  const auto   share = [&](const std::string &path) {
    return timed.seconds("step/" + path) / timed.seconds("step");
  };
  const double matrix   = share("elements/pattern") + share("pressure/matrix"),
               elements = share("elements") - share("elements/pattern"),
               amg = share("pressure/multigrid"), solve = share("pressure/solve"),
               move = share("move") + share("correction") + share("predictor") + share("refill");
  std::cout << dim << "  " << std::setw(8) << fluid->n_fluid() << std::fixed << std::setprecision(2)
            << std::setw(10) << cost;
  for (const double part : {share("tessellation"), elements, matrix, amg, solve, move})
    std::cout << std::setw(10) << part * cost << " (" << std::setw(2) << std::lround(100 * part)
              << " %)";
  std::cout << std::setw(10) << first / 2. << std::setw(10)
            << double(fluid->pressure_iterations - iterations) / (2 * n_steps)
            << (fluid->unconverged_solves > 0 ? " unconverged" : "") << std::endl;
}
} // namespace coracle::meshless

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  double                                   moved = 0.2;
  int                                      dim   = 0;
  bool                                     step  = false;
  std::vector<double>                      sizes;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--rows") == 0)
      moved = 0.;
    else if (std::strcmp(argv[i], "--step") == 0)
      step = true;
    else if (std::strcmp(argv[i], "--dim") == 0 && i + 1 < argc)
      dim = std::stoi(argv[++i]);
    else
      sizes.push_back(std::stod(argv[i]));
  if (sizes.empty())
    sizes = {1e4, 1e5, 1e6};
  if (step)
    std::cout
      << "microseconds a point and step (share)\ndim  points  step  tessellation  elements  "
         "matrix  multigrid  solve  move | iterations of a solution, first step, then\n";
  else
    std::cout
      << "microseconds a point\ndim  points  tessellate  Delaunay  spheres   merging   elements"
         "  shapes | elements a point, merged\n";
  for (const double n : sizes)
    if (dim != 3)
      step ? coracle::meshless::measure_step<2>(n) : coracle::meshless::measure<2>(n, moved);
  for (const double n : sizes)
    if (dim != 2)
      step ? coracle::meshless::measure_step<3>(n) : coracle::meshless::measure<3>(n, moved);
}
