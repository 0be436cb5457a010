// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/structure_system.h>

#include <map>

namespace coracle
{
template <int dim>
StructureSystem<dim>::StructureSystem(const Parameters             &root,
                                      const MaterialLibrary        &materials,
                                      const dealii::Tensor<1, dim> &gravity,
                                      const bool                    reproducible,
                                      MPI_Comm                      comm)
  : comm(comm), reproducible(reproducible)
{
  const Parameters bodies = root.section("Bodies");
  for (const std::string &name : bodies.section_names())
    {
      const Parameters  body = bodies.section(name);
      const std::string kind = body.choice("Kind");
      if (kind == "solid")
        solids.emplace_back(body, materials, gravity, comm, reproducible);
      else if (kind == "rigid")
        rigids.emplace_back(body, gravity, comm);
    }
  make_surface();
}

template <int dim>
template <typename Action>
void
StructureSystem<dim>::for_each_surface(const Action &action)
{
  unsigned int i = 0;
  for (auto &body : solids)
    action(body, i++);
  for (auto &body : rigids)
    action(body, i++);
}

template <int dim>
void
StructureSystem<dim>::describe_surfaces(const StructuralBody<dim> &body,
                                        const unsigned int         index,
                                        const int                  rigid_body)
{
  contact::SurfaceBody description;
  description.thickness       = body.thickness();
  description.friction        = body.friction();
  description.rigid_body      = rigid_body;
  description.part            = index;
  const unsigned int n_sheets = body.mesh().n_sheets();
  for (unsigned int i = 0; i < std::max(1u, n_sheets); ++i)
    {
      if (n_sheets > 0)
        {
          description.kind  = contact::SurfaceKind::sheet;
          description.sheet = sheets++;
        }
      surface.bodies.push_back(description);
      body_of_surface.push_back(index);
    }
}

template <int dim>
void
StructureSystem<dim>::make_surface()
{
  surface = contact::Surface<dim>();
  first_node.clear();
  body_of_surface.clear();
  sheets                  = 0;
  int           n_rigid   = 0;
  std::uint64_t first_key = 0, first_facet_key = 0;
  for_each_surface([&](auto &body, const unsigned int index) {
    constexpr bool     is_rigid      = std::is_same_v<std::decay_t<decltype(body)>, RigidBody<dim>>;
    const unsigned int first_surface = surface.bodies.size();
    describe_surfaces(body, index, is_rigid ? n_rigid++ : -1);
    for (unsigned int s = first_surface; s < surface.bodies.size(); ++s)
      if constexpr (is_rigid)
        surface.bodies[s].movable =
          body.body_inverse_mass().norm() > 0 || body.inverse_inertia().norm() > 0;
      else
        surface.bodies[s].self_contact = body.self_contact();

    first_node.push_back(surface.nodes.size());
    std::map<unsigned int, unsigned int> place;
    for (const unsigned int node : body.surface_nodes())
      {
        place[node] = surface.nodes.size();
        surface.nodes.emplace_back();
        surface.nodes.back().key   = first_key + body.key(node);
        surface.nodes.back().owner = body.owner(node);
      }
    if constexpr (!is_rigid && dim == 3)
      for (const HangingNode &node : body.mesh().hanging_nodes)
        if (const auto found = place.find(node.node); found != place.end())
          {
            // Those in the middle of a face are inside the body.
            AssertDimension(node.parents.size(), 2);
            for (unsigned int i = 0; i < 2; ++i)
              surface.nodes[found->second].parents[i] = place.at(node.parents[i].first);
          }
    std::uint64_t largest_key = 0;
    for (const auto &facet : body.facets())
      {
        contact::Facet<dim> f;
        for (unsigned int v = 0; v < f.nodes.size(); ++v)
          f.nodes[v] = place.at(facet.nodes[v]);
        f.body      = first_surface + facet.sheet;
        f.key       = first_facet_key + facet.key;
        largest_key = std::max(largest_key, facet.key);
        surface.facets.push_back(f);
      }
    first_key += body.mesh().n_global_nodes();
    first_facet_key += mpi::max(largest_key, comm) + 1;
  });
  received.resize(first_node.size());
}

template <int dim>
double
StructureSystem<dim>::stable_time_step() const
{
  double dt = std::numeric_limits<double>::infinity();
  for (const auto &body : solids)
    dt = std::min(dt, body.stable_time_step());
  return mpi::min(dt, comm);
}

template <int dim>
std::string
StructureSystem<dim>::describe_limit() const
{
  const double smallest = stable_time_step();
  std::string  result;
  for (const auto &body : solids)
    if (mpi::min(body.stable_time_step(), comm) == smallest && result.empty())
      result = "the smallest element of '" + body.name() + "' asks for it";
  return result;
}

template <int dim>
void
StructureSystem<dim>::assemble_forces(const double time)
{
  for_each_surface([&](auto &body, const unsigned int) { body.assemble_forces(time); });
}

template <int dim>
void
StructureSystem<dim>::predict_velocities(const double dt)
{
  for_each_surface([&](auto &body, const unsigned int) { body.predict_velocities(dt); });
}

template <int dim>
void
StructureSystem<dim>::move(const double dt)
{
  for_each_surface([&](auto &body, const unsigned int) { body.move(dt); });
}

template <int dim>
void
StructureSystem<dim>::update_stresses(const double dt)
{
  for_each_surface([&](auto &body, const unsigned int) {
    try
      {
        body.update_stress(dt);
      }
    catch (const RunFailure &bad)
      {
        if (!failure)
          failure.emplace(bad.title, "'" + body.name() + "': " + bad.details, bad.cure);
      }
  });
}

template <int dim>
const contact::Surface<dim> &
StructureSystem<dim>::publish_surface()
{
  for_each_surface([&](auto &body, const unsigned int index) {
    auto node = surface.nodes.begin() + first_node[index];
    for (const unsigned int local : body.surface_nodes())
      {
        node->position     = body.position(local);
        node->velocity     = body.velocity(local);
        node->inverse_mass = body.inverse_mass(local);
        ++node;
      }
  });
  return surface;
}

template <int dim>
std::vector<contact::RigidUnknown<dim>>
StructureSystem<dim>::rigid_unknowns() const
{
  std::vector<contact::RigidUnknown<dim>> result;
  for (const auto &body : rigids)
    result.push_back({body.centre(),
                      body.centre_velocity(),
                      body.spin(),
                      body.body_inverse_mass(),
                      body.inverse_inertia()});
  return result;
}

template <int dim>
void
StructureSystem<dim>::apply_contact(
  const std::vector<dealii::Tensor<1, dim>>                             &impulse,
  const std::vector<dealii::Tensor<1, dim>>                             &correction,
  const std::vector<typename contact::ContactSystem<dim>::RigidImpulse> &rigid)
{
  for_each_surface([&](auto &body, const unsigned int index) {
    if constexpr (std::is_same_v<std::decay_t<decltype(body)>, RigidBody<dim>>)
      {
        // The same on all ranks, so that one of them tells the body.
        const auto &sums = rigid[index - solids.size()];
        if (mpi::rank(comm) == 0)
          {
            received[index] += sums.impulse;
            body.add_contact_impulse(sums.impulse, sums.moment);
            body.add_correction(sums.correction, sums.correction_moment);
          }
      }
    else
      {
        unsigned int i = first_node[index];
        RankSums     sums(dim, reproducible);
        for (const unsigned int local : body.surface_nodes())
          {
            for (int d = 0; d < dim; ++d)
              sums.add(d, impulse[i][d]);
            body.add_contact_impulse(local, impulse[i]);
            body.add_correction(local, correction[i]);
            ++i;
          }
        const auto share = sums.share(comm);
        for (int d = 0; d < dim; ++d)
          received[index][d] += share[d];
      }
    body.apply_contact_impulses();
    body.apply_corrections();
  });
}

template <int dim>
bool
StructureSystem<dim>::change_ends(const contact::EndChanges<dim> &changes)
{
  bool result = false;
  for_each_surface([&](auto &body, const unsigned int index) {
    if constexpr (std::is_same_v<std::decay_t<decltype(body)>, RigidBody<dim>>)
      {
        const double part = changes.rigid_part[index - solids.size()];
        result            = (part < 1 && body.shorten_step(part)) || result;
      }
    else
      {
        unsigned int i = first_node[index];
        for (const unsigned int local : body.surface_nodes())
          {
            body.add_end_change(local, changes.shift[i], changes.count[i]);
            ++i;
          }
        result = body.apply_end_changes(changes.held_part) || result;
      }
  });
  return result;
}

template <int dim>
void
StructureSystem<dim>::apply_node_impulses(
  const std::vector<std::vector<dealii::Tensor<1, dim>>> &impulse)
{
  for_each_surface([&](auto &body, const unsigned int index) {
    for (unsigned int node = 0; node < impulse[index].size(); ++node)
      if (impulse[index][node].norm_square() > 0)
        {
          received[index] += impulse[index][node];
          body.add_contact_impulse(node, impulse[index][node]);
        }
    body.apply_contact_impulses();
  });
}

template <int dim>
bool
StructureSystem<dim>::has_failed() const
{
  return mpi::any(failure.has_value(), comm);
}

template <int dim>
bool
StructureSystem<dim>::refine(const std::vector<std::vector<bool>> &wanted, const Work &work)
{
  bool changed = false;
  for_each_surface([&](auto &body, const unsigned int index) {
    if (!mpi::any(std::find(wanted[index].begin(), wanted[index].end(), true) !=
                    wanted[index].end(),
                  comm))
      return;
    if (!work.empty())
      body.set_element_weights(work[index]);
    changed = body.refine(wanted[index]) || changed;
  });
  if (changed)
    make_surface();
  return changed;
}

template <int dim>
void
StructureSystem<dim>::share_out(const std::vector<bool> &bodies, const Work &work)
{
  for_each_surface([&](auto &body, const unsigned int index) {
    if (!bodies[index])
      return;
    body.set_element_weights(work[index]);
    body.share_out();
  });
  make_surface();
}

template <int dim>
bool
StructureSystem<dim>::serialize(Archive &archive)
{
  bool changed = false;
  for_each_surface([&](auto &body, const unsigned int) {
    body.serialize(archive);
    changed = changed || body.n_mesh_changes() > 0;
  });
  if (archive.loads() && changed)
    make_surface();
  archive.share("contact_momentum_of_structures", received);
  return changed;
}

template class StructureSystem<2>;
template class StructureSystem<3>;
} // namespace coracle
