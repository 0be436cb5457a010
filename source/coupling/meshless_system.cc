// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/meshless_points.h>
#include <coracle/coupling/meshless_system.h>
#include <coracle/particles/shape.h>
#include <coracle/structure/selection.h>

#include <sstream>

namespace coracle
{
namespace
{
/// What cannot be in one case with a meshless fluid.
template <int dim>
void
check_company(const Parameters &bodies)
{
  unsigned int n_fluids = 0;
  for (const std::string &name : bodies.section_names())
    n_fluids += bodies.section(name).choice("Kind") == "meshless fluid";
  if (n_fluids == 0)
    return;
  for (const std::string &name : bodies.section_names())
    {
      const Parameters  body = bodies.section(name);
      const std::string kind = body.choice("Kind");
      if (kind == "material points")
        throw body.error("Kind",
                         "a meshless fluid meets no material points",
                         "'" + name + "' is of the kind '" + kind + "'",
                         "take the body out, or make the fluid one of material points");
      if (n_fluids > 1)
        throw body.error("Kind",
                         "a case has one meshless fluid",
                         std::to_string(n_fluids) + " of them",
                         "make one body of them, for example with the shape 'indicator'");
    }
}

/// Elements reach from node to node of a surface, no farther than alpha allows.
template <int dim>
void
check_surfaces(const Parameters &body, const meshless::Fluid<dim> &fluid)
{
  const double longest = fluid.structures.longest_edge(), spacing = fluid.options.spacing;
  if (longest > 1.5 * spacing)
    throw body.error(
      "Spacing",
      "a structure's surface is too coarse for the fluid",
      "its longest edge is " + std::to_string(longest) + " m, points of the fluid are " +
        std::to_string(spacing) + " m apart",
      "refine the structure's mesh to edges of one spacing, or take a larger spacing");
}

/// Periods, and whether the fluid can have them.
template <int dim>
void
set_periods(const Parameters            &body,
            const bool                   with_structures,
            meshless::FluidOptions<dim> &options)
{
  std::vector<std::string> axes = {"x", "y"};
  if (dim == 3)
    axes.push_back("z");
  const auto words = read_words(body, "Periodic", axes);
  for (unsigned int d = 0; d < dim; ++d)
    if (words.count(axes[d]) > 0)
      {
        options.periodic[d]      = true;
        options.walls[2 * d]     = meshless::Wall::open;
        options.walls[2 * d + 1] = meshless::Wall::open;
        const double least       = options.tessellation.halo_width(options.spacing);
        if (options.box.side_length(d) < least)
          throw body.error("Periodic",
                           "a period is too short for the fluid's spacing",
                           "the box is " + std::to_string(options.box.side_length(d)) +
                             " m long in " + axes[d] +
                             ", an element must not meet its own image within " +
                             std::to_string(least) + " m",
                           "make the grid's box longer, or the spacing smaller");
      }
  if (!words.empty() && with_structures)
    throw body.error("Periodic",
                     "a periodic fluid meets no structures",
                     "there are structures, and they have no images",
                     "take the structures out, or set Periodic to nothing");
}

/// The grid's faces in the fluid's words.
template <int dim>
void
set_box(const Parameters &root, const Octree<dim> &octree, meshless::FluidOptions<dim> &options)
{
  options.box           = octree.box();
  const auto conditions = BoxBoundary<dim>::read(root.section("Grid"));
  for (unsigned int face = 0; face < 2 * dim; ++face)
    options.walls[face] = conditions[face] == FaceCondition::slip    ? meshless::Wall::slip
                          : conditions[face] == FaceCondition::stick ? meshless::Wall::stick
                                                                     : meshless::Wall::open;
}
} // namespace

template <int dim>
void
MeshlessSystem<dim>::declare(Declaration &body)
{
  declare_shape(body);
  meshless::FluidOptions<dim>::declare(body);
  body.list("Initial velocity", "", "m/s", "v_0", "Of all points; empty is rest.");
  body.function("Initial velocity function",
                "",
                "m/s",
                "One expression for each direction; used instead of the constant if not empty.");
  body.text(
    "Periodic",
    "",
    "Directions, of x, y and z, in which what leaves the grid's box at one end comes in at the "
    "other, whatever its boundaries there are; empty: none.");
  body.function("Body force",
                "",
                "m/s^2",
                "Acceleration besides gravity, one expression for each direction.");
  declare_regions(body);
}

template <int dim>
MeshlessSystem<dim>::MeshlessSystem(const Parameters             &root,
                                    const dealii::Tensor<1, dim> &gravity,
                                    const Octree<dim>            &octree,
                                    StructureSystem<dim>         &structure,
                                    const bool                    with_points)
  : comm(octree.triangulation.get_communicator())
{
  const Parameters section = root.section("Bodies");
  check_company<dim>(section);
  for (const std::string &name : section.section_names())
    {
      const Parameters body = section.section(name);
      if (body.choice("Kind") != "meshless fluid")
        continue;
      auto options = meshless::FluidOptions<dim>::read(body, gravity);
      set_box(root, octree, options);
      read_regions(body, options);
      set_periods(body, !structure.empty(), options);
      auto &fluid =
        bodies.emplace_back(body.name(), options, octree.triangulation.get_communicator());
      if (body.is_set("Body force"))
        fluid.body_force = body.function<dim>("Body force", dim);
      if (with_points)
        {
          generate_points(body, octree, fluid);
          look_at(structure, fluid);
          check_surfaces(body, fluid);
          fluid.clear_structures();
          put_points_on_structures(body, octree, fluid);
          fluid.remesh();
        }
    }
}

template <int dim>
double
MeshlessSystem<dim>::step_limit() const
{
  double result = std::numeric_limits<double>::infinity();
  for (const auto &body : bodies)
    result = std::min(result, body.step_limit());
  return result;
}

template <int dim>
std::string
MeshlessSystem<dim>::describe_limit() const
{
  return bodies.empty() ? "" : bodies.front().describe_limit();
}

template <int dim>
void
MeshlessSystem<dim>::look_at(StructureSystem<dim> &structure, meshless::Fluid<dim> &fluid) const
{
  if (structure.empty())
    return;
  const contact::Surface<dim> &surface = structure.publish_surface();
  std::vector<int>             rigid_of_node(surface.nodes.size(), -1);
  for (unsigned int body = 0; body < structure.n_bodies(); ++body)
    for (unsigned int i = structure.begin_nodes(body); i < structure.begin_nodes(body + 1); ++i)
      rigid_of_node[i] = surface.bodies[structure.first_surface(body)].rigid_body;
  fluid.structures.update(surface, rigid_of_node, structure.rigid_unknowns(), comm);
}

template <int dim>
void
MeshlessSystem<dim>::push(StructureSystem<dim> &structure, const meshless::Fluid<dim> &fluid) const
{
  if (structure.empty())
    return;
  const std::size_t                   n = structure.publish_surface().nodes.size();
  std::vector<dealii::Tensor<1, dim>> impulse(n), correction(n);
  for (unsigned int i = 0; i < n; ++i)
    if (const int number = fluid.structures.surface.number[i]; number >= 0)
      impulse[i] = fluid.node_impulses[number];
  std::vector<typename contact::ContactSystem<dim>::RigidImpulse> rigid;
  for (const auto &push : fluid.rigid_impulses)
    rigid.push_back({push.impulse, push.moment, {}, {}});
  structure.apply_contact(impulse, correction, rigid);
}

template <int dim>
void
MeshlessSystem<dim>::advance(const double          time,
                             const double          last_dt,
                             const double          dt,
                             StructureSystem<dim> &structure,
                             TimingTable          &timed)
{
  for (auto &body : bodies)
    {
      look_at(structure, body);
      body.advance(time, dt, timed, 0.5 * (last_dt + dt));
      push(structure, body);
      if (!failure && body.failure)
        failure.emplace(*body.failure);
    }
}

template <int dim>
void
MeshlessSystem<dim>::refill(StructureSystem<dim> &structure)
{
  for (auto &body : bodies)
    {
      look_at(structure, body);
      body.refill();
    }
}

template <int dim>
void
MeshlessSystem<dim>::remesh()
{
  for (auto &body : bodies)
    body.remesh();
}

template <int dim>
void
MeshlessSystem<dim>::serialize(Archive &archive, StructureSystem<dim> &structure)
{
  for (auto &body : bodies)
    {
      body.serialize(archive);
      if (archive.loads())
        {
          look_at(structure, body);
          body.remesh(!archive.is_exact());
        }
    }
}

template class MeshlessSystem<2>;
template class MeshlessSystem<3>;
} // namespace coracle
