// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/contact/overlap_projection.h>
#include <coracle/coupling/contact_coupling.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace coracle
{
namespace
{
/// Particles that are named in a message; all are counted.
constexpr unsigned int n_named = 5;
/// Rounds of moving and looking again; each moves by most of a cell.
constexpr unsigned int maximum_rounds = 200;

/// The lowest ids of a set's points on all ranks, "3, 17, 20".
template <int dim>
std::string
first_ids(const std::vector<contact::Overlap<dim>> &overlaps, const unsigned int set, MPI_Comm comm)
{
  std::set<std::uint64_t> ids;
  for (const auto &overlap : overlaps)
    if (overlap.set == set)
      ids.insert(overlap.id);
  std::vector<std::uint64_t> mine(ids.begin(), ids.end());
  mine.resize(std::min<std::size_t>(mine.size(), n_named + 1));
  ids.clear();
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(comm, mine))
    ids.insert(of_rank.begin(), of_rank.end());
  std::ostringstream text;
  unsigned int       n = 0;
  for (const std::uint64_t id : ids)
    if (n++ < n_named)
      text << (n > 1 ? ", " : "") << id;
  if (ids.size() > n_named)
    text << " ...";
  return text.str();
}
} // namespace

template <int dim>
std::vector<contact::Overlap<dim>>
ContactCoupling<dim>::find_overlaps(MaterialPointSystem<dim> &points,
                                    StructureSystem<dim>     &structure,
                                    std::uint64_t            &n_particles)
{
  make_point_sets(points, true);
  const auto overlaps = contact::initial_overlaps(structure.publish_surface(), sets, comm);
  std::set<std::pair<unsigned int, unsigned int>> particles;
  for (const auto &overlap : overlaps)
    particles.emplace(overlap.set, overlap.point);
  n_particles = mpi::sum<std::uint64_t>(particles.size(), comm);
  return overlaps;
}

template <int dim>
typename ContactCoupling<dim>::Projected
ContactCoupling<dim>::resolve_initial_overlaps(const Parameters         &root,
                                               MaterialPointSystem<dim> &points,
                                               StructureSystem<dim>     &structure)
{
  surface_nodes.refuse_initial_overlaps(root, structure);
  std::uint64_t n_particles = 0;
  auto          overlaps    = find_overlaps(points, structure, n_particles);
  Projected     result;
  if (initial_overlap == contact::InitialOverlap::project)
    result.n_particles = n_particles;
  for (unsigned int round = 0; round < maximum_rounds && result.n_particles > 0 && n_particles > 0;
       ++round)
    {
      const double farthest = project(overlaps, points, structure);
      if (round == 0)
        result.farthest = farthest;
      overlaps = find_overlaps(points, structure, n_particles);
    }
  if (n_particles > 0)
    refuse(root, overlaps, n_particles, points, structure);
  return result;
}

template <int dim>
double
ContactCoupling<dim>::project(const std::vector<contact::Overlap<dim>> &overlaps,
                              MaterialPointSystem<dim>                 &points,
                              StructureSystem<dim>                     &structure)
{
  const double limit    = 0.9 * points.octree.smallest_cell_size();
  double       farthest = 0;
  for (const auto &target :
       contact::project_overlaps(structure.publish_surface(), sets, overlaps, comm))
    {
      auto                  &body   = std::next(points.bodies.begin(), target.set)->points;
      const auto             x      = body.position(target.point);
      dealii::Tensor<1, dim> way    = target.place - x;
      const double           length = way.norm();
      farthest                      = std::max(farthest, length);
      // Farther ones go on from the next rank, if need be, in the next round.
      if (length > limit)
        way *= limit / length;
      dealii::Point<dim> next = x + way;
      // Outside of the box there is no way out: it stays, and is named in the end.
      if (!points.octree.box().point_inside(next))
        next = x;
      for (int d = 0; d < dim; ++d)
        body.column(ParticleLayout<dim>::next_position + d)[target.point] = next[d];
    }
  points.locate(0.);
  return mpi::max(farthest, comm);
}

template <int dim>
void
ContactCoupling<dim>::refuse(const Parameters                         &root,
                             const std::vector<contact::Overlap<dim>> &overlaps,
                             const std::uint64_t                       n_particles,
                             const MaterialPointSystem<dim>           &points,
                             const StructureSystem<dim>               &structure) const
{
  // Rank by rank the deepest one; the message tells of the deepest of all.
  std::array<double, 4 + dim> deepest{};
  for (const auto &overlap : overlaps)
    if (overlap.depth > deepest[0])
      {
        deepest[0] = overlap.depth;
        deepest[1] = overlap.id;
        deepest[2] = overlap.set;
        deepest[3] = overlap.body;
        for (int d = 0; d < dim; ++d)
          deepest[4 + d] = overlap.place[d];
      }
  // Equally deep ones are common under a flat surface: all ranks must name the same.
  const auto of_all = dealii::Utilities::MPI::all_gather(comm, deepest);
  deepest           = of_all.front();
  for (const auto &other : of_all)
    if (other[0] > deepest[0])
      deepest = other;

  const bool         projected      = initial_overlap == contact::InitialOverlap::project;
  const std::string  body           = std::next(points.bodies.begin(), deepest[2])->name();
  const std::string  structure_name = structure.body_name(deepest[3]);
  std::ostringstream found, cure;
  found << n_particles << (n_particles == 1 ? " particle of '" : " particles of '") << body
        << "' in or too near to '" << structure_name << "' (number "
        << first_ids(overlaps, deepest[2], comm) << "); the deepest is number "
        << static_cast<std::uint64_t>(deepest[1]) << " at (";
  for (int d = 0; d < dim; ++d)
    found << (d > 0 ? ", " : "") << deepest[4 + d];
  found << ") m, ";
  if (std::isfinite(deepest[0]))
    {
      found << deepest[0] << " m nearer than the contact distance";
      cure << "move '" << structure_name << "' away by " << deepest[0] << " m";
    }
  else
    {
      found << "deep inside";
      cure << "move '" << structure_name << "' out of '" << body << "'";
    }
  cure << ", or shrink the region of '" << body << "'";
  if (!projected)
    cure << ", or set Contact/Initial overlap = project";
  throw root.section("Bodies").section(body).error(
    "",
    projected ? "particles start inside a structure and cannot be moved out"
              : "particles start inside a structure",
    found.str(),
    cure.str());
}

template class ContactCoupling<2>;
template class ContactCoupling<3>;
} // namespace coracle
