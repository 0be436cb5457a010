// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/structure/solid_body.h>

#include <numeric>
#include <type_traits>
#include <vector>

namespace coracle
{
template <int dim>
void
SolidBody<dim>::declare(Declaration &section)
{
  StructureMesh<dim>::declare(section.section("Mesh", "Elements and nodes of the body"));
  SolidBody::declare_surface(section);
  section.text("Material", "", "name of a subsection of Materials");
  section.choice(
    "Integration",
    "full",
    {"full", "one point"},
    "full: 2^dim points with averaged volume change (F-bar), does not lock; one point: "
    "several times faster, with hourglass control");
  section.when("Integration", "one point")
    .quantity("Hourglass coefficient",
              "0.1",
              "1",
              "kappa",
              "stiffness against modes that one point does not see, over the shear modulus; 1 is "
              "about full integration and best for elastic bending",
              0.,
              1.);
  section.flag("Self contact",
               false,
               "May the body's surface touch itself? Its nodes then meet its own facets at the "
               "distance Thickness");
  BoundaryConditions<dim>::declare(section);
  Loads<dim>::declare(section);
  Declaration &damping = section.section("Damping", "Force -alpha m v, to find states of rest");
  damping.quantity("Coefficient", "0", "1/s", "alpha", "0 is without damping", 0.);
  damping.quantity("Start", "0", "s", "", "no damping before");
  damping.quantity("End", "1e300", "s", "", "no damping after");
}

template <int dim>
SolidBody<dim>::SolidBody(const Parameters      &body,
                          const MaterialLibrary &materials,
                          const Vector          &gravity,
                          MPI_Comm               comm,
                          const bool             reproducible)
  : StructuralBody<dim>(body, std::make_unique<StructureMesh<dim>>(body.section("Mesh"), comm))
  , section(body)
  , touches_itself(body.flag("Self contact"))
  , reproducible(reproducible)
  , elements(mesh(),
             materials.get(body.text("Material"), body),
             body.choice("Integration") == "full" ? Integration::full : Integration::one_point,
             body.choice("Integration") == "full" ? 0. : body.quantity("Hourglass coefficient"))
  , boundary_conditions(body, mesh())
  , loads(body, mesh())
  , gravity(gravity)
  , damping(body.section("Damping").quantity("Coefficient"))
  , damping_start(body.section("Damping").quantity("Start"))
  , damping_end(body.section("Damping").quantity("End"))
{
  if (reproducible)
    elements.make_reproducible(comm);
  set_mass();
  const Vector initial_velocity = body.template point<dim>("Initial velocity");
  for (unsigned int n = 0; n < mesh().n_nodes(); ++n)
    this->set_vector(Node::velocity, n, initial_velocity);
  find_contact_nodes();
  // No displacement yet: finds bad elements and the first stable step, on all ranks alike.
  mpi::agree([&] { update_stress(1.); }, comm);
}

template <int dim>
SumGrid
SolidBody<dim>::sum_grid(const double largest_here) const
{
  // A node has elements around it and around nodes that hang on it, with weights like 1/4.
  constexpr int bits = 10;
  return reproducible ? SumGrid(mpi::max(largest_here, mesh().communicator()), bits) : SumGrid();
}

template <int dim>
void
SolidBody<dim>::round(const unsigned int first, const unsigned int n_columns)
{
  if (!reproducible || !mpi::any(!mesh().hanging_nodes.empty(), mesh().communicator()))
    return;
  Columns &nodes   = this->node_columns;
  double   largest = 0;
  for (unsigned int c = first; c < first + n_columns; ++c)
    for (unsigned int n = 0; n < nodes.size(); ++n)
      largest = std::max(largest, std::abs(nodes[c][n]));
  const SumGrid grid = sum_grid(largest);
  for (unsigned int c = first; c < first + n_columns; ++c)
    for (unsigned int n = 0; n < nodes.size(); ++n)
      nodes[c][n] = grid.round(nodes[c][n]);
}

template <int dim>
void
SolidBody<dim>::set_mass()
{
  Columns &nodes = this->node_columns;
  std::fill_n(nodes[Node::mass], nodes.size(), 0.);
  elements.add_mass(nodes[Node::mass], mesh(), sum_grid(elements.largest_mass()));
  condense(Node::mass, 1);
  mesh().exchange.sum_to_owners(nodes, Node::mass, 1);
  mesh().exchange.update_ghosts(nodes, Node::mass, 1);
  for (unsigned int n = 0; n < mesh().n_nodes(); ++n)
    for (int d = 0; d < dim; ++d)
      nodes[Node::inverse_mass + d][n] = nodes[Node::mass][n] > 0 ? 1. / nodes[Node::mass][n] : 0.;
  boundary_conditions.constrain(nodes);
  mesh().exchange.update_ghosts(nodes, Node::inverse_mass, dim);
  // What contact feels at a hanging node: its parents, moved together by their weights.
  for (const HangingNode &hanging : mesh().hanging_nodes)
    for (int d = 0; d < dim; ++d)
      {
        double &inverse = nodes[Node::inverse_mass + d][hanging.node] = 0;
        for (const auto &[parent, weight] : hanging.parents)
          inverse += weight * weight * nodes[Node::inverse_mass + d][parent];
      }
}

template <int dim>
void
SolidBody<dim>::find_contact_nodes()
{
  // A rank may own a node of the surface without owning a facet of it; the column is free yet.
  Columns &nodes = this->node_columns;
  contact_nodes.clear();
  for (const unsigned int n : this->surface_nodes())
    nodes[Node::impulse][n] = 1;
  condense(Node::impulse, 1);
  mesh().exchange.sum_to_owners(nodes, Node::impulse, 1);
  for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
    if (nodes[Node::impulse][n] > 0)
      {
        contact_nodes.push_back(n);
        nodes[Node::impulse][n] = 0;
      }
}

template <int dim>
void
SolidBody<dim>::contact_through_volume()
{
  is_met_in_volume = true;
  contact_nodes.resize(this->mesh().n_owned_nodes());
  std::iota(contact_nodes.begin(), contact_nodes.end(), 0u);
}

template <int dim>
void
SolidBody<dim>::condense(const unsigned int first, const unsigned int n_columns)
{
  for (const HangingNode &hanging : mesh().hanging_nodes)
    for (unsigned int c = first; c < first + n_columns; ++c)
      {
        double *const column = this->node_columns[c];
        for (const auto &[parent, weight] : hanging.parents)
          column[parent] += weight * column[hanging.node];
        column[hanging.node] = 0;
      }
}

template <int dim>
void
SolidBody<dim>::distribute(const unsigned int first)
{
  mesh().exchange.update_ghosts(this->node_columns, first, dim);
  for (const HangingNode &hanging : mesh().hanging_nodes)
    for (unsigned int c = first; c < first + dim; ++c)
      {
        double *const column = this->node_columns[c];
        column[hanging.node] = 0;
        for (const auto &[parent, weight] : hanging.parents)
          column[hanging.node] += weight * column[parent];
      }
}

template <int dim>
void
SolidBody<dim>::assemble_forces(const double now)
{
  Columns &nodes = this->node_columns;
  time           = now;
  double largest = 0;
  if (reproducible)
    {
      largest = loads.largest_force(nodes, time);
      for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
        largest = std::max(largest, nodes[Node::mass][n] * gravity.norm());
    }
  const SumGrid grid = sum_grid(largest);
  for (int d = 0; d < dim; ++d)
    {
      double *const external = nodes[Node::external + d];
      std::fill_n(external, nodes.size(), 0.);
      for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
        external[n] = grid.round(nodes[Node::mass][n] * gravity[d]);
    }
  loads.add_forces(nodes, time, grid);
  condense(Node::internal, 2 * dim);
  mesh().exchange.sum_to_owners(nodes, Node::internal, 2 * dim);
}

template <int dim>
double
SolidBody<dim>::damping_at(const double when) const
{
  return when >= damping_start && when <= damping_end ? damping : 0.;
}

template <int dim>
void
SolidBody<dim>::predict_velocities(const double dt)
{
  kick_duration = 0.5 * (last_dt + dt);
  kick(kick_duration, dt);
  last_dt = dt;
  distribute(Node::velocity);
}

template <int dim>
void
SolidBody<dim>::kick(const double duration, const double dt)
{
  Columns            &nodes   = this->node_columns;
  const unsigned int  n_owned = mesh().n_owned_nodes();
  const double        half    = 0.5 * damping_at(time) * duration;
  const double *const mass    = nodes[Node::mass];
  // On the material, of loads and supports, of damping.
  RankSums work(3, reproducible);

  for (int d = 0; d < dim; ++d)
    {
      double *const              v            = nodes[Node::velocity + d];
      const double *const        f_int        = nodes[Node::internal + d],
                          *const f_ext        = nodes[Node::external + d],
                          *const inverse_mass = nodes[Node::inverse_mass + d];
      // Rows from n on, a pack of them or one; prescribed directions keep their velocity here.
      const auto kick_rows = [&](auto *const type, const unsigned int n) {
        using T        = std::remove_pointer_t<decltype(type)>;
        const T before = load<T>(v + n), inverse = load<T>(inverse_mass + n),
                internal = load<T>(f_int + n), external = load<T>(f_ext + n);
        const T free_velocity =
          (before * (1. - half) + duration * inverse * (internal + external)) * (1. / (1. + half));
        const auto is_free = inverse > 0.;
        const T    after   = select(is_free, free_velocity, before);
        store(v + n, after);
        const T mean = select(is_free, T(0.5 * (before + after)), T{});
        work.add(0, -duration * sum(T(internal * mean)));
        work.add(1, duration * sum(T(external * mean)));
        work.add(2, 2. * half * sum(T(load<T>(mass + n) * mean * mean)));
      };
      unsigned int n = 0;
      // Packs hold other nodes on other ranks.
      for (; n + pack_size <= n_owned && !reproducible; n += pack_size)
        kick_rows(static_cast<Pack8 *>(nullptr), n);
      for (; n < n_owned; ++n)
        kick_rows(static_cast<double *>(nullptr), n);
    }
  boundary_conditions.prescribe_velocities(nodes, time, dt, duration, work);
  const auto done = work.share(mesh().communicator());
  books.strain += done[0];
  books.external_work += done[1];
  books.damping += done[2];
}

template <int dim>
void
SolidBody<dim>::add_contact_impulse(const unsigned int node, const Vector &impulse)
{
  this->add_vector(Node::impulse, node, impulse);
}

template <int dim>
void
SolidBody<dim>::apply_contact_impulses()
{
  Columns &nodes = this->node_columns;
  round(Node::impulse, dim);
  condense(Node::impulse, dim);
  mesh().exchange.sum_to_owners(nodes, Node::impulse, dim);
  // On the material, of loads and supports, of contact.
  RankSums sums(3, reproducible);
  for (int d = 0; d < dim; ++d)
    for (const unsigned int n : contact_nodes)
      {
        double      &impulse = nodes[Node::impulse + d][n], &v = nodes[Node::velocity + d][n];
        const double before = v, inverse_mass = nodes[Node::inverse_mass + d][n];
        v += impulse * inverse_mass;
        // Forces and contact act at once, over the same way: from the velocity at the start of the
        // step to that at its end. The kick counted the forces' work without contact.
        const double halfway  = 0.5 * impulse * inverse_mass * kick_duration;
        const double internal = halfway * nodes[Node::internal + d][n],
                     external = halfway * nodes[Node::external + d][n];
        const double work     = impulse * 0.5 * (before + v) - internal - external;
        sums.add(0, -internal);
        sums.add(1, inverse_mass == 0 ? external - work : external);
        sums.add(2, work);
        nodes[Node::contact_force + d][n] = impulse / last_dt;
        impulse                           = 0;
      }
  const auto done = sums.share(mesh().communicator());
  books.strain += done[0];
  books.external_work += done[1];
  books.contact_work += done[2];
  distribute(Node::velocity);
}

template <int dim>
void
SolidBody<dim>::add_correction(const unsigned int node, const Vector &correction)
{
  this->add_vector(Node::correction, node, correction);
}

template <int dim>
void
SolidBody<dim>::apply_corrections()
{
  // From here to `move` the column holds displacements.
  Columns &nodes = this->node_columns;
  round(Node::correction, dim);
  condense(Node::correction, dim);
  mesh().exchange.sum_to_owners(nodes, Node::correction, dim);
  for (int d = 0; d < dim; ++d)
    for (const unsigned int n : contact_nodes)
      nodes[Node::correction + d][n] *= nodes[Node::inverse_mass + d][n];
  distribute(Node::correction);
  is_corrected = true;
}

template <int dim>
void
SolidBody<dim>::move(const double dt)
{
  Columns &nodes = this->node_columns;
  for (int d = 0; d < dim; ++d)
    {
      const double *const v = nodes[Node::velocity + d];
      double *const x = nodes[Node::position + d], *const dx = nodes[Node::increment + d],
                    *const correction = nodes[Node::correction + d];
      if (is_corrected)
        for (unsigned int n = 0; n < nodes.size(); ++n)
          {
            dx[n] = dt * v[n] + correction[n];
            x[n] += dx[n];
            correction[n] = 0;
          }
      else
        for (unsigned int n = 0; n < nodes.size(); ++n)
          {
            dx[n] = dt * v[n];
            x[n] += dx[n];
          }
    }
  is_corrected = false;
}

template <int dim>
void
SolidBody<dim>::update_stress(const double dt)
{
  elements.update(this->node_columns, dt);
}

template <int dim>
Energies
SolidBody<dim>::energies() const
{
  const Columns &nodes = this->node_columns;
  // As in the result.
  RankSums sums(6, reproducible);
  for (int d = 0; d < dim; ++d)
    for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
      sums.add(0,
               0.5 * nodes[Node::mass][n] * nodes[Node::velocity + d][n] *
                 nodes[Node::velocity + d][n]);
  sums.add(1, books.strain);
  elements.add_hourglass_energy(sums, 2);
  sums.add(3, books.damping);
  sums.add(4, books.contact_work);
  sums.add(5, books.external_work);
  const auto all = sums.total(mesh().communicator());
  return {all[0], all[1] - all[2], all[2], all[3], all[4], all[5]};
}

template <int dim>
BodySummary<dim>
SolidBody<dim>::summary() const
{
  // mass, m x, m v, force, moment about the origin
  RankSums rank_sums(1 + 3 * dim + 3, reproducible);
  for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
    {
      const double mass  = this->node_columns[Node::mass][n];
      const Vector force = this->contact_force(n);
      rank_sums.add(0, mass);
      for (int d = 0; d < dim; ++d)
        {
          rank_sums.add(1 + d, mass * this->position(n)[d]);
          rank_sums.add(1 + dim + d, mass * this->velocity(n)[d]);
          rank_sums.add(1 + 2 * dim + d, force[d]);
        }
      const dealii::Tensor<1, 3> moment = moment_of<dim>(this->position(n), force);
      for (int d = 0; d < 3; ++d)
        rank_sums.add(1 + 3 * dim + d, moment[d]);
    }
  const auto sums = rank_sums.total(mesh().communicator());

  BodySummary<dim> result;
  result.mass = sums[0];
  for (int d = 0; d < dim; ++d)
    {
      result.centre[d]        = sums[1 + d] / sums[0];
      result.velocity[d]      = sums[1 + dim + d] / sums[0];
      result.contact_force[d] = sums[1 + 2 * dim + d];
    }
  for (int d = 0; d < 3; ++d)
    result.contact_moment[d] = sums[1 + 3 * dim + d];
  result.contact_moment -= moment_of<dim>(result.centre, result.contact_force);
  return result;
}

template <int dim>
void
SolidBody<dim>::serialize(Archive &archive)
{
  const Archive::Section part(archive, "body " + this->name());
  if (this->serialize_mesh(archive, changing_mesh()))
    make_room();
  this->serialize_nodes(archive, {Node::internal, dim});
  elements.serialize(archive, mesh().element_keys);
  archive.same("time", time);
  archive.same("last_dt", last_dt);
  archive.same("kick_duration", kick_duration);
  books.serialize(archive);
}

template class SolidBody<2>;
template class SolidBody<3>;
} // namespace coracle
