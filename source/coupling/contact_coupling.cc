// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/contact_coupling.h>

namespace coracle
{
namespace
{
template <int dim>
using Layout = ParticleLayout<dim>;

// Keys of grid nodes start where no structure node's key can be.
constexpr std::uint64_t first_grid_key = std::uint64_t(1) << 62;
constexpr unsigned int  field_shift    = 48;

/// Of the surfaces that a particle touches: share * n n, less of what the ones before have already.
template <int dim>
dealii::SymmetricTensor<2, dim>
touch_of(const contact::Contact<dim> *const first,
         const contact::Contact<dim> *const last,
         const double                       share,
         const double                       fade)
{
  dealii::SymmetricTensor<2, dim> result;
  for (const auto *contact = first; contact != last; ++contact)
    {
      double left = 1 - std::max(0., contact->gap - contact->distance) / fade;
      for (const auto *other = first; other != contact; ++other)
        left = std::min(left, 1 - std::pow(contact->normal * other->normal, 2));
      if (left > 0)
        result += share * left * symmetrize(outer_product(contact->normal, contact->normal));
    }
  return result;
}
} // namespace

template <int dim>
ContactCoupling<dim>::ContactCoupling(const contact::ContactOptions &options,
                                      MaterialPointSystem<dim>      &points,
                                      StructureSystem<dim>          &structure,
                                      MPI_Comm                       comm)
  : initial_overlap(options.initial_overlap)
  , comm(comm)
  , method(options.method)
  , reproducible(options.reproducible)
  , on_grid({options.method == contact::Method::grid,
             options.between_fields,
             options.friction_between_fields},
            points,
            structure,
            comm)
  , system(options, comm)
  // On the grid, structures meet particles only.
  , surface_nodes(options.structure_contact && method == contact::Method::surface, structure, comm)
{}

template <int dim>
void
ContactCoupling<dim>::make_point_sets(MaterialPointSystem<dim> &points, const bool renumbered)
{
  sets.resize(points.bodies.size() + surface_nodes.n_sets());
  ids.resize(points.bodies.size());
  radii.resize(points.bodies.size());
  unsigned int s = 0;
  for (auto &body : points.bodies)
    {
      auto                &set = sets[s];
      MaterialPoints<dim> &p   = body.points;
      set.n_points             = p.n_rows();
      set.mass                 = p.column(Layout<dim>::mass);
      for (int d = 0; d < dim; ++d)
        {
          set.position[d] = p.column(Layout<dim>::position + d);
          set.velocity[d] = p.column(Layout<dim>::velocity + d);
        }
      set.side.clear();
      for (int sheet = 0; sheet < p.layout().n_sheets; ++sheet)
        set.side.push_back(p.column(p.layout().side + sheet));
      if (renumbered)
        {
          ids[s].assign(p.column(Layout<dim>::id), p.column(Layout<dim>::id) + p.n_rows());
          radii[s].resize(p.n_rows());
          for (std::size_t row = 0; row < p.n_rows(); ++row)
            radii[s][row] = body.radius_factor * p.column(Layout<dim>::size)[row];
          set.group_begin.clear();
          for (const unsigned int cell : p.occupied_cells())
            set.group_begin.push_back(p.cell_begin()[cell]);
          if (!set.group_begin.empty())
            set.group_begin.push_back(p.cell_begin().back());
        }
      set.ids           = ids[s].data();
      set.radius_column = radii[s].data();
      ++s;
    }
}

template <int dim>
void
ContactCoupling<dim>::find(MaterialPointSystem<dim> &points,
                           StructureSystem<dim>     &structure,
                           const double              dt)
{
  const bool renumbered = points.take_renumbered();
  make_point_sets(points, renumbered);
  if (renumbered)
    system.points_renumbered();
  const auto &surface = structure.publish_surface();
  surface_nodes.fill(surface, sets.begin() + points.bodies.size());
  system.find(surface, sets, dt);
  surface_nodes.count(system.contacts(), points.bodies.size());
  note_touched(points);
}

template <int dim>
void
ContactCoupling<dim>::note_touched(MaterialPointSystem<dim> &points) const
{
  for (auto &body : points.bodies)
    {
      for (const unsigned int row : body.points.touched)
        body.points.set_touch(row, {});
      body.points.touched.clear();
    }
  const auto &contacts = system.contacts();
  for (std::size_t c = 0, next = 0; c < contacts.size(); c = next)
    {
      if (contacts[c].set >= points.bodies.size())
        return;
      for (next = c; next < contacts.size() && contacts[next].set == contacts[c].set &&
                     contacts[next].point == contacts[c].point;)
        ++next;
      auto &body = *std::next(points.bodies.begin(), contacts[c].set);
      if (body.points.layout().touch < 0)
        continue;
      const auto touch =
        touch_of(contacts.data() + c,
                 contacts.data() + next,
                 std::min(0.5, body.radius_factor),
                 contact::LocalSearch<dim>::least_band * radii[contacts[c].set][contacts[c].point]);
      if (touch.norm() == 0)
        continue;
      body.points.set_touch(contacts[c].point, touch);
      body.points.touched.push_back(contacts[c].point);
    }
}

template <int dim>
void
ContactCoupling<dim>::octree_changed(const MaterialPointSystem<dim> &points)
{
  on_grid.octree_changed();
  in_leaves.reinit(points.octree.n_owned_leaves());
}

template <int dim>
void
ContactCoupling<dim>::structure_changed(StructureSystem<dim> &structure)
{
  surface_nodes.structure_changed(structure);
  system.surface_changed();
}

template <int dim>
void
ContactCoupling<dim>::structure_shared_out(StructureSystem<dim> &structure)
{
  surface_nodes.shared_out(structure);
  // Keys are the same, so that impulses to start from are found where their points have stayed.
  system.points_renumbered();
}

template <int dim>
template <typename Action>
void
ContactCoupling<dim>::for_each_node(const MaterialPointSystem<dim> &points,
                                    const unsigned int              set,
                                    const unsigned int              row,
                                    const Action                   &action) const
{
  const auto &body   = *std::next(points.bodies.begin(), set);
  const auto &octree = points.octree;
  const auto &cuts   = body.points.cuts;
  if (cuts.contains(row))
    {
      const unsigned int i = cuts.find(row);
      for (std::size_t e = cuts.begin[i]; e < cuts.begin[i + 1]; ++e)
        action(cuts.entries[e].node, cuts.entries[e].value);
      return;
    }
  const double half = body.margin_of_shape() * body.points.column(Layout<dim>::size)[row];
  for_each_piece(octree,
                 body.points.position(row),
                 half,
                 [&](const int leaf, const dealii::Point<dim> &piece, const double fraction) {
                   const CornerShape<dim> shape(unit_coordinates(octree, leaf, piece));
                   for (int c = 0; c < (1 << dim); ++c)
                     {
                       const unsigned int node    = octree.nodes(leaf)[c];
                       const double       weight  = fraction * shape.value[c];
                       const int          hanging = octree.hanging_index(node);
                       if (hanging < 0)
                         action(node, weight);
                       else
                         for (const auto &[parent, share] : octree.hanging_nodes()[hanging].parents)
                           action(parent, share * weight);
                     }
                 });
}

template <int dim>
void
ContactCoupling<dim>::solve(MaterialPointSystem<dim> &points,
                            StructureSystem<dim>     &structure,
                            const double              dt)
{
  // Surfaces have the last word: nothing passes them.
  if (on_grid.is_used())
    solve_on_grid(points, structure);
  if (method == contact::Method::surface)
    solve_on_surface(points, structure, dt);
  if (on_grid.is_used())
    {
      const unsigned long n_facets =
        (method == contact::Method::surface ? system.report().n_contacts : 0);
      report_with_grid            = system.report();
      report_with_grid.n_contacts = on_grid.n_contacts() + n_facets;
    }
}

template <int dim>
void
ContactCoupling<dim>::solve_on_grid(MaterialPointSystem<dim> &points,
                                    StructureSystem<dim>     &structure)
{
  on_grid.solve(points, structure);
  received.resize(points.bodies.size());
  for (unsigned int b = 0; b < received.size(); ++b)
    received[b] += on_grid.received()[b];
}

template <int dim>
void
ContactCoupling<dim>::solve_on_surface(MaterialPointSystem<dim> &points,
                                       StructureSystem<dim>     &structure,
                                       const double              dt)
{
  const unsigned int             n_nodes = points.split.n_records();
  std::vector<NodalField<dim> *> fields;
  for (auto &field : points.fields)
    fields.push_back(&field);
  std::vector<unsigned int> field_of_set;
  for (const auto &body : points.bodies)
    field_of_set.push_back(body.field);

  system.build_rows(
    [&](const unsigned int set, const unsigned int row, auto &entries) {
      for_each_node(points, set, row, [&](const unsigned int node, const double weight) {
        entries.push_back({field_of_set[set] * n_nodes + node, weight});
      });
    },
    [&](const unsigned int number) {
      const unsigned int    field = number / n_nodes, node = number % n_nodes;
      contact::Unknown<dim> unknown;
      unknown.velocity     = fields[field]->velocity(node);
      unknown.inverse_mass = fields[field]->inverse_mass(node);
      unknown.key = first_grid_key + (std::uint64_t(field) << field_shift) + points.split.key(node);
      unknown.owner = points.octree.node_owner(points.split.node(node));
      return unknown;
    });
  system.solve(structure.rigid_unknowns(), dt);
  in_leaves.begin_step(dt);
  if (system.report().n_contacts == 0)
    return;
  received.resize(points.bodies.size());
  RankSums given(dim * received.size(), reproducible);
  for (unsigned int c = 0; c < system.contacts().size(); ++c)
    if (const auto &contact = system.contacts()[c]; contact.set < received.size())
      {
        const auto &impulse = system.impulses().impulse[c];
        for (int d = 0; d < dim; ++d)
          given.add(dim * contact.set + d, impulse[d]);
        const auto &body = *std::next(points.bodies.begin(), contact.set);
        in_leaves.add(points.octree.find(body.points.position(contact.point)), impulse.norm());
      }

  const auto share = given.share(comm);
  for (unsigned int i = 0; i < share.size(); ++i)
    received[i / dim][i % dim] += share[i];

  system.point_impulses([&](const unsigned int number, const auto &p, const auto &c) {
    fields[number / n_nodes]->add_impulse(number % n_nodes, p, c);
  });
  points.apply_impulses();

  const std::size_t n_surface_nodes = structure.publish_surface().nodes.size();
  impulse.assign(n_surface_nodes, dealii::Tensor<1, dim>());
  correction.assign(n_surface_nodes, dealii::Tensor<1, dim>());
  system.surface_impulses(impulse, correction);
  structure.apply_contact(impulse, correction, system.rigid_impulses());
}

template <int dim>
void
ContactCoupling<dim>::resolve_in_time(MaterialPointSystem<dim> &points,
                                      StructureSystem<dim>     &structure)
{
  typename contact::ContinuousCheck<dim>::Ends ends(sets.size());
  unsigned int                                 s = 0;
  for (auto &body : points.bodies)
    {
      for (int d = 0; d < dim; ++d)
        ends[s][d] = body.points.column(Layout<dim>::next_position + d);
      ++s;
    }
  system.resolve_in_time(structure.publish_surface(), sets, ends, [&](const auto &changes) {
    const bool any = structure.change_ends(changes);
    structure.publish_surface();
    return any;
  });
}

template <int dim>
void
ContactCoupling<dim>::audit(const MaterialPointSystem<dim> &points, StructureSystem<dim> &structure)
{
  // The sets as they were searched, at the places the particles are about to take.
  unsigned int s = 0;
  for (const auto &body : points.bodies)
    {
      for (int d = 0; d < dim; ++d)
        sets[s].position[d] = body.points.column(Layout<dim>::next_position + d);
      ++s;
    }
  const auto &surface = structure.publish_surface();
  surface_nodes.fill(surface, sets.begin() + s);
  penetrations += system.audit(surface, sets);
}

template <int dim>
void
ContactCoupling<dim>::serialize(Archive &archive, MaterialPointSystem<dim> &points)
{
  surface_nodes.serialize(archive);
  system.serialize(archive);
  archive.share("contact_momentum_of_points", received);
  archive.same("penetrations", penetrations);
  {
    const Archive::Section part(archive, "report_with_grid");
    report_with_grid.serialize(archive);
  }
  {
    const Archive::Section part(archive, "leaf_contacts");
    in_leaves.serialize(archive, points.octree.n_owned_leaves());
  }
  // What is known of points since they were numbered has not changed since.
  if (archive.loads())
    make_point_sets(points, true);
}

template class ContactCoupling<2>;
template class ContactCoupling<3>;
} // namespace coracle
