// SPDX-License-Identifier: GPL-3.0-or-later
// An octree that is refined and coarsened at random keeps 2:1 balance and the regions of its
// description, is the same on any number of ranks, knows the owner of every place, and its
// particles, those on faces too, end up on the rank and in the leaf that they are in.
#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

// A number that depends on the place only.
template <int dim>
double
hash(const dealii::Point<dim> &x, const unsigned int round)
{
  double sum = 17.3 * round;
  for (int d = 0; d < dim; ++d)
    sum += (d + 1.7) * 91.7 * x[d];
  return std::sin(sum);
}

template <int dim>
dealii::Point<dim>
centre(const Octree<dim> &octree, const unsigned int leaf)
{
  dealii::Point<dim> x = octree.lower(leaf);
  for (int d = 0; d < dim; ++d)
    x[d] += 0.5 * octree.size(leaf);
  return x;
}

// Sizes of the leaves around all corners of all leaves, a little off them.
template <int dim>
bool
is_balanced(const Octree<dim> &octree)
{
  bool good = true;
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    for (int direction = 0; direction < (dim == 2 ? 9 : 27); ++direction)
      {
        dealii::Point<dim> x = centre(octree, leaf);
        for (int d = 0, rest = direction; d < dim; ++d, rest /= 3)
          x[d] += 0.501 * (rest % 3 - 1) * octree.size(leaf);
        const int other = octree.find(x);
        if (other >= 0)
          good = good && octree.size(leaf) < 2.001 * octree.size(other) &&
                 octree.size(other) < 2.001 * octree.size(leaf);
        else
          good = good && !octree.box().point_inside(x);
      }
  return !mpi::any(!good, comm);
}

template <int dim>
bool
owners_are_known(const Octree<dim> &octree)
{
  bool       good = true;
  Random     random;
  const auto is_right = [&](const dealii::Point<dim> &x) {
    const int leaf = octree.find(x), owner = octree.owner_of(x);
    if (leaf >= 0)
      good = good && octree.owner(leaf) == owner;
    good =
      good && (owner == int(mpi::rank(comm))) == (leaf >= 0 && leaf < int(octree.n_owned_leaves()));
  };
  for (unsigned int i = 0; i < 300; ++i)
    is_right(random.in(octree.box()));
  for (unsigned int leaf = 0; leaf < octree.n_leaves(); ++leaf)
    {
      is_right(octree.lower(leaf));
      is_right(centre(octree, leaf));
    }
  dealii::Point<dim> outside = octree.box().get_boundary_points().second;
  is_right(outside);
  outside[0] += 1e-6;
  return !mpi::any(!good || octree.owner_of(outside) != -1, comm);
}

template <int dim>
bool
particles_are_home(const Octree<dim> &octree, const MaterialPoints<dim> &points)
{
  bool good = points.cell_begin().back() == points.n_rows();
  for (const unsigned int leaf : points.occupied_cells())
    for (unsigned int row = points.cell_begin()[leaf]; row < points.cell_begin()[leaf + 1]; ++row)
      good = good && octree.find(points.position(row)) == int(leaf);
  return !mpi::any(!good, comm);
}

template <int dim>
void
test(const OctreeDescription<dim> &description, const int finest)
{
  Scene<dim>          scene(description);
  auto               &octree = scene.octree;
  MaterialPoints<dim> points("stuff", [] {
    ParticleNeeds needs;
    needs.isotropic_stress = true;
    return needs;
  }());
  add_particles(scene, 400, 0.01, points);
  redistribute(octree, 0., points);
  const auto sum_of = [&](const int column) {
    return sum_over_particles(points, [&](const std::size_t row) {
      return points.column(column)[row] * std::cos(points.id(row));
    });
  };
  const double n_particles = mpi::sum<double>(points.n_particles(), comm),
               before      = sum_of(ParticleLayout<dim>::velocity);

  bool balanced = true, least = true, known = true, home = true, whole = true, even = true;
  for (unsigned int round = 0; round < 6; ++round)
    {
      std::vector<int> wanted;
      for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
        {
          // First finer here and there, then coarser by whole patches of cells.
          dealii::Point<dim> place = centre(octree, leaf);
          if (round >= 3)
            for (int d = 0; d < dim; ++d)
              place[d] = std::floor(place[d] / 0.25);
          const double h      = hash(place, round);
          const int    change = round < 3 ? (h > 0.6) - (h < -0.8) : (h > 0.9) - (h < 0.5);
          wanted.push_back(std::min(octree.level(leaf) + change, finest));
        }
      std::vector<double> work(octree.n_owned_leaves());
      for (const unsigned int leaf : points.occupied_cells())
        work[leaf] = points.cell_begin()[leaf + 1] - points.cell_begin()[leaf];
      octree.adapt(wanted, work);
      scene.boundary.reinit(octree);
      scene.field.reinit();
      redistribute(octree, 0., points);
      balanced = is_balanced(octree) && balanced;
      known    = owners_are_known(octree) && known;
      home     = particles_are_home(octree, points) && home;
      for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
        least = least && octree.level(leaf) >= octree.least_level(leaf);
      whole = whole && mpi::sum<double>(points.n_particles(), comm) == n_particles &&
              std::fabs(sum_of(ParticleLayout<dim>::velocity) - before) < 1e-12 * n_particles;
      double volume = 0, places = 0;
      for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
        {
          volume += std::pow(octree.size(leaf), dim);
          places += hash(centre(octree, leaf), 0);
        }
      volume = mpi::sum(volume, comm);
      for (int d = 0; d < dim; ++d)
        volume /= octree.box().side_length(d);
      deallog << "round " << round << ": leaves " << mpi::sum(octree.n_owned_leaves(), comm)
              << ", nodes " << octree.dof_handler.n_dofs() << ", volume " << volume
              << ", where they are " << mpi::sum(places, comm) << std::endl;
    }
  // By what is there now.
  std::vector<double> work(octree.n_owned_leaves());
  for (const unsigned int leaf : points.occupied_cells())
    work[leaf] = points.cell_begin()[leaf + 1] - points.cell_begin()[leaf];
  octree.repartition(work);
  redistribute(octree, 0., points);
  home = particles_are_home(octree, points) && owners_are_known(octree) && home;

  // A value that follows from the place comes to ghosts as it is.
  std::vector<double> values(octree.n_leaves(), -5);
  for (unsigned int leaf = 0; leaf < octree.n_owned_leaves(); ++leaf)
    values[leaf] = hash(centre(octree, leaf), 1);
  octree.update_ghost_leaves(values);
  for (unsigned int leaf = 0; leaf < octree.n_leaves(); ++leaf)
    even = even && values[leaf] == hash(centre(octree, leaf), 1);
  deallog << "2:1 balance " << balanced << ", regions stay fine " << !mpi::any(!least, comm)
          << ", owners known " << known << std::endl;
  deallog << "particles are all there " << whole << " and at home " << home
          << ", ghosts have their values " << !mpi::any(!even, comm) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test<2>(dyadic_box<2>(), 3);
  // Two cells: with more ranks some have nothing at the start.
  auto two = refined_box<2>({2, 1}, 0.7, 0.1);
  two.refinements.clear();
  test<2>(two, 3);
  deallog.pop();
  deallog.push("3d");
  test<3>(dyadic_box<3>(), 2);
  deallog.pop();
}
