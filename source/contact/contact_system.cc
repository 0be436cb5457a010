// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exact_sum.h>
#include <coracle/contact/contact_system.h>
#include <coracle/contact/messages.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coracle::contact
{
namespace
{
/// What is used up of the skin in a step, more than predicted because contact changes velocities.
constexpr double movement_margin = 1.1;
/// Candidates reach this much farther than the present speeds ask for.
constexpr double reach_margin = 1.25;
/// The skin is as wide as what will be used up until points are renumbered anyway, with this
/// margin, and at least this part of what is asked for.
constexpr double skin_margin = 1.25, least_part_of_skin = 0.5;
/// Boxes per point set that tell other ranks where this rank's points are.
constexpr unsigned int n_reach_boxes = 8;

template <int dim>
double
maximum_speed(const PointSet<dim> &points)
{
  if (points.maximum_speed >= 0 || points.velocity[0] == nullptr)
    return std::max(0., points.maximum_speed);
  double square = 0;
  for (unsigned int i = 0; i < points.n_points; ++i)
    square = std::max(square, points.point_velocity(i).norm_square());
  return std::sqrt(square);
}

template <int dim>
double
maximum_radius(const PointSet<dim> &points)
{
  if (points.n_points == 0 || points.radius_column == nullptr)
    return points.n_points == 0 ? 0. : points.constant_radius;
  return *std::max_element(points.radius_column, points.radius_column + points.n_points);
}

/// Boxes around stretches of consecutive points: sorted points make them tight.
template <int dim>
void
append_boxes(const PointSet<dim> &points, const double margin, std::vector<Box> &boxes)
{
  for (unsigned int b = 0; b < n_reach_boxes; ++b)
    {
      const unsigned int begin = std::uint64_t(points.n_points) * b / n_reach_boxes,
                         end   = std::uint64_t(points.n_points) * (b + 1) / n_reach_boxes;
      if (begin == end)
        continue;
      Box box;
      for (int d = 0; d < dim; ++d)
        {
          const auto range =
            std::minmax_element(points.position[d] + begin, points.position[d] + end);
          box.lower[d] = *range.first - margin;
          box.upper[d] = *range.second + margin;
        }
      boxes.push_back(box);
    }
}
} // namespace

template <int dim>
ContactSystem<dim>::ContactSystem(const ContactOptions &options, MPI_Comm communicator)
  : options(options)
  , communicator(communicator)
  , facets(communicator)
  , search(options.search)
  , local_search(options.local_search)
  , solver(options, communicator)
{}

template <int dim>
typename ContactSystem<dim>::Extremes
ContactSystem<dim>::measure(const Surface<dim>               &owned,
                            const std::vector<PointSet<dim>> &points) const
{
  Extremes   here{changed ? 1. : 0., 0, 0, 0, 0};
  const bool comparable = (positions_at_search.size() == owned.nodes.size());
  if (!comparable)
    here.changed = 1;
  for (const auto &set : points)
    {
      here.point_speed = std::max(here.point_speed, maximum_speed(set));
      here.radius      = std::max({here.radius, maximum_radius(set), set.least_skin});
    }
  for (unsigned int i = 0; i < owned.nodes.size(); ++i)
    {
      here.node_speed = std::max(here.node_speed, owned.nodes[i].velocity.norm_square());
      if (comparable)
        here.movement =
          std::max(here.movement, owned.nodes[i].position.distance_square(positions_at_search[i]));
    }
  here.node_speed = std::sqrt(here.node_speed);
  here.movement   = std::sqrt(here.movement);
  MPI_Allreduce(MPI_IN_PLACE, &here, 5, MPI_DOUBLE, MPI_MAX, communicator);
  return here;
}

template <int dim>
void
ContactSystem<dim>::rebuild(const Surface<dim>               &owned,
                            const std::vector<PointSet<dim>> &points,
                            const Extremes                   &extremes,
                            const double                      travel)
{
  double thickness = 0;
  for (const auto &body : owned.bodies)
    thickness = std::max(thickness, body.thickness);
  // Points are renumbered at regular intervals. No steps left: at longer ones than before.
  if (extremes.changed > 0)
    {
      change_interval    = (statistics.n_rebuilds > 0 ? steps_since_change : 0);
      steps_since_change = 0;
    }
  const double n_steps =
    (change_interval > steps_since_change ? double(change_interval - steps_since_change) : 1e6);
  const double skin     = options.skin * (extremes.radius + 0.5 * thickness),
               expected = skin_margin * movement_margin * 0.5 * travel * n_steps;
  reach = reach_margin * travel + std::clamp(expected, least_part_of_skin * skin, skin);
  used  = 0;

  std::vector<Box> boxes;
  if (n_ranks(communicator) == 1)
    {
      boxes.resize(1);
      boxes[0].lower.fill(std::numeric_limits<double>::lowest());
      boxes[0].upper.fill(std::numeric_limits<double>::max());
    }
  else
    for (const auto &set : points)
      append_boxes(set, maximum_radius(set) + reach, boxes);
  facets.rebuild(owned, boxes, points);
  local_search.reinit(facets.surface());
  search.rebuild(facets.surface(), points, reach);

  positions_at_search.resize(owned.nodes.size());
  for (unsigned int i = 0; i < owned.nodes.size(); ++i)
    positions_at_search[i] = owned.nodes[i].position;
  changed = false;

  // Points far from all sheets belong to no side.
  statistics.n_candidates = 0;
  for (unsigned int s = 0; s < points.size(); ++s)
    {
      const auto &near = search.candidates(s).point;
      for (double *side : points[s].side)
        for (unsigned int i = 0, next = 0; i < points[s].n_points; ++i)
          if (next < near.size() && near[next] == i)
            ++next;
          else
            side[i] = 0;
      statistics.n_candidates += search.candidates(s).facet.size();
    }
  ++statistics.n_rebuilds;
}

template <int dim>
void
ContactSystem<dim>::find(const Surface<dim>               &owned,
                         const std::vector<PointSet<dim>> &points,
                         const double                      dt)
{
  const Extremes                    extremes = measure(owned, points);
  typename LocalSearch<dim>::Motion motion{dt,
                                           extremes.point_speed,
                                           extremes.node_speed,
                                           extremes.radius};
  // The others take all that is listed for contacts.
  if (options.local_search != LocalMethod::nearest_on_surface)
    motion.radius = 0;
  const double travel = motion.travel();
  ++steps_since_change;
  // Points that are nodes have moved as these have.
  const bool   has_nodes = !points.empty() && points.back().body >= 0;
  const double gone      = std::max(used, has_nodes ? extremes.movement : 0.);
  if (extremes.changed > 0 || gone + extremes.movement + travel > reach)
    rebuild(owned, points, extremes, travel);
  else
    facets.update(owned);
  used_before = used;
  used += movement_margin * dt * extremes.point_speed;

  // The band only needs the speeds of points that have something to touch.
  motion.point_speed = 0;
  for (unsigned int s = 0; s < points.size(); ++s)
    for (const unsigned int p : search.candidates(s).point)
      motion.point_speed = std::max(motion.point_speed, points[s].point_velocity(p).norm_square());
  motion.point_speed = std::sqrt(motion.point_speed);
  if (options.reproducible)
    MPI_Allreduce(MPI_IN_PLACE, &motion.point_speed, 1, MPI_DOUBLE, MPI_MAX, communicator);

  list.clear();
  keys.clear();
  local_search.update();
  for (unsigned int s = 0; s < points.size(); ++s)
    {
      const std::size_t first = list.size();
      local_search.find(points[s], s, search.candidates(s), motion, list);
      if (points[s].body >= 0)
        list.resize(complete_node_contacts(points[s], first));
    }

  std::vector<const Candidates *> candidate_lists;
  for (unsigned int s = 0; s < points.size(); ++s)
    candidate_lists.push_back(&search.candidates(s));
  auditor.start(surface(), points, candidate_lists);
  in_time.start(surface());

  statistics.worst_gap = std::numeric_limits<double>::max();
  for (const auto &contact : list)
    {
      keys.push_back({points[contact.set].id(contact.point) ^ (std::uint64_t(contact.set) << 54),
                      surface().facets[contact.facet].key});
      statistics.worst_gap = std::min(statistics.worst_gap, contact.gap - contact.distance);
    }
  if (options.reproducible)
    solver.set_blocks(BlockRows<dim>::find_blocks(list, points));
  MPI_Allreduce(MPI_IN_PLACE, &statistics.worst_gap, 1, MPI_DOUBLE, MPI_MIN, communicator);
  if (statistics.worst_gap == std::numeric_limits<double>::max())
    statistics.worst_gap = 0;
}

template <int dim>
std::size_t
ContactSystem<dim>::complete_node_contacts(const PointSet<dim> &points, const std::size_t first)
{
  std::size_t kept = first;
  for (std::size_t c = first; c < list.size(); ++c)
    {
      auto contact       = list[c];
      contact.point_body = points.body;
      contact.point_node = facets.local_node(points.surface_node[contact.point]);
      contact.friction   = std::min(contact.friction, surface().bodies[points.body].friction);
      if (anything_moves(contact, surface()))
        list[kept++] = contact;
    }
  return kept;
}

template <int dim>
void
ContactSystem<dim>::solve(const std::vector<RigidUnknown<dim>> &rigid, const double dt)
{
  solver.solve(list, keys, rows.rows(), rows.unknowns(), rigid, dt);
  statistics.solver     = solver.report();
  statistics.n_contacts = solver.report().n_contacts;
  statistics.work += solver.report().work;
  statistics.energy_fed += std::max(0., solver.report().work);
  used += movement_margin * solver.report().largest_correction;
  if (options.reproducible && statistics.n_contacts > 0)
    sum_up_blocks(rigid);
  else
    sum_up(rigid);
}

// Copies of all blocks in their order, rigid bodies in exact sums.
template <int dim>
void
ContactSystem<dim>::sum_up_blocks(const std::vector<RigidUnknown<dim>> &rigid)
{
  auto                 &blocks = solver.blocks();
  const auto           &row    = blocks.rows();
  const auto           &result = solver.impulses();
  std::vector<Vector>   impulses(blocks.unknowns().size()), corrections(impulses.size());
  constexpr int         n_values = 2 * (dim + 3);
  std::vector<ExactSum> sums(n_values * rigid.size());
  for (std::size_t c = 0; c < list.size(); ++c)
    for (unsigned int side = 0; side < 2; ++side)
      {
        const double sign = (side == 0 ? 1 : -1);
        for (std::size_t e = row.begin[2 * c + side]; e < row.begin[2 * c + side + 1]; ++e)
          {
            const double weight = sign * row.entries[e].weight;
            impulses[row.entries[e].unknown] += weight * result.impulse[c];
            corrections[row.entries[e].unknown] += weight * result.correction[c];
          }
        if (row.rigid_body[c][side] < 0)
          continue;
        const unsigned int b   = blocks.body(row.rigid_body[c][side]);
        ExactSum          *sum = &sums[n_values * b];
        const Vector       arm = list[c].place + list[c].gap * list[c].normal - rigid[b].centre;
        for (const Vector &value : {sign * result.impulse[c], sign * result.correction[c]})
          {
            const auto moment = Delassus<dim>::torque(arm, value);
            for (int d = 0; d < dim; ++d)
              (sum++)->add(value[d]);
            for (int d = 0; d < 3; ++d)
              (sum++)->add(moment[d]);
          }
      }
  blocks.copies.sum_to_first(impulses);
  blocks.copies.sum_to_first(corrections);
  unknown_impulse.assign(rows.unknowns().size(), {});
  unknown_correction.assign(rows.unknowns().size(), {});
  for (unsigned int copy = 0; copy < impulses.size(); ++copy)
    {
      unknown_impulse[blocks.unknown(copy)] += impulses[copy];
      unknown_correction[blocks.unknown(copy)] += corrections[copy];
    }
  if (!rigid.empty())
    ExactSum::sum(sums, communicator);
  rigid_sums.assign(rigid.size(), {});
  const ExactSum *sum = sums.data();
  for (auto &body : rigid_sums)
    {
      for (int d = 0; d < dim; ++d)
        body.impulse[d] = (sum++)->value();
      for (int d = 0; d < 3; ++d)
        body.moment[d] = (sum++)->value();
      for (int d = 0; d < dim; ++d)
        body.correction[d] = (sum++)->value();
      for (int d = 0; d < 3; ++d)
        body.correction_moment[d] = (sum++)->value();
    }
}

template <int dim>
void
ContactSystem<dim>::sum_up(const std::vector<RigidUnknown<dim>> &rigid)
{
  unknown_impulse.assign(rows.unknowns().size(), {});
  unknown_correction.assign(rows.unknowns().size(), {});
  rigid_sums.assign(rigid.size(), {});
  const auto &row    = rows.rows();
  const auto &result = solver.impulses();
  for (std::size_t c = 0; c < list.size(); ++c)
    {
      for (unsigned int side = 0; side < 2; ++side)
        for (std::size_t e = row.begin[2 * c + side]; e < row.begin[2 * c + side + 1]; ++e)
          {
            const double weight = (side == 0 ? 1 : -1) * row.entries[e].weight;
            unknown_impulse[row.entries[e].unknown] += weight * result.impulse[c];
            unknown_correction[row.entries[e].unknown] += weight * result.correction[c];
          }
      for (unsigned int side = 0; side < 2; ++side)
        if (const int b = row.rigid_body[c][side]; b >= 0)
          {
            auto        &sum     = rigid_sums[b];
            const Vector arm     = list[c].place + list[c].gap * list[c].normal - rigid[b].centre,
                         impulse = (side == 0 ? 1 : -1) * result.impulse[c],
                         correction = (side == 0 ? 1 : -1) * result.correction[c];
            sum.impulse += impulse;
            sum.moment += Delassus<dim>::torque(arm, impulse);
            sum.correction += correction;
            sum.correction_moment += Delassus<dim>::torque(arm, correction);
          }
    }
  if (!rigid.empty())
    MPI_Allreduce(MPI_IN_PLACE,
                  rigid_sums.data(),
                  rigid_sums.size() * sizeof(RigidImpulse) / sizeof(double),
                  MPI_DOUBLE,
                  MPI_SUM,
                  communicator);
}

template <int dim>
void
ContactSystem<dim>::surface_impulses(std::vector<Vector> &impulse,
                                     std::vector<Vector> &correction) const
{
  std::vector<Vector> nodal_impulse(surface().nodes.size()),
    nodal_correction(surface().nodes.size());
  for (unsigned int i = 0; i < unknown_impulse.size(); ++i)
    if (rows.origins()[i].is_surface)
      {
        nodal_impulse[rows.origins()[i].number]    = unknown_impulse[i];
        nodal_correction[rows.origins()[i].number] = unknown_correction[i];
      }
  facets.add_to_owners(nodal_impulse, impulse);
  facets.add_to_owners(nodal_correction, correction);
}

template <int dim>
unsigned long
ContactSystem<dim>::audit(const Surface<dim> &owned, const std::vector<PointSet<dim>> &points)
{
  facets.update(owned);
  unsigned long n = auditor.finish(surface(), points);
  for (const auto &crossing : auditor.crossings())
    if (surface().bodies[crossing.body].kind == SurfaceKind::sheet)
      {
        double &side =
          points[crossing.set].side[surface().bodies[crossing.body].sheet][crossing.point];
        if (side == 0)
          side = crossing.side;
        side = (has_passed(side) ? 0.5 : 2.) * side;
      }
  MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
  statistics.n_penetrations += n;
  return n;
}

template <int dim>
void
ContactSystem<dim>::serialize(Archive &archive)
{
  const Archive::Section section(archive, "contact");
  {
    const Archive::Section part(archive, "report");
    statistics.serialize(archive);
  }
  archive.own("changed", changed);
  archive.own("reach", reach);
  archive.own("used", used);
  archive.same("steps_since_change", steps_since_change);
  archive.same("change_interval", change_interval);
  archive.own("positions_at_search", positions_at_search);
  {
    const Archive::Section part(archive, "facets");
    facets.serialize(archive);
  }
  {
    const Archive::Section part(archive, "candidates");
    search.serialize(archive);
  }
  solver.serialize(archive);
  auditor.serialize(archive);
  if (!archive.loads())
    return;
  local_search.reinit(facets.surface());
  changed = changed || !archive.is_exact();
}

template class ContactSystem<2>;
template class ContactSystem<3>;
} // namespace coracle::contact
