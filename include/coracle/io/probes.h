// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>

#include <coracle/base/archive.h>
#include <coracle/base/parameters.h>
#include <coracle/io/field.h>
#include <coracle/io/statistics.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace coracle
{
/// What a probe is attached to.
enum class ProbeKind
{
  /// A place fixed in space: samples the particles of a body that are within a radius.
  point,
  /// A place of a structure or rigid body, carried with it: the node nearest to it at the start.
  body_point,
  /// A line along gravity: how high a meshless fluid stands there, see SurfaceGauge.
  surface
};

/// One section `Probes/<name>`.
template <int dim>
struct ProbeDescription
{
  std::string        name;
  std::string        body;
  ProbeKind          kind = ProbeKind::body_point;
  dealii::Point<dim> position;   ///< [m]; of a body point in the reference configuration
  double             radius = 0; ///< point only [m]

  /// "<body>.<name>", with which its columns begin.
  std::string prefix() const { return body + "." + name; }

  /// Adds section `Probes` to the root.
  static void declare(Declaration &root);
  /// Checks that each body exists and fits the kind; a UserError otherwise. Meshless fluids are
  /// among the particle bodies too.
  static std::vector<ProbeDescription> read(const Parameters               &probes_section,
                                            const std::vector<std::string> &structure_bodies,
                                            const std::vector<std::string> &particle_bodies,
                                            const std::vector<std::string> &fluid_bodies);
};

/// The nodes of a structure or rigid body that this rank owns, viewed where they lie.
struct NodeView
{
  std::size_t          n_nodes = 0;
  Field                reference;      ///< positions at the start [m]
  Field                current;        ///< positions now [m]
  Field                velocity;       ///< [m/s]
  const std::uint64_t *keys = nullptr; ///< the same node has the same key on any number of ranks
};

/**
 * A place of a structure: the node nearest to a point of the reference
 * configuration; of several equally near (to 1e-9 of the distance) the one with
 * the lowest key, so that the choice does not depend on the partition.
 *
 * Columns <prefix>.position, <prefix>.displacement [m], <prefix>.velocity [m/s].
 */
template <int dim>
class BodyPointProbe
{
public:
  /// Finds the node. Collective.
  BodyPointProbe(const ProbeDescription<dim> &description,
                 const NodeView              &nodes,
                 MPI_Comm                     communicator);

  const std::string &name() const { return prefix; }

  /// Which node it was at the start of the run; find_again() follows.
  void serialize(Archive &archive) { archive.same("place", place); }
  /// Finds the same node again when nodes were renumbered or shared out anew. Collective.
  void find_again(const NodeView &nodes) { find(nodes, place); }

  static void add_columns(const ProbeDescription<dim> &description, Statistics &statistics);
  /// Collective.
  void set_columns(const NodeView &nodes, Statistics &statistics) const;

  /// From the place asked for to the node found [m].
  double        distance() const { return found_distance; }
  std::uint64_t key() const { return found_key; }

private:
  /// The node nearest to a point of the reference configuration, and where it is there.
  void find(const NodeView &nodes, const dealii::Point<dim> &near);

  std::string        prefix;
  MPI_Comm           comm;
  dealii::Point<dim> place;
  double             found_distance = 0;
  std::uint64_t      found_key      = 0;
  /// Index of the node where it is owned, -1 on other ranks.
  std::int64_t local_node = -1;
};

/// The particles of one body on this rank; rows without mass are holes and do not count.
struct ParticleView
{
  std::size_t   n_particles = 0;
  Field         position;           ///< [m]
  Field         velocity;           ///< [m/s]
  const double *mass     = nullptr; ///< [kg]
  const double *pressure = nullptr; ///< [Pa]
};

/**
 * A place in space: mass-weighted means over the particles within a radius
 * around it. Columns <prefix>.particles (how many), <prefix>.pressure [Pa],
 * <prefix>.velocity [m/s]; all 0 while there is no particle.
 */
template <int dim>
class PointProbe
{
public:
  PointProbe(const ProbeDescription<dim> &description, MPI_Comm communicator);

  static void add_columns(const ProbeDescription<dim> &description, Statistics &statistics);
  /// Collective.
  /// @param reproducible sums do not depend on the ranks, bit by bit
  void set_columns(const ParticleView &particles,
                   Statistics         &statistics,
                   const bool          reproducible = false) const;

private:
  ProbeDescription<dim> description;
  MPI_Comm              comm;
};
} // namespace coracle
