// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/mesh_output.h>
#include <coracle/io/output_settings.h>
#include <coracle/io/particle_output.h>
#include <coracle/io/probes.h>
#include <coracle/io/report.h>
#include <coracle/meshless/fluid.h>

namespace coracle
{
/**
 * What a run writes about one meshless fluid: NAME, its points, as particles are
 * written; NAME.elements, its elements cut into simplices; and columns of
 * statistics. All functions are collective.
 */
template <int dim>
class FluidOutput
{
public:
  FluidOutput(OutputDirectory &directory, const std::string &name, const OutputSettings &settings);

  void write(const double time, const meshless::Fluid<dim> &fluid);

  static void add_columns(Statistics &statistics, const meshless::Fluid<dim> &fluid);
  static void set_columns(Statistics &statistics, const meshless::Fluid<dim> &fluid, MPI_Comm comm);

  static void add_energies(const meshless::Fluid<dim> &fluid, MPI_Comm comm, EnergyBooks &energies);

  static BodyReport<dim> report(const meshless::Fluid<dim> &fluid);

  /// Values of a point sensor.
  static void set_probe(const PointProbe<dim>      &probe,
                        const meshless::Fluid<dim> &fluid,
                        Statistics                 &statistics);

  void serialize(Archive &archive);

private:
  ParticleOutput points;
  MeshOutput     elements;
};
} // namespace coracle
