// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/probes.h>
#include <coracle/meshless/fluid.h>

namespace coracle
{
/**
 * How high a meshless fluid stands at a place: where the line through `Position`
 * along gravity crosses the boundary of its elements, the highest of all
 * crossings. Up is the axis that gravity acts along most, against it; the last
 * axis without gravity. Linear between points, so that it sees far less than
 * their spacing.
 *
 * Columns <prefix>.height, the coordinate along that axis [m], and <prefix>.wet:
 * 1, or 0 where the line meets no fluid and the height is that of the box's floor.
 */
template <int dim>
class SurfaceGauge
{
public:
  SurfaceGauge(const ProbeDescription<dim> &description, MPI_Comm communicator);

  static void add_columns(const ProbeDescription<dim> &description, Statistics &statistics);
  /// Collective.
  void set_columns(const meshless::Fluid<dim> &fluid, Statistics &statistics) const;

private:
  ProbeDescription<dim> description;
  MPI_Comm              comm;
};
} // namespace coracle
