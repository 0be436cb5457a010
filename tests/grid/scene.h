// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/mpi.h>
#include <coracle/grid/locate.h>
#include <coracle/grid/nodal_field.h>
#include <coracle/grid/transfer.h>

#include <random>

#include "tests.h"

/**
 * What the tests of the grid share: boxes of cells with a refined corner, and particles at random
 * places that are the same on any number of ranks.
 */
namespace coracle
{
/// In [0, 1), the same sequence on every machine and rank.
class Random
{
public:
  double operator()() { return generator() / 4294967296.; }

  template <int dim>
  dealii::Point<dim> in(const dealii::BoundingBox<dim> &box)
  {
    dealii::Point<dim> x;
    for (int d = 0; d < dim; ++d)
      x[d] = box.lower_bound(d) + (*this)() * box.side_length(d);
    return x;
  }

private:
  std::mt19937 generator{4711};
};

/// n[d] cells of a size from an origin; two levels finer in a part of the box that touches no face
/// of it.
template <int dim>
OctreeDescription<dim>
refined_box(const std::array<unsigned int, dim> &n, const double cell_size, const double origin)
{
  dealii::Point<dim> lower, upper, refined_lower, refined_upper;
  for (int d = 0; d < dim; ++d)
    {
      lower[d]         = origin;
      upper[d]         = origin + n[d] * cell_size;
      refined_lower[d] = origin + 0.4 * n[d] * cell_size;
      refined_upper[d] = origin + 0.6 * n[d] * cell_size;
    }
  return {{{lower, upper}},
          cell_size,
          {{dealii::BoundingBox<dim>({refined_lower, refined_upper}), 2}}};
}

/// 3 x 2 (x 2) coarse cells of side 4 (2-D) or 2 (3-D) cells; all coordinates are dyadic.
template <int dim>
OctreeDescription<dim>
dyadic_box()
{
  std::array<unsigned int, dim> n;
  n.fill(dim == 2 ? 8 : 4);
  n[0] = dim == 2 ? 12 : 6;
  return refined_box<dim>(n, 0.125, 0.);
}

template <int dim>
std::array<FaceCondition, 2 * dim>
all_faces(const FaceCondition condition)
{
  std::array<FaceCondition, 2 * dim> result;
  result.fill(condition);
  return result;
}

/// Grid, field and the boundary between them.
template <int dim>
struct Scene
{
  explicit Scene(const OctreeDescription<dim> &description,
                 const FaceCondition           faces = FaceCondition::open)
    : octree(description, {}, MPI_COMM_WORLD)
    , boundary(all_faces<dim>(faces), octree)
    , field(octree, boundary)
  {}

  bool is_mine(const dealii::Point<dim> &x) const
  {
    const int leaf = octree.find(x);
    return leaf >= 0 && leaf < static_cast<int>(octree.n_owned_leaves());
  }

  Octree<dim>      octree;
  BoxBoundary<dim> boundary;
  NodalField<dim>  field;
};

/// Append one particle if it is this rank's; every column has a value that follows from the id.
template <int dim>
void
add_particle(const Scene<dim>         &scene,
             const dealii::Point<dim> &x,
             const double              id,
             const double              size,
             MaterialPoints<dim>      &points)
{
  if (!scene.is_mine(x))
    return;
  using Layout = ParticleLayout<dim>;
  std::vector<double> row(points.columns.n_columns());
  for (unsigned int c = 0; c < row.size(); ++c)
    row[c] = std::sin(1.3 * id + 0.7 * c);
  for (int d = 0; d < dim; ++d)
    row[Layout::position + d] = row[Layout::next_position + d] = x[d];
  row[Layout::mass]    = 1. + 0.1 * std::cos(id);
  row[Layout::density] = 1000. + std::sin(id);
  row[Layout::size]    = size;
  row[Layout::id]      = id;
  points.append(row.data());
  ++points.ledger.created;
}

/// Random particles, and one exactly on a face, a hanging node (dyadic box) and the box's upper
/// corner.
template <int dim>
void
add_particles(const Scene<dim>    &scene,
              const unsigned int   n,
              const double         size,
              MaterialPoints<dim> &points)
{
  dealii::Point<dim> inner_lower, inner_upper;
  for (int d = 0; d < dim; ++d)
    {
      inner_lower[d] = scene.octree.box().lower_bound(d) + 0.5 * size;
      inner_upper[d] = scene.octree.box().upper_bound(d) - 0.5 * size;
    }
  const dealii::BoundingBox<dim> inner({inner_lower, inner_upper});
  Random                         random;
  for (unsigned int i = 0; i < n; ++i)
    add_particle(scene, random.in(inner), i, size, points);
  dealii::Point<dim> face = inner.center();
  face[0] -= 0.125;
  add_particle(scene, inner.center(), n, size, points);
  add_particle(scene, face, n + 1, size, points);
  add_particle(scene, inner_upper, n + 2, size, points);
  add_particle(scene, inner_lower, n + 3, size, points);
}

/// Sum over ranks of something of each particle.
template <int dim, typename Function>
auto
sum_over_particles(const MaterialPoints<dim> &points, const Function &function)
{
  decltype(function(std::size_t())) result{};
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      result += function(row);
  return mpi::sum(result, MPI_COMM_WORLD);
}
} // namespace coracle
