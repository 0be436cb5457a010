// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>
#include <coracle/meshless/scalar_system.h>

#include <deal.II/base/bounding_box.h>

namespace coracle::meshless
{
/// What a face of the box does to the fluid.
enum class Wall : unsigned char
{
  /// No motion through the face, free along it.
  slip,
  /// No motion at the face.
  stick,
  /// Points may leave; they are counted and removed.
  open
};

/// How points are taken out and put in; lengths over the points' spacing h.
struct RefillOptions
{
  bool enabled = true;
  /// Of two points nearer than this one is taken out.
  double nearest = 0.45;
  /// A point nearer than this to a face of the box, and not on it, is taken out.
  double nearest_to_wall = 0.3;
  /// On the boundary of the fluid, and inside it: a longer edge gets a point in its middle.
  double longest_boundary_edge = 1.5, longest_edge = 1.7;
};

/// A part of the fluid that is another one: what its points have.
struct FluidRegion
{
  std::string name;
  double      density   = 1000; ///< [kg/m^3]
  double      viscosity = 0;    ///< dynamic [Pa s]
};

/// The meshless fluid of a body, as its section of the parameter file describes it.
template <int dim>
struct FluidOptions
{
  double density   = 1000; ///< [kg/m^3]
  double viscosity = 0;    ///< dynamic [Pa s]
  double spacing   = 0;    ///< h of points [m]
  /// Region k of a point or element is number k - 1 here, 0 is the fluid outside of them.
  std::vector<FluidRegion> regions;
  /// As alpha, for elements whose points were all at the free surface in the step before.
  double              surface_alpha = 0.85;
  TessellationOptions tessellation;
  RefillOptions       refill;
  SolverOptions       solver;
  /// Share of the new velocity in the one that moves points: 1 first order, 1/2 second order.
  double time_weight = 1;
  /// Solutions of a step, each on elements moved halfway along the motion of the one before.
  unsigned int n_iterations = 2;
  /// Time in which fluid that appeared or disappeared with new elements is taken back [s]; 0:
  /// never.
  double volume_relaxation = 0;
  /// Share of h that a point may move in a step.
  double largest_move = 0.25;
  /// Do points slide on structures, or move with them?
  bool                      slips_on_structures = false;
  dealii::Tensor<1, dim>    gravity;
  dealii::BoundingBox<dim>  box;
  std::array<Wall, 2 * dim> walls{};
  /// By direction: what leaves the box at one end comes in at the other; its faces there are open.
  std::array<bool, dim> periodic{};

  /// Entries of a body of the kind `meshless fluid`, without those of its shape and start.
  static void declare(Declaration &body);
  /// The box and its walls are the grid's, and not read here.
  static FluidOptions read(const Parameters &body, const dealii::Tensor<1, dim> &gravity);
};
} // namespace coracle::meshless
