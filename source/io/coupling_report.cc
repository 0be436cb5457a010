// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/coupling_output.h>

namespace coracle
{
namespace
{
template <int dim, typename Action>
void
for_each_structure(const StructureSystem<dim> &structure, const Action &action)
{
  for (const auto &body : structure.solids)
    action(body);
  for (const auto &body : structure.rigids)
    action(body);
}
} // namespace

template <int dim>
EnergyBooks
CouplingOutput<dim>::energies(const Coupling<dim> &coupling)
{
  const auto    &books = coupling.points.books();
  const MPI_Comm comm  = coupling.points.octree.triangulation.get_communicator();
  EnergyBooks    result;
  result.kinetic       = mpi::sum(books.kinetic, comm);
  result.internal      = mpi::sum(books.internal, comm);
  result.damping       = mpi::sum(books.damping, comm);
  result.contact       = -mpi::sum(books.contact, comm);
  result.transfer      = mpi::sum(books.transfer, comm);
  result.boundary      = mpi::sum(books.boundary, comm);
  result.external_work = mpi::sum(books.external_work, comm);
  for (const auto &fluid : coupling.fluids.bodies)
    FluidOutput<dim>::add_energies(fluid, comm, result);
  const auto add = [&result](const auto &body) {
    const auto e = body.energies();
    result.kinetic += e.kinetic;
    result.strain += e.strain;
    result.hourglass += e.hourglass;
    result.damping += e.damping;
    result.contact -= e.contact_work;
    result.external_work += e.external_work;
  };
  for (const auto &body : coupling.structure.solids)
    add(body);
  for (const auto &body : coupling.structure.rigids)
    add(body);
  return result;
}

template <int dim>
void
CouplingOutput<dim>::add_bodies(Report<dim> &report, Coupling<dim> &coupling)
{
  std::vector<dealii::Tensor<1, dim>> momentum = coupling.structure.contact_momentum();
  for_each_structure(coupling.structure, [&](const auto &body) {
    const auto summary = body.summary();
    report.bodies.push_back({body.name(), summary.mass, summary.centre, summary.velocity, {}});
  });
  const auto  &given = coupling.contacts.contact_momentum();
  unsigned int s     = 0;
  for (const auto &body : coupling.points.bodies)
    {
      const auto &points = body.points;
      RankSums    rank_sums(1 + 2 * dim, points.reproducible);
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        {
          const double m = points.column(ParticleLayout<dim>::mass)[row];
          rank_sums.add(0, m);
          for (int d = 0; d < dim; ++d)
            {
              rank_sums.add(1 + d, m * points.column(ParticleLayout<dim>::position + d)[row]);
              rank_sums.add(1 + dim + d, m * points.column(ParticleLayout<dim>::velocity + d)[row]);
            }
        }
      const auto      sums = rank_sums.total(comm);
      BodyReport<dim> entry{body.name(), sums[0], {}, {}, {}};
      for (int d = 0; d < dim && sums[0] > 0; ++d)
        {
          entry.centre[d]   = sums[1 + d] / sums[0];
          entry.velocity[d] = sums[1 + dim + d] / sums[0];
        }
      report.bodies.push_back(entry);
      momentum.push_back(s < given.size() ? given[s] : dealii::Tensor<1, dim>());
      ++s;
    }
  for (const auto &body : coupling.fluids.bodies)
    {
      report.bodies.push_back(FluidOutput<dim>::report(body));
      momentum.emplace_back();
    }
  const double interval = report.time - reported_time;
  for (unsigned int b = 0; b < report.bodies.size(); ++b)
    {
      auto &body = report.bodies[b];
      report.momentum += body.mass * body.velocity;
      const auto total = mpi::sum(momentum[b], comm);
      if (interval > 0)
        reported_force[b] = (total - reported_momentum[b]) / interval;
      reported_momentum[b] = total;
      body.contact_force   = reported_force[b];
    }
  reported_time = report.time;
}

template <int dim>
Report<dim>
CouplingOutput<dim>::make_report(Coupling<dim> &coupling)
{
  Report<dim> report;
  report.time                      = coupling.time();
  report.step                      = coupling.step();
  report.dt                        = coupling.last_step();
  report.penetrations              = coupling.contacts.n_penetrations();
  report.contacts                  = coupling.contacts.report().n_contacts;
  report.resolved_in_time          = coupling.contacts.report().n_resolved;
  report.worst_gap                 = coupling.worst_gap;
  report.contact_steps             = coupling.contact_steps;
  report.unconverged_contact_steps = coupling.unconverged_contact_steps;
  report.particles                 = mpi::sum(coupling.points.n_particles(), comm);
  report.particle_steps            = mpi::sum(coupling.particle_steps, comm);
  for (const auto &body : coupling.points.bodies)
    {
      report.particles_created += mpi::sum(body.points.ledger.created, comm);
      report.particles_removed += mpi::sum(body.points.ledger.removed, comm);
      report.particles_converted += mpi::sum(body.points.ledger.converted, comm);
      report.particles_split += mpi::sum(body.points.ledger.split, comm);
      report.particles_merged += mpi::sum(body.points.ledger.merged, comm);
    }
  report.cells = mpi::sum<std::uint64_t>(coupling.points.octree.n_owned_leaves(), comm);
  for_each_structure(coupling.structure, [&report](const auto &body) {
    report.elements += body.mesh().n_global_elements();
  });
  report.imbalance =
    coupling.adaptivity.imbalance(coupling.points, coupling.structure, coupling.contacts);
  report.energies = energies(coupling);
  if (first_report)
    balance.start(report.energies);
  first_report                = false;
  report.energy_balance_error = balance.error(report.energies);
  add_bodies(report, coupling);
  coupling.worst_gap = 0;
  return report;
}

#define INSTANTIATE(dim)                                                                \
  template EnergyBooks CouplingOutput<dim>::energies(const Coupling<dim> &);            \
  template void        CouplingOutput<dim>::add_bodies(Report<dim> &, Coupling<dim> &); \
  template Report<dim> CouplingOutput<dim>::make_report(Coupling<dim> &);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
