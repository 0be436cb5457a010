// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/adaptivity.h>

#include <algorithm>
#include <numeric>

namespace coracle
{
namespace
{
/// How often it is asked how far things have moved.
constexpr unsigned int steps_between_looks = 5;
/// Work is shared out anew only where it is this much less even than after the last time.
constexpr double worse = 1.1;
/// What makes this part of the unevenness, over an equal one with all others, is shared out anew.
constexpr double least_share = 0.25;

/// Largest speed of particles and of nodes of structures, on all ranks [m/s].
template <int dim>
double
largest_speed(const MaterialPointSystem<dim> &points, StructureSystem<dim> &structure)
{
  double square = 0;
  for (const auto &body : points.bodies)
    for (std::size_t row = 0; row < body.points.n_rows(); ++row)
      {
        double sum = 0;
        for (int d = 0; d < dim; ++d)
          sum += std::pow(body.points.column(ParticleLayout<dim>::velocity + d)[row], 2);
        square = std::max(square, sum);
      }
  for (const auto &node : structure.publish_surface().nodes)
    square = std::max(square, node.velocity.norm_square());
  return mpi::max(std::sqrt(square), points.octree.triangulation.get_communicator());
}
} // namespace

void
AdaptivityState::serialize(Archive &archive)
{
  const Archive::Section part(archive, "adaptivity");
  archive.same("next_id", next_id);
  archive.same("steps", steps);
  archive.same("steps_since_balance", steps_since_balance);
  archive.same("travelled", travelled);
  archive.same("reached_imbalance", reached_imbalance);
}

template <int dim>
void
Adaptivity<dim>::declare(Declaration &grid)
{
  Declaration &adaptivity = grid.section(
    "Adaptivity",
    "Cells that become finer and coarser while the run goes on, and particles that split "
    "and merge with them; it is on if there is any criterion. Regions of "
    "`Refinement` stay at least as fine as they say.");
  adaptivity.integer("Interval in steps", 50, "Steps between adaptations at most.", 1);
  adaptivity.quantity(
    "Interval in cells",
    "1",
    "1",
    "",
    "Adapted earlier when something may have moved by so many of the smallest cells; 0: not.",
    0.);
  ParticleRefinement<dim>::declare(adaptivity);
  RefinementCriteria<dim>::declare(adaptivity);

  Declaration &balance =
    grid.section("Load balance",
                 "Sharing out of cells with their particles, and of elements of structures, "
                 "among the ranks.");
  balance.quantity(
    "Largest imbalance",
    "1.2",
    "1",
    "",
    "Work of the busiest rank over the mean, beyond which it is shared out anew; 0: never.",
    0.);
  balance.integer("Interval in steps", 100, "Steps between looks at the balance.", 1);
  balance.quantity(
    "Work of a contact", "20", "1", "", "Of a contact over that of a particle, in a step.", 0.);
  StructureWork<dim>::declare(balance);
}

template <int dim>
Adaptivity<dim>::Adaptivity(const Parameters           &root,
                            const StructureSystem<dim> &structure,
                            const contact::Method       method)
  : criteria(root, structure, method == contact::Method::surface)
  , refinement(root.section("Grid").section("Adaptivity"))
  , structure_work(root)
{
  const Parameters section = root.section("Grid").section("Adaptivity"),
                   load    = root.section("Grid").section("Load balance");
  interval                 = section.integer("Interval in steps");
  interval_in_cells        = section.quantity("Interval in cells");
  balance_interval         = load.integer("Interval in steps");
  largest_imbalance        = load.quantity("Largest imbalance");
  contact_weight           = load.quantity("Work of a contact");
  reproducible             = root.flag("Reproducible");
}

template <int dim>
std::vector<double>
Adaptivity<dim>::work(const MaterialPointSystem<dim> &points,
                      const ContactCoupling<dim>     &contacts) const
{
  const auto         &octree = points.octree;
  std::vector<double> result(octree.n_owned_leaves());
  for (const auto &body : points.bodies)
    for (const unsigned int leaf : body.points.occupied_cells())
      result[leaf] += body.points.cell_begin()[leaf + 1] - body.points.cell_begin()[leaf];
  for (unsigned int leaf = 0; leaf < result.size(); ++leaf)
    result[leaf] += contact_weight * contacts.leaf_contacts().number(leaf);
  return result;
}

template <int dim>
std::vector<double>
Adaptivity<dim>::work_of_parts(const MaterialPointSystem<dim>            &points,
                               const ContactCoupling<dim>                &contacts,
                               const typename StructureWork<dim>::ByBody &elements) const
{
  std::vector<double> result(1, points.octree.n_owned_leaves() + points.n_particles());
  for (unsigned int leaf = 0; leaf < points.octree.n_owned_leaves(); ++leaf)
    result[0] += contact_weight * contacts.leaf_contacts().number(leaf);
  for (const auto &of_body : elements)
    result.push_back(std::accumulate(of_body.begin(), of_body.end(), 0.));
  return result;
}

template <int dim>
double
Adaptivity<dim>::imbalance(const MaterialPointSystem<dim> &points,
                           const StructureSystem<dim>     &structure,
                           const ContactCoupling<dim>     &contacts) const
{
  const MPI_Comm comm = points.octree.triangulation.get_communicator();
  const auto     parts =
    work_of_parts(points, contacts, structure_work.of_elements(structure, contacts));
  const double mine = std::accumulate(parts.begin(), parts.end(), 0.);
  return mpi::max(mine, comm) * mpi::n_ranks(comm) / std::max(mpi::sum(mine, comm), 1.);
}

template <int dim>
std::vector<bool>
Adaptivity<dim>::uneven_parts(const std::vector<double> &work, MPI_Comm comm)
{
  std::vector<double> largest(work.size()), sum(work.size());
  dealii::Utilities::MPI::max(work, comm, largest);
  dealii::Utilities::MPI::sum(work, comm, sum);
  double all = 0;
  for (unsigned int part = 0; part < work.size(); ++part)
    all += largest[part] - sum[part] / mpi::n_ranks(comm);
  // There is always one.
  std::vector<bool> result;
  for (unsigned int part = 0; part < work.size(); ++part)
    result.push_back(largest[part] - sum[part] / mpi::n_ranks(comm) >
                     least_share * all / work.size());
  return result;
}

template <int dim>
void
Adaptivity<dim>::initialise(MaterialPointSystem<dim> &points,
                            StructureSystem<dim>     &structure,
                            ContactCoupling<dim>     &contacts)
{
  const MPI_Comm comm = points.octree.triangulation.get_communicator();
  for (const auto &body : points.bodies)
    {
      std::uint64_t next = 0;
      for (std::size_t row = 0; row < body.points.n_rows(); ++row)
        if (!body.points.is_hole(row))
          next = std::max(next, body.points.id(row) + 1);
      state.next_id.push_back(mpi::max(next, comm));
    }
  contacts.octree_changed(points);
  if (!criteria.empty())
    for (unsigned int round = 0; round <= criteria.highest_level(); ++round)
      if (!adapt(points, structure, contacts, 0.))
        break;
  balance(points, structure, contacts);
}

template <int dim>
bool
Adaptivity<dim>::due(const MaterialPointSystem<dim> &points,
                     StructureSystem<dim>           &structure,
                     const double                    dt)
{
  ++state.steps;
  if (interval_in_cells > 0 && state.steps % steps_between_looks == 0)
    {
      state.travelled += steps_between_looks * dt * largest_speed(points, structure);
      if (state.travelled > interval_in_cells * points.octree.smallest_cell_size())
        return true;
    }
  return state.steps >= interval;
}

template <int dim>
void
Adaptivity<dim>::update(MaterialPointSystem<dim> &points,
                        StructureSystem<dim>     &structure,
                        ContactCoupling<dim>     &contacts,
                        const double              time,
                        const double              dt)
{
  if (!criteria.empty() && due(points, structure, dt))
    {
      adapt(points, structure, contacts, time);
      contacts.forget_leaf_contacts(points);
      state.steps     = 0;
      state.travelled = 0;
    }
  // Sharing out forgets what contact did in leaves, which criteria may ask for.
  const bool may_forget = !reproducible || criteria.empty() || state.steps == 0;
  if (++state.steps_since_balance >= balance_interval && may_forget)
    balance(points, structure, contacts);
}

template <int dim>
bool
Adaptivity<dim>::adapt(MaterialPointSystem<dim> &points,
                       StructureSystem<dim>     &structure,
                       ContactCoupling<dim>     &contacts,
                       const double              time)
{
  auto &octree = points.octree;
  points.sort();
  std::vector<int> wanted =
    criteria.wanted_levels({points, structure, contacts.leaf_contacts(), time});
  // Particles that could not split yet must fit into the cells.
  for (const auto &body : points.bodies)
    for (const unsigned int leaf : body.points.occupied_cells())
      for (unsigned int row = body.points.cell_begin()[leaf];
           row < body.points.cell_begin()[leaf + 1];
           ++row)
        if (body.points.column(ParticleLayout<dim>::size)[row] > 1.001 * octree.size(leaf))
          wanted[leaf] = std::min(wanted[leaf], octree.level(leaf));
  const bool new_leaves = octree.adapt(wanted, work(points, contacts));
  if (new_leaves)
    {
      points.octree_changed();
      contacts.octree_changed(points);
    }
  const bool new_particles = refinement.adapt(points, structure, state.next_id) > 0;
  if (new_particles)
    points.redistribute_particles();
  if (new_leaves || new_particles)
    balance(points, structure, contacts);
  return new_leaves || new_particles;
}

template <int dim>
bool
Adaptivity<dim>::balance(MaterialPointSystem<dim> &points,
                         StructureSystem<dim>     &structure,
                         ContactCoupling<dim>     &contacts)
{
  const MPI_Comm comm       = points.octree.triangulation.get_communicator();
  state.steps_since_balance = 0;
  if (largest_imbalance == 0 || mpi::n_ranks(comm) == 1)
    return false;
  const bool is_uneven = imbalance(points, structure, contacts) >
                         std::max(largest_imbalance, worse * state.reached_imbalance);
  if (is_uneven)
    {
      const auto        elements = structure_work.of_elements(structure, contacts);
      std::vector<bool> parts    = uneven_parts(work_of_parts(points, contacts, elements), comm);
      if (parts[0])
        {
          points.sort();
          points.octree.repartition(work(points, contacts));
          points.octree_changed();
          contacts.octree_changed(points);
        }
      parts.erase(parts.begin());
      if (structure_work.may_share_out() &&
          std::find(parts.begin(), parts.end(), true) != parts.end())
        {
          structure.share_out(parts, elements);
          contacts.structure_shared_out(structure);
          points.structure_changed();
        }
      state.reached_imbalance = imbalance(points, structure, contacts);
    }
  contacts.fade_structure_points();
  return is_uneven;
}

template class Adaptivity<2>;
template class Adaptivity<3>;
} // namespace coracle
