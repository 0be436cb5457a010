// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>

namespace coracle::contact
{
/// Which conditions the contacts ask for; see Solver.
enum class Law
{
  split,
  blended,
  stick_slip
};

/// How candidates are looked for; see GlobalSearch.
enum class Search
{
  aabb_tree,
  bucket,
  all_pairs
};

/// What is done about points that start where they may not be.
enum class InitialOverlap
{
  refuse,
  project
};

/// Which points of facets make contacts; see LocalSearch.
enum class LocalMethod
{
  nearest_on_surface,
  nearest_per_facet,
  perpendicular_foot
};

/// Where particles and structures meet.
enum class Method
{
  surface,
  grid
};

/// What the section `Contact` of a parameter file says.
struct ContactOptions
{
  Method method = Method::surface;
  /// Do bodies of different velocity fields meet on the grid, and with which Coulomb coefficient
  /// [1]?
  bool   between_fields          = false;
  double friction_between_fields = 0;
  /// Default of the surfaces' Coulomb coefficient [1].
  double      friction     = 0;
  Search      search       = Search::aabb_tree;
  LocalMethod local_search = LocalMethod::nearest_on_surface;
  Law         law          = Law::split;
  /// Share of the depth that the blended law turns into velocity, alpha [1].
  double alpha = 0.3;
  /// Residual at which the solver stops, relative to the greatest approach speed [1].
  double       tolerance          = 1e-4;
  unsigned int maximum_iterations = 1000;
  bool         accelerate         = true;
  /// Remove remaining depth by moving positions (law split).
  bool         position_correction = true;
  unsigned int position_iterations = 50;
  /// Follow points through the step and change the ends of those that would come too near; only
  /// with law split and contacts nearest on the surface.
  bool continuous_check = true;
  /// Distance by which candidates reach farther than needed, in contact distances R (largest point
  /// radius plus half thickness) [1].
  double         skin            = 1;
  InitialOverlap initial_overlap = InitialOverlap::refuse;

  /// Do the surfaces of structures meet each other?
  bool structure_contact = true;

  /// Results are the same on any number of ranks, bit by bit; see BlockRows.
  bool reproducible = false;

  static void declare(Declaration &section);

  ContactOptions() = default;
  explicit ContactOptions(const Parameters &section, const bool reproducible = false);
};
} // namespace coracle::contact
