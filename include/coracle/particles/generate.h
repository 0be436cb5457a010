// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace coracle
{
/**
 * Points on a regular lattice, half a spacing off the lower corner of a box.
 * The spacing of each direction is the nearest to the one asked for that divides
 * the box evenly, so that a box that is filled has its exact volume.
 */
template <int dim>
class Lattice
{
public:
  Lattice(const dealii::BoundingBox<dim> &box, const double spacing);

  using Index = std::array<std::uint64_t, dim>;

  dealii::Point<dim> point(const Index &index) const;
  /// Number of a point, x fastest: the same whoever asks.
  std::uint64_t id(const Index &index) const;
  /// The first point in direction d at or beyond a coordinate; n[d] if there is none.
  std::uint64_t first_from(const int d, const double coordinate) const;
  double        cell_volume() const;

  dealii::Point<dim>     lower;
  dealii::Tensor<1, dim> spacing;
  Index                  n;
};

struct GenerationSettings
{
  /// The entries `Shape` ... and `Particle spacing`, `Exact volume` of a body.
  static void declare(Declaration &body);
  explicit GenerationSettings(const Parameters &body);
  GenerationSettings(const double spacing, const bool exact_volume);

  /// Distance asked for between particles [m].
  double spacing;
  /// Scale the particles' volumes to the shape's, where it is known.
  bool exact_volume;
};

/// The particles of one rank.
template <int dim>
struct GeneratedParticles
{
  std::vector<dealii::Point<dim>> positions;
  /// Below 2^53; different on all ranks together, and the same on any number of ranks.
  std::vector<std::uint64_t> ids;
  /// Of each particle [m^dim].
  double volume = 0;
  /// Distance between particles as it came out [m].
  dealii::Tensor<1, dim> spacing;
  /// On all ranks.
  std::uint64_t n_total = 0;
  /// (volume of lattice cells - volume of the shape) / volume of the shape, before any scaling; 0
  /// if unknown.
  double volume_error = 0;
};

/**
 * Particles at the lattice points inside a shape, each rank its own. A particle
 * stands for a whole lattice cell even where the shape's boundary cuts it, so
 * that a curved shape's volume is met on average only; `exact_volume` puts that
 * right for the sum. Shapes that bring places of their own (balls in shells) are
 * not filled from the lattice and have their exact volume.
 *
 * Collective; nothing but the number of particles is exchanged.
 *
 * @param is_mine   is a point (of my_region) on this rank? True on exactly one
 *                  rank for points of the domain, on none for others, which
 *                  then get no particle.
 * @param my_region box around all points of this rank; the rest of the lattice is not visited
 */
template <int dim>
GeneratedParticles<dim>
generate_particles(const Shape<dim>                                      &shape,
                   const GenerationSettings                              &settings,
                   const std::function<bool(const dealii::Point<dim> &)> &is_mine,
                   const dealii::BoundingBox<dim>                        &my_region,
                   const MPI_Comm                                         communicator);

/// The same for the section of a body; a UserError if the shape holds no lattice point or is
/// thinner than one.
template <int dim>
GeneratedParticles<dim>
generate_particles(const Parameters                                      &body,
                   const std::function<bool(const dealii::Point<dim> &)> &is_mine,
                   const dealii::BoundingBox<dim>                        &my_region,
                   const MPI_Comm                                         communicator);
} // namespace coracle
