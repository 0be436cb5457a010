// SPDX-License-Identifier: GPL-3.0-or-later
// What the fluid has to do with structures.
#include <coracle/base/mpi.h>
#include <coracle/meshless/fluid.h>

namespace coracle::meshless
{
namespace
{
/// Ids of structure nodes: above those of fluid points, and exact as doubles.
constexpr std::uint64_t first_structure_id = std::uint64_t(1) << 52;
} // namespace

template <int dim>
void
Fluid<dim>::clear_structures()
{
  if (structures.empty())
    return;
  std::vector<dealii::Point<dim>> mine;
  for (const auto &node : structures.nodes)
    mine.push_back(node.position);
  std::vector<dealii::Point<dim>> nodes;
  for (const auto &some : dealii::Utilities::MPI::all_gather(comm, mine))
    nodes.insert(nodes.end(), some.begin(), some.end());
  std::vector<unsigned int> kept;
  for (std::size_t i = 0; i < columns.size(); ++i)
    {
      dealii::Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = columns[Layout::position + d][i];
      // In the plane of a facet, between its nodes, it would have elements inside the body.
      bool goes = structures.contains(x) || structures.is_nearer(x, 0.4999 * options.spacing);
      for (std::size_t k = 0; k < nodes.size() && !goes; ++k)
        goes = x.distance_square(nodes[k]) < std::pow(0.5 * options.spacing, 2);
      if (!goes)
        kept.push_back(i);
    }
  columns.reorder(kept);
  columns.resize(kept.size());
  counts.created = mpi::sum<std::uint64_t>(kept.size(), comm);
}

// Faces of the box where a node of a structure stands: between it and the fluid's points there the
// boundary is wall.
template <int dim>
unsigned char
Fluid<dim>::faces_at(const dealii::Point<dim> &x) const
{
  const auto    corners = options.box.get_boundary_points();
  unsigned char faces   = 0;
  for (unsigned int face = 0; face < 2 * dim; ++face)
    {
      const double place = face % 2 == 0 ? corners.first[face / 2] : corners.second[face / 2];
      if (options.walls[face] != Wall::open &&
          std::fabs(x[face / 2] - place) < 1e-3 * options.spacing)
        faces |= 1u << face;
    }
  return faces;
}

// Rows behind the fluid's own.
template <int dim>
void
Fluid<dim>::add_structure_points()
{
  for (const auto &node : structures.nodes)
    {
      points.position.push_back(node.position);
      points.spacing.push_back(options.spacing);
      points.id.push_back(first_structure_id + node.key);
      points.kind.push_back(PointKind::wall);
      velocity.push_back(node.velocity);
      pressure.push_back(0.);
      walls.push_back(faces_at(node.position));
    }
  points.n_own = n_cloud + structures.nodes.size();
}

// Of structure nodes, all facets of the boundary beside them: they move with the body whatever
// these are, and what was added to the free surface's areas is taken from there.
template <int dim>
void
Fluid<dim>::find_wall_areas()
{
  std::vector<Vector> area(points.size());
  for (const auto &facet : wall_facets)
    {
      const Vector whole = facet_area(facet);
      for (const unsigned int node : facet)
        area[node] += whole / dim;
    }
  halo.sum_to_owners(area);
  wall_area.assign(area.begin(), area.begin() + points.n_own);
  for (std::size_t i = n_cloud; i < points.n_own; ++i)
    {
      wall_area[i] += surface_area[i];
      surface_area[i] = Vector();
    }
}

/**
 * Velocities on structures at the end of the step: those without the fluid, and what its
 * pressure adds, p a for each point, in this step so far.
 */
template <int dim>
void
Fluid<dim>::move_structures()
{
  typename StructureWalls<dim>::Pushes pushes;
  node_impulses.assign(structures.surface.nodes.size(), Vector());
  pushes.rigid.assign(structures.rigids.size(), {});
  if (structures.acts_on_others())
    {
      pushes = structures.sum_of_pressures(pressure.data(), wall_area, carried, comm);
      for (auto &push : pushes.rigid)
        {
          push.impulse *= push_time;
          push.moment *= push_time;
        }
      for (std::size_t n = 0; n < pushes.node.size(); ++n)
        node_impulses[n] = pushes.node[n] *= push_time;
    }
  rigid_impulses = pushes.rigid;
  for (std::size_t i = n_cloud; i < points.n_own; ++i)
    {
      const auto &node = structures.nodes[i - n_cloud];
      Vector      v = node.velocity + structures.velocity_of(structures.carried(i, node), pushes);
      if (node.rigid < 0 && pushes.node.empty())
        {
          node_impulses[node.number] = push_time * pressure[i] * wall_area[i];
          for (unsigned int d = 0; d < dim; ++d)
            v[d] += node.inverse_mass[d] * node_impulses[node.number][d];
        }
      moving[i] = corrected[i] = v;
    }
  slide(pushes);
}

// rho / theta Q M^-1 Q^T, with Q^T p the pressure's force and moment on the bodies, or its forces
// on their nodes; without what is in the matrix of it.
template <int dim>
void
Fluid<dim>::add_structures(double *result, const double *p) const
{
  if (!structures.acts_on_others())
    return;
  const auto push = structures.sum_of_pressures(p, wall_area, carried, comm);
  for (const auto &point : carried)
    if (const std::size_t i = point.row; !no_pressure[i])
      {
        double flow = wall_area[i] * structures.velocity_of(point, push);
        if (!push.node.empty())
          flow -= structures.softness(point, wall_area[i]) * p[i];
        result[i] += options.density * push_time / (options.time_weight * last_dt) * flow;
      }
}

// Drops that flew into a body.
template <int dim>
void
Fluid<dim>::find_inside(const std::vector<dealii::Point<dim>> &x,
                        std::vector<unsigned char>            &taken_out)
{
  if (structures.empty())
    return;
  std::uint64_t                         n = 0;
  typename StructureSurface<dim>::Place place;
  // On the surface angles do not tell the side.
  const auto is_inside = [&](const dealii::Point<dim> &p) {
    return structures.contains(p) &&
           !(structures.surface.find_nearest(p, place) && place.height > -1e-6 * options.spacing);
  };
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (!taken_out[i] && columns[Layout::sliding][i] == 0 && is_inside(x[i]))
      {
        taken_out[i] = 1;
        ++n;
      }
  counts.taken_out += mpi::sum(n, comm);
}

// A point inside the fluid that is nearly in the facet of a structure: their element's sphere would
// soon be too large.
template <int dim>
void
Fluid<dim>::find_flattened(const std::vector<dealii::Point<dim>> &x,
                           std::vector<double>                   &marks) const
{
  if (structures.empty())
    return;
  // In space elements reach into a body across its edges once a point is nearer to the middle of a
  // square of its nodes than 0.37 of their distance.
  const double least = std::max(options.refill.nearest_to_wall, dim == 3 ? 0.4 : 0.);
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      if (!mesh.is_simplex(e))
        continue;
      std::array<dealii::Point<dim>, dim> facet;
      unsigned int                        n = 0, tip = 0;
      for (unsigned int k = mesh.first_node[e]; k < mesh.first_node[e + 1]; ++k)
        if (const unsigned int node = mesh.node[k]; is_structure(node) && n < dim)
          facet[n++] = x[node];
        else
          tip = node;
      if (n < dim || free_surface[tip] || is_structure(tip))
        continue;
      Vector normal;
      if constexpr (dim == 2)
        normal = cross_product_2d(facet[1] - facet[0]);
      else
        normal = cross_product_3d(facet[1] - facet[0], facet[2] - facet[0]);
      if (std::fabs((x[tip] - facet[0]) * normal) < least * points.spacing[tip] * normal.norm())
        marks[tip] += 1;
    }
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
