// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/meshless_system.h>
#include <coracle/particles/shape.h>

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
      if (kind != "meshless fluid")
        throw body.error("Kind",
                         "a meshless fluid meets no other body yet",
                         "'" + name + "' is of the kind '" + kind + "'",
                         "take the body out, or make the fluid one of material points");
      if (n_fluids > 1)
        throw body.error("Kind",
                         "a case has one meshless fluid",
                         std::to_string(n_fluids) + " of them",
                         "make one body of them, for example with the shape 'indicator'");
    }
}

/// Points evenly over the box around a shape, from face to face.
template <int dim>
class ClosedLattice
{
public:
  ClosedLattice(const dealii::BoundingBox<dim> &box, const double spacing) : box(box)
  {
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = static_cast<std::uint64_t>(std::max(1., std::round(box.side_length(d) / spacing))) + 1;
  }

  std::uint64_t size() const
  {
    std::uint64_t result = 1;
    for (unsigned int d = 0; d < dim; ++d)
      result *= n[d];
    return result;
  }

  dealii::Point<dim> point(std::uint64_t id) const
  {
    dealii::Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double share = double(id % n[d]) / (n[d] - 1);
        x[d]               = (1 - share) * box.lower_bound(d) + share * box.upper_bound(d);
        id /= n[d];
      }
    return x;
  }

private:
  const dealii::BoundingBox<dim> box;
  std::array<std::uint64_t, dim> n;
};

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
  body.function("Body force",
                "",
                "m/s^2",
                "Acceleration besides gravity, one expression for each direction.");
}

template <int dim>
MeshlessSystem<dim>::MeshlessSystem(const Parameters             &root,
                                    const dealii::Tensor<1, dim> &gravity,
                                    const Octree<dim>            &octree,
                                    const bool                    with_points)
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
      auto &fluid =
        bodies.emplace_back(body.name(), options, octree.triangulation.get_communicator());
      if (body.is_set("Body force"))
        fluid.body_force = body.function<dim>("Body force", dim);
      if (with_points)
        {
          generate(body, octree, fluid);
          fluid.remesh();
        }
    }
}

template <int dim>
void
MeshlessSystem<dim>::generate(const Parameters     &body,
                              const Octree<dim>    &octree,
                              meshless::Fluid<dim> &fluid)
{
  const auto                             shape    = read_shape<dim>(body);
  const dealii::BoundingBox<dim>         box      = shape->bounding_box();
  const std::vector<double>              constant = body.list("Initial velocity");
  std::unique_ptr<dealii::Function<dim>> varying;
  if (body.is_set("Initial velocity function"))
    varying = body.function<dim>("Initial velocity function", dim);
  if (!constant.empty() && constant.size() != dim)
    throw body.error("Initial velocity",
                     "a velocity has the wrong number of components",
                     std::to_string(constant.size()) + " components",
                     "give " + std::to_string(dim) + ", one for each direction");
  const ClosedLattice<dim> lattice(box, fluid.options.spacing);
  std::uint64_t            n = 0;
  for (std::uint64_t id = 0; id < lattice.size(); ++id)
    {
      const dealii::Point<dim> x = lattice.point(id);
      // Points on the shape's boundary are in.
      const dealii::Point<dim> inner = x + 1e-9 * (box.center() - x);
      const int                leaf  = octree.find(x);
      if (leaf < 0 || leaf >= static_cast<int>(octree.n_owned_leaves()) || !shape->contains(inner))
        continue;
      dealii::Tensor<1, dim> v;
      for (unsigned int d = 0; d < dim; ++d)
        v[d] = varying ? varying->value(x, d) : (constant.empty() ? 0. : constant[d]);
      fluid.add_point(x, v, id);
      ++n;
    }
  n                    = mpi::sum(n, octree.triangulation.get_communicator());
  fluid.counts.created = n;
  if (n <= dim)
    throw body.error("Spacing",
                     "a body has no points",
                     std::to_string(n) + " points of a lattice of " +
                       std::to_string(fluid.options.spacing) + " m are in the shape and the box",
                     "choose a smaller spacing, or move the shape into the grid's box");
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
MeshlessSystem<dim>::advance(const double time, const double dt, TimingTable &timed)
{
  for (auto &body : bodies)
    {
      body.advance(time, dt, timed);
      if (!failure && body.failure)
        failure.emplace(*body.failure);
    }
}

template <int dim>
void
MeshlessSystem<dim>::refill()
{
  for (auto &body : bodies)
    body.refill();
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
MeshlessSystem<dim>::serialize(Archive &archive)
{
  for (auto &body : bodies)
    {
      body.serialize(archive);
      if (archive.loads())
        body.remesh(!archive.is_exact());
    }
}

template class MeshlessSystem<2>;
template class MeshlessSystem<3>;
} // namespace coracle
