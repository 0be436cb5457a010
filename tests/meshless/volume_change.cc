// SPDX-License-Identifier: GPL-3.0-or-later
// Two blocks that come so near that the gap between them counts as filled gain the gap's volume, a
// block that is torn loses what its elements had become; both at once are told apart, their
// difference is the change of the whole, on any ranks.
#include <coracle/meshless/halo.h>
#include <coracle/meshless/volume_change.h>

#include "clouds.h"

using namespace clouds;
using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

/// Four blocks in a row, of 3 points each along x and n across. The gaps are wide, small and wide.
template <int dim>
PointCloud<dim>
blocks(const unsigned int n)
{
  PointCloud<dim>    cloud;
  const unsigned int across = dim == 2 ? n : n * n;
  for (const double start : {0., 0.5, 0.8, 1.5})
    for (unsigned int i = 0; i < 3 * across; ++i)
      {
        dealii::Point<dim> p;
        p[0]       = start + i % 3 * 0.1;
        p[1]       = i / 3 % n * 0.1;
        p[dim - 1] = dim == 2 ? p[1] : i / (3 * n) * 0.1;
        add(cloud, p, 0.1);
      }
  return cloud;
}

template <int dim>
void
test()
{
  const unsigned int        n       = 5;
  const auto                whole   = blocks<dim>(n);
  const TessellationOptions options = {1.2, 1e-6};
  const double              section = std::pow(0.4, dim - 1);

  PointCloud<dim>           mine;
  std::vector<unsigned int> owners;
  for (unsigned int i = 0; i < whole.size(); ++i)
    if (i * 5 / whole.size() % mpi::n_ranks(comm) == mpi::rank(comm))
      {
        add(mine, whole.position[i], 0.1);
        mine.id.back() = i;
      }
  Halo halo(comm);
  // Wide enough for points to move.
  halo.rebuild(mine, 4. * options.halo_width(0.1));
  const auto old = tessellate(mine, options, comm);

  // The gap of 0.3 closes to 0.1, that of 0.1 opens to 0.25, the last stays.
  for (unsigned int i = 0; i < mine.size(); ++i)
    if (mine.position[i][0] < 0.35)
      mine.position[i][0] += 0.2;
    else if (mine.position[i][0] > 0.75)
      mine.position[i][0] += 0.15;
  const auto   before     = boundary_of(mine, old);
  const double old_volume = mpi::sum(enclosed(mine, old.boundary_facet), comm);
  halo.rebuild(mine, options.halo_width(0.1));
  const auto   now = tessellate(mine, options, comm);
  const double new_volume =
    mpi::sum(std::accumulate(now.volume.begin(), now.volume.end(), 0.), comm);
  const auto change = volume_change(before, boundary_of(mine, now), comm);
  deallog << dim << "-D: appeared " << change.appeared / section << ", disappeared "
          << change.disappeared / section << ", the difference is that of the whole "
          << (std::abs(new_volume - old_volume - change.appeared + change.disappeared) < 1e-13)
          << std::endl;

  // Nothing changes: nothing is reported.
  const auto none = volume_change(boundary_of(mine, now), boundary_of(mine, now), comm);
  deallog << "at rest " << none.appeared + none.disappeared << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
