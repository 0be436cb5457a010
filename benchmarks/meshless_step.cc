// SPDX-License-Identifier: GPL-3.0-or-later
// What the meshless fluid's tessellation and shape functions cost a point, as points grow. Rows of
// points that have moved by a fifth of their distance, as in a flow; --rows takes them where they
// were, the most degenerate case. Processor time:  meshless_step [--rows] [--dim 2|3] [points ...]
#include <deal.II/base/mpi.h>

#include <coracle/meshless/cells.h>
#include <coracle/meshless/laplace.h>
#include <coracle/meshless/merging.h>

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
} // namespace coracle::meshless

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  double                                   moved = 0.2;
  int                                      dim   = 0;
  std::vector<double>                      sizes;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--rows") == 0)
      moved = 0.;
    else if (std::strcmp(argv[i], "--dim") == 0 && i + 1 < argc)
      dim = std::stoi(argv[++i]);
    else
      sizes.push_back(std::stod(argv[i]));
  if (sizes.empty())
    sizes = {1e4, 1e5, 1e6};
  std::cout
    << "microseconds a point\ndim  points  tessellate  Delaunay  spheres   merging   elements"
       "  shapes | elements a point, merged\n";
  for (const double n : sizes)
    if (dim != 3)
      coracle::meshless::measure<2>(n, moved);
  for (const double n : sizes)
    if (dim != 2)
      coracle::meshless::measure<3>(n, moved);
}
