// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/grid/grid_tools.h>

#include <coracle/base/mpi.h>
#include <coracle/coupling/structure_on_grid.h>
#include <coracle/grid/corner_shape.h>
#include <coracle/grid/pieces.h>

#include <numeric>

namespace coracle
{
namespace
{
/// Calls action(body, number) for all bodies, solids first.
template <int dim, typename Action>
void
for_each_body(StructureSystem<dim> &structure, const Action &action)
{
  unsigned int i = 0;
  for (auto &body : structure.solids)
    action(body, i++);
  for (auto &body : structure.rigids)
    action(body, i++);
}

template <int dim>
std::vector<double>
lumped_mass(const SolidBody<dim> &body)
{
  const double *const mass = body.nodes()[NodeColumns<dim>::mass];
  return std::vector<double>(mass, mass + body.mesh().n_owned_nodes());
}

/// Size of a facet of a sheet: length, or area of the quadrilateral seen along its normal.
inline double
measure(const std::array<dealii::Point<2>, 2> &x)
{
  return x[0].distance(x[1]);
}

inline double
measure(const std::array<dealii::Point<3>, 4> &x)
{
  return 0.5 * dealii::cross_product_3d(x[2] - x[0], x[3] - x[1]).norm();
}

/// Volumes of elements, or sizes of a sheet's facets, handed out evenly to their nodes.
template <int dim>
std::vector<double>
shares_of_nodes(const BodyMesh<dim> &mesh)
{
  std::vector<double> share(mesh.n_nodes());
  if (mesh.n_sheets() > 0)
    for (const auto &facet : mesh.facets)
      {
        std::array<dealii::Point<dim>, BoundaryFacet<dim>::n_nodes> x;
        for (unsigned int v = 0; v < x.size(); ++v)
          x[v] = mesh.nodes[facet.nodes[v]];
        for (const unsigned int node : facet.nodes)
          share[node] += measure(x) / x.size();
      }
  else
    for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
      {
        const dealii::ArrayView<const unsigned int> corners(mesh.cells() + (cell << dim), 1 << dim);
        for (const unsigned int node : corners)
          share[node] += dealii::GridTools::cell_measure<dim>(mesh.nodes, corners) / corners.size();
      }
  return share;
}

/// Shares of the body's mass; a hanging node keeps its own, because all nodes move alike.
template <int dim>
std::vector<double>
lumped_mass(const RigidBody<dim> &body)
{
  const auto               &mesh  = body.mesh();
  const std::vector<double> share = shares_of_nodes(mesh);
  const double sum = mpi::sum(std::accumulate(share.begin(), share.end(), 0.), mesh.communicator());
  Columns      mass(1);
  mass.resize(share.size());
  for (unsigned int node = 0; node < share.size(); ++node)
    mass[0][node] = share[node] / sum * body.mass();
  mesh.exchange.sum_to_owners(mass, 0, 1);
  return std::vector<double>(mass[0], mass[0] + mesh.n_owned_nodes());
}

/// Which directions are free at a node, as 1 or 0.
template <int dim>
dealii::Tensor<1, dim>
freedom(const SolidBody<dim> &body, const unsigned int node)
{
  dealii::Tensor<1, dim> result = body.inverse_mass(node);
  for (int d = 0; d < dim; ++d)
    result[d] = result[d] > 0;
  return result;
}

template <int dim>
dealii::Tensor<1, dim>
freedom(const RigidBody<dim> &body, const unsigned int)
{
  dealii::Tensor<1, dim> result = body.body_inverse_mass();
  for (int d = 0; d < dim; ++d)
    result[d] = result[d] > 0;
  return result;
}
} // namespace

template <int dim>
StructureOnGrid<dim>::StructureOnGrid(StructureSystem<dim> &structure,
                                      const Octree<dim>    &octree,
                                      MPI_Comm              comm)
  : octree(octree), comm(comm)
{
  octree_changed();
  for_each_body(structure, [this](auto &body, const unsigned int) {
    node_mass.push_back(lumped_mass(body));
    frictions.push_back(body.friction());
    radii.push_back(0.5 * body.thickness());
    impulses.emplace_back(node_mass.back().size());
  });
  for (auto &body : structure.solids)
    body.contact_through_volume();
}

template <int dim>
void
StructureOnGrid<dim>::octree_changed()
{
  regions = dealii::Utilities::MPI::all_gather(comm, octree.owned_region());
}

template <int dim>
void
StructureOnGrid<dim>::invite(StructureSystem<dim>                          &structure,
                             const std::function<bool(const unsigned int)> &is_near)
{
  const int me = mpi::rank(comm);
  visitors.clear();
  std::map<unsigned int, std::vector<Visitor>> abroad;
  const auto                                   admit = [&](Visitor visitor) {
    visitor.leaf = octree.find(visitor.position);
    if (visitor.leaf >= 0 && octree.owner(visitor.leaf) == me && is_near(visitor.leaf))
      visitors.push_back(visitor);
  };
  for_each_body(structure, [&](const auto &body, const unsigned int index) {
    for (unsigned int node = 0; node < node_mass[index].size(); ++node)
      if (const double mass = node_mass[index][node]; mass > 0)
        {
          const Visitor visitor{index,
                                node,
                                me,
                                -1,
                                mass,
                                body.position(node),
                                body.velocity(node),
                                mass * freedom(body, node)};
          for (unsigned int rank = 0; rank < regions.size(); ++rank)
            if (regions[rank].point_inside(visitor.position))
              {
                if (static_cast<int>(rank) == me)
                  admit(visitor);
                else
                  abroad[rank].push_back(visitor);
              }
        }
  });
  if (regions.size() > 1)
    for (const auto &[rank, arrivals] : mpi::exchange_values(abroad, comm))
      for (const Visitor &visitor : arrivals)
        admit(visitor);
}

template <int dim>
void
StructureOnGrid<dim>::give(StructureSystem<dim>                          &structure,
                           const std::function<bool(const unsigned int)> &is_near,
                           std::vector<GridParticipant<dim>>             &bodies)
{
  using Motion  = typename GridParticipant<dim>::Motion;
  using Contact = typename GridParticipant<dim>::Contact;
  invite(structure, is_near);
  for (auto &body : bodies)
    {
      std::fill(body.motion.begin(), body.motion.end(), NodeRecord());
      std::fill(body.contact.begin(), body.contact.end(), NodeRecord());
    }
  // Until they are summed the records hold momentum and the mass that is free to move.
  for (const Visitor &visitor : visitors)
    {
      auto                  &body = bodies[visitor.body];
      const CornerShape<dim> shape(unit_coordinates(octree, visitor.leaf, visitor.position));
      for (unsigned int c = 0; c < octree.n_corners; ++c)
        for_each_conforming_node(octree,
                                 octree.nodes(visitor.leaf)[c],
                                 1.,
                                 [&](const unsigned int node, const double share) {
                                   const double weight = share * shape.value[c];
                                   body.motion[node][Motion::mass] += weight * visitor.mass;
                                   for (int d = 0; d < dim; ++d)
                                     {
                                       body.motion[node][Motion::velocity + d] +=
                                         weight * visitor.mass * visitor.velocity[d];
                                       body.motion[node][Motion::inverse_mass + d] +=
                                         weight * visitor.mobile_mass[d];
                                       body.contact[node][Contact::gradient + d] +=
                                         share * shape.gradient[d][c] * visitor.mass /
                                         octree.size(visitor.leaf);
                                     }
                                 });
    }
  for (auto &body : bodies)
    {
      octree.exchange.sum_to_owners(body.motion);
      octree.exchange.sum_to_owners(body.contact);
      for (unsigned int node = 0; node < octree.n_owned_nodes(); ++node)
        if (const double mass = body.mass(node); mass > 0)
          for (int d = 0; d < dim; ++d)
            {
              body.motion[node][Motion::velocity + d] /= mass;
              body.motion[node][Motion::inverse_mass + d] /= mass * mass;
            }
      octree.exchange.update_ghosts(body.motion);
      octree.exchange.update_ghosts(body.contact);
    }
}

/// An impulse at a grid node goes to the nodes that gave it mass, by what they gave.
template <int dim>
dealii::Tensor<1, dim>
StructureOnGrid<dim>::impulse_of(const Visitor &visitor, const GridParticipant<dim> &body) const
{
  const CornerShape<dim> shape(unit_coordinates(octree, visitor.leaf, visitor.position));
  Vector                 sum;
  for (unsigned int c = 0; c < octree.n_corners; ++c)
    for_each_conforming_node(octree,
                             octree.nodes(visitor.leaf)[c],
                             shape.value[c],
                             [&](const unsigned int node, const double weight) {
                               if (body.mass(node) > 0)
                                 sum +=
                                   (weight * visitor.mass / body.mass(node)) * body.impulse(node);
                             });
  return sum;
}

template <int dim>
void
StructureOnGrid<dim>::take_back(const std::vector<GridParticipant<dim>> &bodies,
                                StructureSystem<dim>                    &structure)
{
  const int me = mpi::rank(comm);
  for (auto &body : impulses)
    std::fill(body.begin(), body.end(), Vector());
  std::map<unsigned int, std::vector<Impulse>> abroad;
  for (const Visitor &visitor : visitors)
    if (const Vector value = impulse_of(visitor, bodies[visitor.body]); value.norm_square() > 0)
      {
        if (visitor.home == me)
          impulses[visitor.body][visitor.node] += value;
        else
          abroad[visitor.home].push_back({visitor.body, visitor.node, value});
      }
  if (regions.size() > 1)
    for (const auto &[rank, arrivals] : mpi::exchange_values(abroad, comm))
      for (const Impulse &impulse : arrivals)
        impulses[impulse.body][impulse.node] += impulse.value;
  structure.apply_node_impulses(impulses);
}

template class StructureOnGrid<2>;
template class StructureOnGrid<3>;
} // namespace coracle
