// SPDX-License-Identifier: GPL-3.0-or-later
// Each rank makes its own particles, and together they are the same, with the same ids, on any
// number of ranks; volumes add up to the shape's. (The same output on 1, 2 and 3 ranks.)
#include <coracle/particles/generate.h>
#include <coracle/particles/shape_ball.h>
#include <coracle/particles/shape_box.h>
#include <coracle/particles/shape_polygon.h>

#include <map>

#include "../tests.h"

using namespace coracle;
using dealii::Point;
namespace Mpi = dealii::Utilities::MPI;

/// The domain [0,4)^dim cut at x = 3, so that with three ranks one has little and one, or more,
/// nothing.
template <int dim>
dealii::BoundingBox<dim>
region_of(const unsigned int rank, const unsigned int n_ranks)
{
  Point<dim> lower, upper;
  for (int d = 0; d < dim; ++d)
    upper[d] = 4;
  if (n_ranks > 1)
    {
      lower[0] = rank == 0 ? 0 : 3;
      upper[0] = rank == 0 ? 3 : 4;
    }
  // Nobody's land.
  if (rank > 1)
    lower[0] = upper[0] = 4;
  return {{lower, upper}};
}

template <int dim>
void
test(const std::string &title, const Shape<dim> &shape, const double spacing)
{
  const unsigned int rank    = Mpi::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = Mpi::n_mpi_processes(MPI_COMM_WORLD);
  const auto region          = region_of<dim>(rank, n_ranks);
  const auto is_mine         = [&](const Point<dim> &p) {
    return p[0] >= region.lower_bound(0) && p[0] < region.upper_bound(0);
  };
  const auto particles = generate_particles<dim>(
    shape, GenerationSettings(spacing, true), is_mine, region, MPI_COMM_WORLD);

  // Sums that change if a particle is missing, twice there, or has another id or place.
  std::map<std::uint64_t, Point<dim>> by_id;
  double                              mixed = 0;
  for (std::size_t i = 0; i < particles.ids.size(); ++i)
    {
      by_id[particles.ids[i]] = particles.positions[i];
      mixed += particles.positions[i].norm() * (particles.ids[i] % 1009);
    }
  // ids of other ranks must not be among mine.
  std::vector<std::uint64_t>            mine(particles.ids);
  const auto                            all = Mpi::all_gather(MPI_COMM_WORLD, mine);
  std::map<std::uint64_t, unsigned int> uses;
  for (const auto &ids : all)
    for (const auto id : ids)
      ++uses[id];
  const double sum = Mpi::sum(mixed, MPI_COMM_WORLD);
  deallog << title << ": particles " << particles.n_total << ", ids different "
          << (uses.size() == particles.n_total && by_id.size() == particles.ids.size())
          << ", spacing " << particles.spacing << ", volume "
          << particles.n_total * particles.volume << " of " << *shape.volume()
          << ", lattice off by " << filter_out_small_numbers(particles.volume_error)
          << ", checksum " << sum / particles.n_total << std::endl;
}

/// Balls in shells: the outermost particles are half a spacing under the surface, all keep their
/// distance, and the centre of mass is the centre.
template <int dim>
void
test_shells()
{
  const auto particles = generate_particles<dim>(
    BallShape<dim>(Point<dim>(), 1, true),
    GenerationSettings(0.1, true),
    [](const Point<dim> &) { return true; },
    dealii::BoundingBox<dim>({-Point<dim>::unit_vector(0), Point<dim>()}),
    MPI_COMM_SELF);
  double                 outermost = 0, nearest = 1;
  dealii::Tensor<1, dim> centre;
  for (const auto &x : particles.positions)
    {
      outermost = std::max(outermost, x.norm());
      centre += (1. / particles.n_total) * x;
      for (const auto &y : particles.positions)
        if (&x != &y)
          nearest = std::min(nearest, x.distance(y));
    }
  deallog << "shells: outermost at " << outermost << ", centre off less than 1e-3 "
          << (centre.norm() < 1e-3) << ", nearest ones more than half a spacing apart "
          << (nearest > 0.05) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();

  // No lattice point lies on a boundary to round-off.
  // 400 x 200 in a box of 2 m x 1 m, although 0.005 has no exact double.
  test<2>("box", BoxShape<2>({{Point<2>(1.5, 0), Point<2>(3.5, 1)}}), 0.005);
  test<2>("box, spacing adjusted", BoxShape<2>({{Point<2>(2.5, 0.1), Point<2>(3.53, 1)}}), 0.02);
  test<3>("box", BoxShape<3>({{Point<3>(2.7, 0, 1), Point<3>(3.2, 0.3, 1.2)}}), 0.01);
  // A lattice misses a disc of 40 particles across by 0.6 %, a ball of 20 across by 0.8 %.
  test<2>("disc", BallShape<2>(Point<2>(3, 2), 0.2), 0.01);
  test<3>("ball", BallShape<3>(Point<3>(3, 2, 2), 0.2), 0.02);
  test<2>("disc in shells", BallShape<2>(Point<2>(3, 2), 0.2, true), 0.01);
  test<3>("ball in shells", BallShape<3>(Point<3>(3, 2, 2), 0.2, true), 0.02);
  test_shells<2>();
  test_shells<3>();
  test<2>("triangle",
          PolygonShape<2>({Point<2>(2, 0), Point<2>(3.5, 0), Point<2>(3.5, 1.4)}),
          0.05);
  test<3>("prism",
          PolygonShape<3>({Point<2>(2, 0), Point<2>(3.5, 0), Point<2>(3.1, 1.4)}, {1, 1.5}),
          0.05);
}
