// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/coupling.h>
#include <coracle/io/fluid_output.h>
#include <coracle/io/mesh_output.h>
#include <coracle/io/output_settings.h>
#include <coracle/io/particle_output.h>
#include <coracle/io/probes.h>
#include <coracle/io/report.h>
#include <coracle/io/surface_gauge.h>

#include <memory>

namespace coracle
{
/**
 * Everything that a run writes about a coupled problem: particles, structures,
 * octree, statistics and probes. All functions are collective.
 */
template <int dim>
class CouplingOutput
{
public:
  CouplingOutput(const Parameters     &root,
                 const OutputSettings &settings,
                 OutputDirectory      &directory,
                 Coupling<dim>        &coupling);

  /// Files of this moment.
  void write(Coupling<dim> &coupling);

  /// The state of the run; contact forces are means since the last report.
  Report<dim> make_report(Coupling<dim> &coupling);

  void write_statistics(const Report<dim> &report, Coupling<dim> &coupling);

  /// Steps after which files and rows were written last; -1: never. A run that goes on knows them.
  std::int64_t step_of_files() const { return files_step; }
  std::int64_t step_of_row() const { return row_step; }

  /// What has been written and reported. Collective; when loaded, files that came later are cut or
  /// forgotten.
  void serialize(Archive &archive);

private:
  void
  write_particles(const MaterialPointBody<dim> &body, ParticleOutput &output, const double time);
  void               write_structure(const StructuralBody<dim>                 &body,
                                     const std::vector<Symmetric<dim, double>> *stress,
                                     MeshOutput                                &output,
                                     const double                               time);
  void               write_octree(const Coupling<dim> &coupling);
  void               add_bodies(Report<dim> &report, Coupling<dim> &coupling);
  void               follow_meshes(Coupling<dim> &coupling);
  void               make_probes(const Parameters &root, Coupling<dim> &coupling);
  static EnergyBooks energies(const Coupling<dim> &coupling);

  OutputSettings                                           settings;
  MPI_Comm                                                 comm;
  Statistics                                               statistics;
  std::vector<ParticleOutput>                              particles;
  std::vector<FluidOutput<dim>>                            fluids;
  std::vector<MeshOutput>                                  structures;
  std::unique_ptr<MeshOutput>                              octree;
  std::vector<std::pair<std::string, BodyPointProbe<dim>>> body_probes;
  /// Of all meshes together when probes looked for their nodes.
  unsigned int                                         mesh_changes = 0;
  std::vector<std::pair<std::string, PointProbe<dim>>> point_probes;
  std::vector<SurfaceGauge<dim>>                       gauges;
  EnergyBalance                                        balance;
  /// Per body (solids, rigids, material points): momentum from contact at the last report [N s].
  std::vector<dealii::Tensor<1, dim>> reported_momentum;
  std::vector<dealii::Tensor<1, dim>> reported_force;
  double                              reported_time = 0;
  bool                                first_report  = true;
  std::int64_t                        files_step = -1, row_step = -1;
};
} // namespace coracle
