// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/structure_system.h>
#include <coracle/grid/box_boundary.h>
#include <coracle/meshless/fluid.h>

#include <list>
#include <optional>

namespace coracle
{
/// The meshless fluid of a run, or none: each function is one line of the step.
template <int dim>
class MeshlessSystem
{
public:
  /// Entries of a body of the kind `meshless fluid`.
  static void declare(Declaration &body);

  /**
   * Section `Bodies`; points start on the ranks whose leaves they are in.
   * @param with_points false where they are loaded next
   * Collective; throws UserError.
   */
  MeshlessSystem(const Parameters             &root,
                 const dealii::Tensor<1, dim> &gravity,
                 const Octree<dim>            &octree,
                 StructureSystem<dim>         &structure,
                 const bool                    with_points);

  bool empty() const { return bodies.empty(); }

  /// On this rank.
  std::uint64_t n_points() const
  {
    std::uint64_t n = 0;
    for (const auto &body : bodies)
      n += body.n_fluid();
    return n;
  }

  /// Over all ranks [s].
  double step_limit() const;
  /// Whose that is, for messages. Collective.
  std::string describe_limit() const;

  /// Velocities, pressures and positions at the end of the step; impulses on structures, whose
  /// velocities are predicted.
  /// @param last_dt of the step before, 0: none [s]
  /// Collective.
  void advance(const double          time,
               const double          last_dt,
               const double          dt,
               StructureSystem<dim> &structure,
               TimingTable          &timed);
  /// Points that left or are crowded go, gaps are filled; structures have moved. Collective.
  void refill(StructureSystem<dim> &structure);
  /// New elements. Collective.
  void remesh();

  /// Between steps; structures are loaded before. Collective.
  void serialize(Archive &archive, StructureSystem<dim> &structure);

  /// The first thing that went wrong on this rank, see MaterialPointSystem.
  std::optional<RunFailure> failure;

  std::list<meshless::Fluid<dim>> bodies;

private:
  void look_at(StructureSystem<dim> &structure, meshless::Fluid<dim> &fluid) const;
  void push(StructureSystem<dim> &structure, const meshless::Fluid<dim> &fluid) const;

  MPI_Comm comm;
};
} // namespace coracle
