// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/function.h>

#include <coracle/base/columns.h>
#include <coracle/base/exact_sum.h>
#include <coracle/base/parameters.h>
#include <coracle/mesh/structure_mesh.h>

#include <array>
#include <memory>
#include <vector>

namespace coracle
{
/**
 * The section `Boundary conditions` of a body: nodes that are fixed, that slide
 * in a plane of symmetry, or that move as a function of space and time says.
 * Where two conditions prescribe the same direction, the later one counts.
 */
template <int dim>
class BoundaryConditions
{
public:
  static void declare(Declaration &body_section);
  /// Collective. Throws UserError.
  BoundaryConditions(const Parameters &body_section, const StructureMesh<dim> &mesh);

  /// Inverse mass of owned nodes becomes 0 where motion is prescribed.
  void constrain(Columns &nodes) const;

  /**
   * Velocities of the prescribed directions for the step from `time` to time + dt: a velocity
   * function at its middle; for displacements what leads to the exact position at its end.
   *
   * @param duration time between the old and the new velocities [s]
   * @param work     of setting new velocities is added: 0: on the material, 1: of the supports [J]
   */
  void prescribe_velocities(Columns     &nodes,
                            const double time,
                            const double dt,
                            const double duration,
                            RankSums    &work) const;

private:
  struct Condition
  {
    /// Owned nodes of which each direction is prescribed.
    std::array<std::vector<unsigned int>, dim> nodes;
    bool                                       is_displacement = false;
    /// Null for conditions without motion.
    std::unique_ptr<dealii::Function<dim>> function;
  };

  Condition read(const Parameters &section, const StructureMesh<dim> &mesh) const;
  double
  velocity(const Condition &condition, Columns &nodes, unsigned int n, int d, double dt) const;

  std::vector<Condition> conditions;
};

extern template class BoundaryConditions<2>;
extern template class BoundaryConditions<3>;
} // namespace coracle
