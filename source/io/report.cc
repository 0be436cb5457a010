// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>

#include <coracle/io/report.h>

#include <algorithm>
#include <cmath>

namespace coracle
{
double
EnergyBooks::magnitude() const
{
  // Internal and strain energy are booked as work, which may be negative in tension released.
  return std::max({kinetic, std::abs(internal), std::abs(strain), std::abs(external_work)});
}

void
EnergyBalance::start(const EnergyBooks &initial)
{
  initial_balance = initial.balance();
  scale           = initial.magnitude();
}

double
EnergyBalance::error(const EnergyBooks &now)
{
  scale = std::max(scale, now.magnitude());
  return scale > 0 ? (now.balance() - initial_balance) / scale : 0.;
}

template <int dim>
void
add_standard_columns(Statistics &statistics, const std::vector<std::string> &bodies)
{
  statistics.add_column("time", "s");
  statistics.add_column("step", "");
  statistics.add_column("dt", "s");
  statistics.add_column("penetrations", "");
  statistics.add_column("contacts", "");
  statistics.add_column("contact.resolved_in_time", "");
  statistics.add_column("worst_gap", "m");
  statistics.add_column("contact_steps", "");
  statistics.add_column("unconverged_contact_steps", "");
  for (const char *const name : {"particles",
                                 "particles.created",
                                 "particles.removed",
                                 "particles.converted",
                                 "particles.split",
                                 "particles.merged",
                                 "particle_steps",
                                 "cells",
                                 "elements",
                                 "imbalance"})
    statistics.add_column(name, "");
  for (const char *const name : {"kinetic",
                                 "internal",
                                 "strain",
                                 "hourglass",
                                 "damping",
                                 "contact",
                                 "transfer",
                                 "boundary",
                                 "external_work"})
    statistics.add_column(std::string("energy.") + name, "J");
  statistics.add_column("energy.balance_error", "");
  statistics.add_vector("momentum", "kg m/s", dim);
  for (const std::string &body : bodies)
    {
      statistics.add_column(body + ".mass", "kg");
      statistics.add_vector(body + ".centre", "m", dim);
      statistics.add_vector(body + ".velocity", "m/s", dim);
      statistics.add_vector(body + ".contact_force", "N", dim);
    }
}

template <int dim>
void
set_standard_columns(Statistics &statistics, const Report<dim> &report)
{
  statistics.set("time", report.time);
  statistics.set("step", report.step);
  statistics.set("dt", report.dt);
  statistics.set("penetrations", report.penetrations);
  statistics.set("contacts", report.contacts);
  statistics.set("contact.resolved_in_time", report.resolved_in_time);
  statistics.set("worst_gap", report.worst_gap);
  statistics.set("contact_steps", report.contact_steps);
  statistics.set("unconverged_contact_steps", report.unconverged_contact_steps);
  statistics.set("particles", report.particles);
  statistics.set("particles.created", report.particles_created);
  statistics.set("particles.removed", report.particles_removed);
  statistics.set("particles.converted", report.particles_converted);
  statistics.set("particles.split", report.particles_split);
  statistics.set("particles.merged", report.particles_merged);
  statistics.set("particle_steps", report.particle_steps);
  statistics.set("cells", report.cells);
  statistics.set("elements", report.elements);
  statistics.set("imbalance", report.imbalance);

  const EnergyBooks &e = report.energies;
  statistics.set("energy.kinetic", e.kinetic);
  statistics.set("energy.internal", e.internal);
  statistics.set("energy.strain", e.strain);
  statistics.set("energy.hourglass", e.hourglass);
  statistics.set("energy.damping", e.damping);
  statistics.set("energy.contact", e.contact);
  statistics.set("energy.transfer", e.transfer);
  statistics.set("energy.boundary", e.boundary);
  statistics.set("energy.external_work", e.external_work);
  statistics.set("energy.balance_error", report.energy_balance_error);
  statistics.set_vector("momentum", report.momentum, dim);

  for (const BodyReport<dim> &body : report.bodies)
    {
      statistics.set(body.name + ".mass", body.mass);
      statistics.set_vector(body.name + ".centre", body.centre, dim);
      statistics.set_vector(body.name + ".velocity", body.velocity, dim);
      statistics.set_vector(body.name + ".contact_force", body.contact_force, dim);
    }
}

template void add_standard_columns<2>(Statistics &, const std::vector<std::string> &);
template void add_standard_columns<3>(Statistics &, const std::vector<std::string> &);
template void set_standard_columns(Statistics &, const Report<2> &);
template void set_standard_columns(Statistics &, const Report<3> &);
} // namespace coracle
