// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>

#include <coracle/base/exact_sum.h>
#include <coracle/base/mpi.h>
#include <coracle/io/probes.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coracle
{
namespace
{
const char *const kind_point = "point", *const kind_body_point = "body point",
                  *const kind_surface = "surface";

template <int dim>
dealii::Point<dim>
entry(const Field &field, const std::size_t i)
{
  dealii::Point<dim> result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] = field.components[d][i * field.stride];
  return result;
}

bool
contains(const std::vector<std::string> &names, const std::string &name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string
joined(const std::vector<std::string> &names)
{
  std::string result;
  for (const std::string &name : names)
    result += (result.empty() ? "'" : ", '") + name + "'";
  return result.empty() ? "none" : result;
}
} // namespace

template <int dim>
void
ProbeDescription<dim>::declare(Declaration &root)
{
  Declaration &probe = root.named_sections("Probes",
                                           "probe",
                                           "Places whose values become columns <body>.<probe>.* of "
                                           "statistics.csv");
  probe.choice("Kind",
               kind_body_point,
               {kind_point, kind_body_point, kind_surface},
               "body point: the node of a structure or rigid body that is nearest to Position at "
               "the start, carried with the body; point: a place fixed in space that samples "
               "material points or points of a meshless fluid; surface: how high a meshless fluid "
               "stands on the line through Position along gravity");
  probe.text("Body", "", "The body it belongs to");
  probe.list("Position", "", "m", "", "Where it is, in the reference configuration of the body");
  probe.quantity("Radius",
                 "0 m",
                 "m",
                 "",
                 "Kind = point: particles of the body within this distance are averaged, weighted "
                 "by their mass",
                 0);
}

template <int dim>
std::vector<ProbeDescription<dim>>
ProbeDescription<dim>::read(const Parameters               &probes_section,
                            const std::vector<std::string> &structure_bodies,
                            const std::vector<std::string> &particle_bodies,
                            const std::vector<std::string> &fluid_bodies)
{
  std::vector<ProbeDescription> result;
  for (const std::string &name : probes_section.section_names())
    {
      const Parameters section = probes_section.section(name);
      ProbeDescription probe;
      probe.name             = name;
      probe.body             = section.text("Body");
      const std::string kind = section.choice("Kind");
      probe.kind             = kind == kind_point     ? ProbeKind::point
                               : kind == kind_surface ? ProbeKind::surface
                                                      : ProbeKind::body_point;
      probe.position         = section.point<dim>("Position");
      probe.radius           = section.quantity("Radius");

      const bool  samples_particles = (probe.kind == ProbeKind::point);
      const auto &allowed           = samples_particles                  ? particle_bodies
                                      : probe.kind == ProbeKind::surface ? fluid_bodies
                                                                         : structure_bodies;
      if (!contains(allowed, probe.body))
        throw section.error("Body",
                            "a probe has no body it could belong to",
                            "'" + probe.body + "', but a probe of kind '" + kind + "' needs " +
                              (samples_particles                  ? "a material point body"
                               : probe.kind == ProbeKind::surface ? "a meshless fluid"
                                                                  : "a structure or rigid body"),
                            "choose one of these: " + joined(allowed));
      if (!section.is_set("Position"))
        throw section.error("Position",
                            "a probe has no place",
                            "no Position",
                            "set Position to " + std::to_string(dim) + " coordinates");
      if (samples_particles && probe.radius <= 0)
        throw section.error("Radius",
                            "a probe of kind 'point' needs a radius",
                            "Radius = 0",
                            "set Radius to one or two particle spacings of '" + probe.body + "'");
      result.push_back(probe);
    }
  return result;
}

template <int dim>
BodyPointProbe<dim>::BodyPointProbe(const ProbeDescription<dim> &description,
                                    const NodeView              &nodes,
                                    MPI_Comm                     communicator)
  : prefix(description.prefix()), comm(communicator)
{
  find(nodes, description.position);
}

template <int dim>
void
BodyPointProbe<dim>::find(const NodeView &nodes, const dealii::Point<dim> &near)
{
  local_node     = -1;
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < nodes.n_nodes; ++i)
    nearest = std::min(nearest, near.distance(entry<dim>(nodes.reference, i)));
  found_distance = mpi::min(nearest, comm);

  // Nodes at the same distance up to round-off: the lowest key decides, on any partition.
  const double  limit  = found_distance * (1 + 1e-9) + 1e-15 * near.norm();
  std::uint64_t lowest = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t i = 0; i < nodes.n_nodes; ++i)
    if (near.distance(entry<dim>(nodes.reference, i)) <= limit && nodes.keys[i] < lowest)
      {
        lowest     = nodes.keys[i];
        local_node = i;
      }
  // Not Utilities::MPI::min(): with MPI_UNSIGNED_LONG, Open MPI 4.1 compares as if signed.
  MPI_Allreduce(&lowest, &found_key, 1, MPI_UINT64_T, MPI_MIN, comm);
  if (lowest != found_key || lowest == std::numeric_limits<std::uint64_t>::max())
    local_node = -1;
  AssertThrow(mpi::sum(local_node >= 0 ? 1 : 0, comm) == 1,
              dealii::ExcMessage("The node of probe '" + prefix + "' must have one owner."));
  // Only its owner adds anything.
  dealii::Tensor<1, dim> x;
  if (local_node >= 0)
    x = entry<dim>(nodes.reference, local_node);
  place = dealii::Point<dim>(mpi::sum(x, comm));
}

template <int dim>
void
BodyPointProbe<dim>::add_columns(const ProbeDescription<dim> &description, Statistics &statistics)
{
  statistics.add_vector(description.prefix() + ".position", "m", dim);
  statistics.add_vector(description.prefix() + ".displacement", "m", dim);
  statistics.add_vector(description.prefix() + ".velocity", "m/s", dim);
}

template <int dim>
void
BodyPointProbe<dim>::set_columns(const NodeView &nodes, Statistics &statistics) const
{
  // Only the owner's share is not zero, so that the sum is its values exactly.
  std::array<double, 3 * dim> local{}, values;
  if (local_node >= 0)
    {
      const auto reference = entry<dim>(nodes.reference, local_node);
      const auto current   = entry<dim>(nodes.current, local_node);
      const auto velocity  = entry<dim>(nodes.velocity, local_node);
      for (unsigned int d = 0; d < dim; ++d)
        {
          local[d]           = current[d];
          local[dim + d]     = current[d] - reference[d];
          local[2 * dim + d] = velocity[d];
        }
    }
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(local),
                              comm,
                              dealii::ArrayView<double>(values));
  statistics.set_vector(prefix + ".position", &values[0], dim);
  statistics.set_vector(prefix + ".displacement", &values[dim], dim);
  statistics.set_vector(prefix + ".velocity", &values[2 * dim], dim);
}

template <int dim>
PointProbe<dim>::PointProbe(const ProbeDescription<dim> &description, MPI_Comm communicator)
  : description(description), comm(communicator)
{}

template <int dim>
void
PointProbe<dim>::add_columns(const ProbeDescription<dim> &description, Statistics &statistics)
{
  statistics.add_column(description.prefix() + ".particles", "");
  statistics.add_column(description.prefix() + ".pressure", "Pa");
  statistics.add_vector(description.prefix() + ".velocity", "m/s", dim);
}

template <int dim>
void
PointProbe<dim>::set_columns(const ParticleView &particles,
                             Statistics         &statistics,
                             const bool          reproducible) const
{
  // Number, mass, mass times pressure, momentum.
  RankSums rank_sums(3 + dim, reproducible);
  for (std::size_t i = 0; i < particles.n_particles; ++i)
    if (particles.mass[i] > 0 &&
        description.position.distance(entry<dim>(particles.position, i)) <= description.radius)
      {
        const double mass     = particles.mass[i];
        const auto   velocity = entry<dim>(particles.velocity, i);
        rank_sums.add(0, 1);
        rank_sums.add(1, mass);
        rank_sums.add(2, mass * particles.pressure[i]);
        for (unsigned int d = 0; d < dim; ++d)
          rank_sums.add(3 + d, mass * velocity[d]);
      }
  auto sums = rank_sums.total(comm);

  const std::string prefix = description.prefix();
  const double      mass   = sums[1];
  for (unsigned int k = 2; k < 3 + dim; ++k)
    sums[k] = (mass > 0 ? sums[k] / mass : 0.);
  statistics.set(prefix + ".particles", sums[0]);
  statistics.set(prefix + ".pressure", sums[2]);
  statistics.set_vector(prefix + ".velocity", &sums[3], dim);
}

template struct ProbeDescription<2>;
template struct ProbeDescription<3>;
template class BodyPointProbe<2>;
template class BodyPointProbe<3>;
template class PointProbe<2>;
template class PointProbe<3>;
} // namespace coracle
