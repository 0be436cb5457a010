// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/grid_contact.h>
#include <coracle/grid/corner_shape.h>
#include <coracle/grid/pieces.h>

namespace coracle
{
namespace
{
/// Weights below this are round-off of a point on the face of a cell.
constexpr double no_weight = 1e-12;
/// A gradient shorter than this share of mass over cell size has no direction.
constexpr double no_gradient = 1e-9;
/// Farther than any point.
constexpr double far_away = 1e300;
} // namespace

template <int dim>
GridContact<dim>::GridContact(const Options            &options,
                              MaterialPointSystem<dim> &points,
                              StructureSystem<dim>     &structure,
                              MPI_Comm                  comm)
  : octree(points.octree), comm(comm), momenta(points.bodies.size())
{
  const unsigned int n_fields = points.fields.size();
  if (options.between_fields)
    for (unsigned int r = 0; r < n_fields; ++r)
      for (unsigned int s = r + 1; s < n_fields; ++s)
        pairs.push_back({r, s, options.friction_between_fields});
  if (options.with_structures && !structure.empty())
    {
      structures = std::make_unique<StructureOnGrid<dim>>(structure, octree, comm);
      for (unsigned int b = 0; b < structures->n_bodies(); ++b)
        for (unsigned int s = 0; s < n_fields; ++s)
          pairs.push_back({n_fields + b, s, structures->friction(b)});
    }
  make_participants(n_fields);
}

template <int dim>
void
GridContact<dim>::octree_changed()
{
  if (structures)
    structures->octree_changed();
  make_participants(fields.size());
}

template <int dim>
void
GridContact<dim>::make_participants(const unsigned int n_fields)
{
  if (pairs.empty())
    return;
  const unsigned int n_nodes = octree.n_nodes();
  cell_size                  = octree.smallest_cell_size();
  fields.assign(n_fields, GridParticipant<dim>(n_nodes));
  bodies.assign(structures ? structures->n_bodies() : 0, GridParticipant<dim>(n_nodes));
  is_shared.resize(n_nodes);
  is_met.resize(n_nodes);
  normals.resize(n_nodes);
  leaf_reaches.resize(octree.n_leaves());
  leaf_is_near.resize(octree.n_leaves());
  const auto &indices = octree.exchange.indices();
  nearest_of_s.reinit(indices.locally_owned_range(), indices.ghost_indices(), comm);
  nearest_of_r.reinit(nearest_of_s);
}

template <int dim>
void
GridContact<dim>::read_fields(MaterialPointSystem<dim> &points)
{
  using Motion = typename GridParticipant<dim>::Motion;
  auto field   = points.fields.begin();
  for (auto &participant : fields)
    {
      for (unsigned int node = 0; node < octree.n_nodes(); ++node)
        {
          NodeRecord &record        = participant.motion[node];
          record                    = NodeRecord();
          participant.contact[node] = NodeRecord();
          const double mass         = field->motion()[node][NodalField<dim>::Motion::mass];
          if (mass <= 0 || octree.hanging_index(node) >= 0)
            continue;
          const Vector velocity = field->velocity(node), inverse_mass = field->inverse_mass(node);
          record[Motion::mass] = mass;
          for (int d = 0; d < dim; ++d)
            {
              record[Motion::velocity + d]     = velocity[d];
              record[Motion::inverse_mass + d] = inverse_mass[d];
            }
        }
      ++field;
    }
}

template <int dim>
bool
GridContact<dim>::mark_nodes()
{
  std::fill(is_shared.begin(), is_shared.end(), 0);
  bool       any  = false;
  const auto side = [this](const unsigned int i) -> const GridParticipant<dim> & {
    return i < fields.size() ? fields[i] : bodies[i - fields.size()];
  };
  for (const Pair &pair : pairs)
    {
      const auto &r = side(pair.r), &s = side(pair.s);
      for (unsigned int node = 0; node < octree.n_nodes(); ++node)
        if (r.mass(node) > 0 && s.mass(node) > 0)
          is_shared[node] = any = true;
    }
  return mpi::any(any, comm);
}

template <int dim>
template <typename Action>
void
GridContact<dim>::for_each_marked_node(const unsigned int leaf, const Action &action) const
{
  for (const unsigned int corner : octree.nodes(leaf))
    for_each_conforming_node(octree, corner, 1., [&](const unsigned int node, const double) {
      if (is_shared[node])
        action(node);
    });
}

// A particle with a box may lie in a neighbour of the leaf that reaches a node.
template <int dim>
void
GridContact<dim>::mark_leaves()
{
  std::fill(leaf_reaches.begin(), leaf_reaches.end(), 0);
  std::fill(is_met.begin(), is_met.end(), 0);
  for (unsigned int leaf = 0; leaf < octree.n_leaves(); ++leaf)
    {
      for_each_marked_node(leaf, [&](const unsigned int) { leaf_reaches[leaf] = 1; });
      if (leaf_reaches[leaf])
        for (const unsigned int corner : octree.nodes(leaf))
          for_each_conforming_node(octree, corner, 1., [&](const unsigned int node, const double) {
            is_met[node] = 1;
          });
    }
  for (unsigned int leaf = 0; leaf < octree.n_leaves(); ++leaf)
    {
      leaf_is_near[leaf] = 0;
      for (const unsigned int corner : octree.nodes(leaf))
        for_each_conforming_node(octree, corner, 1., [&](const unsigned int node, const double) {
          leaf_is_near[leaf] |= is_met[node];
        });
    }
}

template <int dim>
template <typename Action>
void
GridContact<dim>::for_each_piece_near(const MaterialPointBody<dim> &body,
                                      const Action                 &action) const
{
  const auto &points = body.points;
  const auto  visit  = [&](const unsigned int row) {
    if (points.is_hole(row))
      return;
    const double half = body.margin_of_shape() * points.column(ParticleLayout<dim>::size)[row];
    for_each_piece(octree,
                   points.position(row),
                   half,
                   [&](const int leaf, const dealii::Point<dim> &place, const double fraction) {
                     if (leaf_reaches[leaf])
                       action(row, leaf, place, fraction);
                   });
  };
  std::vector<unsigned int> strays;
  for (const auto &stray : points.strays)
    strays.push_back(stray.row);
  std::sort(strays.begin(), strays.end());
  for (const unsigned int cell : points.occupied_cells())
    if (leaf_is_near[cell])
      for (unsigned int row = points.cell_begin()[cell]; row < points.cell_begin()[cell + 1]; ++row)
        if (!std::binary_search(strays.begin(), strays.end(), row))
          visit(row);
  for (const unsigned int row : strays)
    visit(row);
}

template <int dim>
template <typename Action>
void
GridContact<dim>::for_each_point(const MaterialPointSystem<dim> &points,
                                 const unsigned int              participant,
                                 const Action                   &action) const
{
  if (participant >= fields.size())
    {
      const unsigned int body = participant - fields.size();
      structures->for_each_node(body, [&](const dealii::Point<dim> &position, const int leaf) {
        if (leaf_reaches[leaf])
          action(position, structures->radius(body), leaf, position);
      });
      return;
    }
  for (const auto &body : points.bodies)
    if (body.field == participant)
      for_each_piece_near(
        body,
        [&](const unsigned int row, const int leaf, const dealii::Point<dim> &place, const double) {
          action(body.points.position(row),
                 body.radius_factor * body.points.column(ParticleLayout<dim>::size)[row],
                 leaf,
                 place);
        });
}

// Eq. 23 for the velocity fields; structures gave theirs with their mass.
template <int dim>
void
GridContact<dim>::find_gradients(MaterialPointSystem<dim> &points)
{
  using Contact = typename GridParticipant<dim>::Contact;
  for (const auto &body : points.bodies)
    {
      const double *const mass    = body.points.column(ParticleLayout<dim>::mass);
      auto               &records = fields[body.field].contact;
      for_each_piece_near(body,
                          [&](const unsigned int        row,
                              const int                 leaf,
                              const dealii::Point<dim> &place,
                              const double              fraction) {
                            const CornerShape<dim> shape(unit_coordinates(octree, leaf, place));
                            const double           m = fraction * mass[row] / octree.size(leaf);
                            for (unsigned int c = 0; c < octree.n_corners; ++c)
                              for_each_conforming_node(octree,
                                                       octree.nodes(leaf)[c],
                                                       m,
                                                       [&](const unsigned int node,
                                                           const double       weight) {
                                                         for (int d = 0; d < dim; ++d)
                                                           records[node][Contact::gradient + d] +=
                                                             weight * shape.gradient[d][c];
                                                       });
                          });
    }
  for (auto &field : fields)
    {
      octree.exchange.sum_to_owners(field.contact);
      octree.exchange.update_ghosts(field.contact);
    }
}

template <int dim>
bool
GridContact<dim>::find_normals(const Pair &pair)
{
  const auto &r   = pair.r < fields.size() ? fields[pair.r] : bodies[pair.r - fields.size()];
  const auto &s   = fields[pair.s];
  bool        any = false;
  std::fill(is_met.begin(), is_met.end(), 0);
  for (unsigned int node = 0; node < octree.n_nodes(); ++node)
    if (is_shared[node] && r.mass(node) > 0 && s.mass(node) > 0)
      {
        const auto direction = [&](const GridParticipant<dim> &body) {
          const Vector gradient = body.gradient(node);
          const double length   = gradient.norm();
          return length * cell_size > no_gradient * body.mass(node) ? gradient / length : Vector();
        };
        const Vector difference = direction(r) - direction(s);
        const double length     = difference.norm();
        if (length > no_gradient)
          {
            is_met[node] = any               = true;
            normals[node]                    = difference / length;
            nearest_of_s.local_element(node) = nearest_of_r.local_element(node) = far_away;
          }
      }
  return mpi::any(any, comm);
}

// Along the normal from the node: how far s reaches towards r, and r towards s (as its negative),
// so that both are smallest values, also over ranks.
template <int dim>
void
GridContact<dim>::find_distances(const MaterialPointSystem<dim> &points, const Pair &pair)
{
  for (const bool is_s : {false, true})
    for_each_point(points,
                   is_s ? pair.s : pair.r,
                   [&](const dealii::Point<dim> &position,
                       const double              radius,
                       const int                 leaf,
                       const dealii::Point<dim> &place) {
                     const CornerShape<dim> shape(unit_coordinates(octree, leaf, place));
                     for (unsigned int c = 0; c < octree.n_corners; ++c)
                       for_each_conforming_node(
                         octree,
                         octree.nodes(leaf)[c],
                         shape.value[c],
                         [&](const unsigned int node, const double weight) {
                           if (!is_met[node] || weight < no_weight)
                             return;
                           const double along = (position - octree.position(node)) * normals[node];
                           double      &nearest =
                             (is_s ? nearest_of_s : nearest_of_r).local_element(node);
                           nearest = std::min(nearest, (is_s ? along : -along) - radius);
                         });
                   });
  nearest_of_s.compress(dealii::VectorOperation::min);
  nearest_of_r.compress(dealii::VectorOperation::min);
}

template <int dim>
void
GridContact<dim>::solve_pair(const MaterialPointSystem<dim> &points, const Pair &pair)
{
  if (!find_normals(pair))
    return;
  find_distances(points, pair);
  auto &r = pair.r < fields.size() ? fields[pair.r] : bodies[pair.r - fields.size()];
  auto &s = fields[pair.s];
  for (unsigned int node = 0; node < octree.n_owned_nodes(); ++node)
    if (is_met[node] && nearest_of_s.local_element(node) + nearest_of_r.local_element(node) <= 0)
      {
        const Vector impulse =
          grid_contact_impulse(r.side(node), s.side(node), normals[node], pair.friction);
        if (impulse.norm_square() > 0)
          {
            r.add_impulse(node, -impulse);
            s.add_impulse(node, impulse);
            ++contacts;
          }
      }
}

// What the particles of a body take of the impulses at the nodes they gave mass to.
template <int dim>
void
GridContact<dim>::add_up_momenta(const MaterialPointSystem<dim> &points)
{
  unsigned int b = 0;
  for (const auto &body : points.bodies)
    {
      const auto         &field = fields[body.field];
      const double *const mass  = body.points.column(ParticleLayout<dim>::mass);
      for_each_piece_near(body,
                          [&](const unsigned int        row,
                              const int                 leaf,
                              const dealii::Point<dim> &place,
                              const double              fraction) {
                            const CornerShape<dim> shape(unit_coordinates(octree, leaf, place));
                            for (unsigned int c = 0; c < octree.n_corners; ++c)
                              for_each_conforming_node(octree,
                                                       octree.nodes(leaf)[c],
                                                       fraction * mass[row] * shape.value[c],
                                                       [&](const unsigned int node,
                                                           const double       m) {
                                                         if (field.mass(node) > 0)
                                                           momenta[b] += (m / field.mass(node)) *
                                                                         field.impulse(node);
                                                       });
                          });
      ++b;
    }
}

template <int dim>
void
GridContact<dim>::solve(MaterialPointSystem<dim> &points, StructureSystem<dim> &structure)
{
  contacts = 0;
  std::fill(momenta.begin(), momenta.end(), Vector());
  read_fields(points);
  if (structures)
    structures->give(
      structure,
      [&](const unsigned int leaf) {
        bool near = false;
        for (const unsigned int corner : octree.nodes(leaf))
          for_each_conforming_node(octree, corner, 1., [&](const unsigned int node, const double) {
            for (const auto &field : fields)
              near = near || field.mass(node) > 0;
          });
        return near;
      },
      bodies);
  if (!mark_nodes())
    return;
  mark_leaves();
  find_gradients(points);
  for (const Pair &pair : pairs)
    solve_pair(points, pair);
  contacts = mpi::sum(contacts, comm);
  if (contacts == 0)
    return;

  auto field = points.fields.begin();
  for (auto &participant : fields)
    {
      for (unsigned int node = 0; node < octree.n_owned_nodes(); ++node)
        if (const Vector impulse = participant.impulse(node); impulse.norm_square() > 0)
          field->add_impulse(node, impulse, Vector());
      octree.exchange.update_ghosts(participant.contact);
      ++field;
    }
  points.apply_impulses();
  add_up_momenta(points);
  for (auto &body : bodies)
    octree.exchange.update_ghosts(body.contact);
  if (structures)
    structures->take_back(bodies, structure);
}

template class GridContact<2>;
template class GridContact<3>;
} // namespace coracle
