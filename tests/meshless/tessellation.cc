// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of points give squares and cubes in any order and when moved by round-off; random points
// give the same elements in any order, spheres without points inside, and fill the box; alpha finds
// gap, surface and lone point.
#include "clouds.h"

using namespace clouds;

template <int dim>
void
rows(const std::string     &name,
     const PointCloud<dim> &cloud,
     const unsigned int     n,
     const double           moved)
{
  const auto         t       = tessellate(cloud, {1.3, 1e-6}, MPI_COMM_SELF);
  const unsigned int n_cells = std::lround(std::pow(n - 1, dim));
  bool               boxes   = t.n_elements() == n_cells;
  double             worst   = 0.;
  for (unsigned int e = 0; e < t.n_elements(); ++e)
    {
      boxes = boxes && t.n_nodes(e) == (1u << dim);
      worst = std::max(worst, std::abs(t.volume[e] * std::pow(10., dim) - 1.));
    }
  unsigned int n_surface = 0;
  for (const auto flag : t.on_free_surface)
    n_surface += flag;
  deallog << name << " " << dim << "-D: all boxes " << boxes << ", volumes "
          << (worst < 1e-12 + 100. * moved) << ", surface points "
          << (n_surface == std::lround(std::pow(n, dim) - std::pow(n - 2, dim))) << ", facets "
          << (t.boundary_facet.size() == (dim == 2 ? 4 * (n - 1) : 12 * (n - 1) * (n - 1)))
          << ", enclosed "
          << (std::abs(enclosed(cloud, t.boundary_facet) - std::pow(0.1 * (n - 1), dim)) <
              1e-12 + 10. * moved)
          << std::endl;
}

/// No point inside the sphere of an element that is a simplex: its nodes are found in no other way.
template <int dim>
bool
spheres_are_empty(const PointCloud<dim> &cloud, const Tessellation<dim> &t)
{
  for (unsigned int e = 0; e < t.n_elements(); ++e)
    {
      // Circumcentre by solving for equal distances.
      dealii::Tensor<2, dim> matrix;
      dealii::Tensor<1, dim> rhs;
      const unsigned int    *node = &t.node[t.first_node[e]];
      for (unsigned int i = 0; i < dim; ++i)
        {
          const auto edge = cloud.position[node[i + 1]] - cloud.position[node[0]];
          rhs[i]          = edge.norm_square() / 2.;
          for (unsigned int d = 0; d < dim; ++d)
            matrix[i][d] = edge[d];
        }
      const dealii::Tensor<1, dim> c = invert(matrix) * rhs;
      for (const auto &p : cloud.position)
        if ((p - cloud.position[node[0]] - c).norm() < c.norm() * (1. - 1e-8))
          return false;
    }
  return true;
}

template <int dim>
void
at_random(const unsigned int n)
{
  const PointCloud<dim>     cloud = random<dim>(n, 7);
  const TessellationOptions all{1e6, 1e-9};
  const auto                t = tessellate(cloud, all, MPI_COMM_SELF);
  deallog << "random " << dim << "-D: fills the box "
          << (std::abs(std::accumulate(t.volume.begin(), t.volume.end(), -1.)) < 1e-12)
          << ", spheres are empty " << spheres_are_empty(cloud, t);
  bool same = true;
  for (unsigned int seed = 0; seed < 3; ++seed)
    for (const TessellationOptions &options :
         {all, TessellationOptions{0.9, 1e-9}, TessellationOptions{1.2, 0.05}})
      {
        const auto other = shuffled(cloud, seed);
        same             = same && elements(cloud, tessellate(cloud, options, MPI_COMM_SELF)) ==
                         elements(other, tessellate(other, options, MPI_COMM_SELF));
      }
  deallog << ", any order gives the same " << same;
  // Every facet of an element has exactly one partner, turned the other way, or is on the boundary.
  const auto   coarse = tessellate(cloud, {1.2, 0.05}, MPI_COMM_SELF);
  const double volume = std::accumulate(coarse.volume.begin(), coarse.volume.end(), 0.);
  deallog << ", enclosed by its boundary "
          << (std::abs(enclosed(cloud, coarse.boundary_facet) - volume) < 1e-12) << std::endl;
}

/// Two blocks of water with a gap of three spacings, a floor of walls, and a lone point.
template <int dim>
void
parts()
{
  PointCloud<dim> cloud = grid<dim>(9, 0.1), kept;
  for (unsigned int i = 0; i < cloud.size(); ++i)
    if (cloud.position[i][0] < 0.35 || cloud.position[i][0] > 0.55)
      add(kept,
          cloud.position[i],
          0.1,
          cloud.position[i][dim - 1] < 0.05 ? PointKind::wall : PointKind::fluid);
  add(kept, dealii::Point<dim>() + 2. * dealii::Point<dim>::unit_vector(dim - 1), 0.1);
  const auto   t      = tessellate(kept, {1.3, 1e-6}, MPI_COMM_SELF);
  const double volume = std::accumulate(t.volume.begin(), t.volume.end(), 0.);
  // Blocks are 0.3 and 0.2 wide, 0.8 high and long.
  bool walls_free = false;
  for (unsigned int i = 0; i < kept.size(); ++i)
    walls_free = walls_free || (kept.kind[i] == PointKind::wall && t.on_free_surface[i]);
  deallog << "parts " << dim << "-D: volume "
          << (std::abs(volume - 0.5 * std::pow(0.8, dim - 1)) < 1e-12) << ", walls are no surface "
          << !walls_free << ", lone point " << (t.on_free_surface.back() && !t.has_element.back())
          << std::endl;
}

template <int dim>
void
test(const unsigned int n)
{
  const auto cloud = grid<dim>(n, 0.1);
  rows("rows", cloud, n, 0.);
  for (unsigned int seed = 0; seed < 5; ++seed)
    {
      auto other = shuffled(cloud, seed);
      rows("shuffled", other, n, 0.);
      auto last_digit = other;
      perturb(last_digit, 1e-16, seed);
      rows("moved by their last digit", last_digit, n, 1e-16);
      perturb(other, 1e-13, seed);
      rows("moved by round-off", other, n, 1e-13);
      perturb(other, 1e-10, seed);
      rows("moved by 1e-10", other, n, 1e-10);
    }
  at_random<dim>(dim == 2 ? 400 : 300);
  parts<dim>();
  // Nothing, and what has no simplices.
  deallog << "empty: " << tessellate(PointCloud<dim>(), {}, MPI_COMM_SELF).n_elements();
  PointCloud<dim> line;
  for (unsigned int i = 0; i < 5; ++i)
    add(line, dealii::Point<dim>() + i * dealii::Point<dim>::unit_vector(0), 1.);
  deallog << ", a line: " << tessellate(line, {}, MPI_COMM_SELF).n_elements() << std::endl;
  auto twice = grid<dim>(3, 1.);
  add(twice, twice.position[4], 1.);
  try
    {
      tessellate(twice, {}, MPI_COMM_SELF);
    }
  catch (const coracle::RunFailure &failure)
    {
      deallog << failure.title << ": " << failure.details << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  test<2>(12);
  test<3>(6);
}
