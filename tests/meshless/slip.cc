// SPDX-License-Identifier: GPL-3.0-or-later
// Water at rest beside a wall that moves along itself, with facets of many spacings, stays at rest
// with its exact pressure; a body under water at rest is pushed up by exactly the weight of the
// water it displaces, rigid or by its nodes; water on a movable bottom falls as both masses
// together do; water that flows along a body past its edge is not hindered there.
#include <coracle/base/mpi.h>

#include "tank.h"
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

using namespace tank;

/// A box that moves as a whole, published by the first rank.
template <int dim>
struct Body
{
  Body(const dealii::Point<dim>        &lower,
       const dealii::Point<dim>        &upper,
       const std::vector<unsigned int> &parts,
       const bool                       rigid,
       const double                     inverse_mass = 0)
    : rigid(rigid)
  {
    dealii::Triangulation<dim> mesh;
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh, parts, lower, upper);
    std::map<unsigned int, unsigned int> number;
    for (const auto &face : mesh.active_face_iterators())
      {
        if (mpi::rank(comm) > 0 || !face->at_boundary())
          continue;
        contact::Facet<dim>               facet;
        std::array<dealii::Point<dim>, 4> x;
        for (unsigned int v = 0; v < facet.nodes.size(); ++v)
          {
            const unsigned int vertex = face->vertex_index(dim == 3 && v > 1 ? 5 - v : v);
            const auto         found  = number.emplace(vertex, surface.nodes.size());
            if (found.second)
              {
                contact::SurfaceNode<dim> node;
                node.position = mesh.get_vertices()[vertex];
                node.key      = vertex;
                for (unsigned int d = 0; d < dim && !rigid; ++d)
                  node.inverse_mass[d] = inverse_mass;
                surface.nodes.push_back(node);
              }
            facet.nodes[v] = found.first->second;
            x[v]           = surface.nodes[facet.nodes[v]].position;
          }
        dealii::Tensor<1, dim> normal;
        if constexpr (dim == 2)
          normal = cross_product_2d(x[1] - x[0]);
        else
          normal = cross_product_3d(x[1] - x[0], x[2] - x[0]);
        if (normal * (x[0] - (lower + 0.5 * (upper - lower))) < 0)
          std::reverse(facet.nodes.begin(), facet.nodes.end());
        facet.key = surface.facets.size();
        surface.facets.push_back(facet);
      }
    surface.bodies.resize(1);
    surface.bodies[0].rigid_body = rigid ? 0 : -1;
    if (rigid)
      {
        rigids.resize(1);
        rigids[0].centre = lower + 0.5 * (upper - lower);
        for (unsigned int d = 0; d < dim; ++d)
          rigids[0].inverse_mass[d] = inverse_mass;
      }
  }

  void show(Fluid<dim> &fluid)
  {
    fluid.structures.update(surface,
                            std::vector<int>(surface.nodes.size(), rigid ? 0 : -1),
                            rigids,
                            comm);
  }

  void move(const dealii::Tensor<1, dim> &way)
  {
    for (auto &node : surface.nodes)
      node.position += way;
    for (auto &body : rigids)
      body.centre += way;
  }

  bool                                    rigid;
  contact::Surface<dim>                   surface;
  std::vector<contact::RigidUnknown<dim>> rigids;
};

/// The box's options, with slip; and water from x = left, up to a height, not where `body` is.
template <int dim>
void
fill_beside(Fluid<dim> &fluid, Body<dim> &body, const double left, const double height)
{
  const double h = fluid.options.spacing;
  const auto   n = [&](const double length) { return static_cast<unsigned int>(length / h + 0.5); };
  dealii::Point<dim> lower, upper;
  for (unsigned int d = 0; d < dim; ++d)
    upper[d] = d + 1 == dim ? height : 1;
  lower[0] = left;
  std::array<unsigned int, dim> parts;
  for (unsigned int d = 0; d < dim; ++d)
    parts[d] = n(upper[d] - lower[d]);
  body.show(fluid);
  unsigned int n_points = 1;
  for (const unsigned int m : parts)
    n_points *= m + 1;
  typename StructureSurface<dim>::Place place;
  for (unsigned int id = 0; id < n_points; ++id)
    {
      dealii::Point<dim> x;
      for (unsigned int d = 0, rest = id; d < dim; rest /= parts[d] + 1, ++d)
        x[d] = lower[d] + (upper[d] - lower[d]) * (rest % (parts[d] + 1)) / parts[d];
      const bool near = fluid.structures.surface.find_nearest(x, place);
      if (id % mpi::n_ranks(comm) != mpi::rank(comm) ||
          (near ? place.height < 0.4 * h && std::fabs(place.height) > 1e-9
                : fluid.structures.contains(x)))
        continue;
      bool is_node = false;
      for (const auto &node : fluid.structures.surface.nodes)
        is_node |= node.is_sharp && node.position.distance(x) < 1e-9;
      if (is_node)
        continue;
      fluid.add_point(x, {}, id);
      if (near && std::fabs(place.height) < 1e-9)
        fluid.columns[FluidLayout<dim>::sliding][fluid.n_fluid() - 1] = 1;
    }
  fluid.remesh();
}

template <int dim>
FluidOptions<dim>
slipping(const unsigned int n)
{
  auto options                = box<dim>(n);
  options.slips_on_structures = true;
  return options;
}

template <int dim>
dealii::Point<dim>
all(const double x)
{
  dealii::Point<dim> p;
  for (unsigned int d = 0; d < dim; ++d)
    p[d] = x;
  return p;
}

/// Largest error of the hydrostatic pressure over that at the bottom, and largest speed.
template <int dim>
std::pair<double, double>
errors(const Fluid<dim> &fluid, const double height)
{
  double worst = 0, fastest = 0;
  for (std::size_t i = 0; i < fluid.n_fluid(); ++i)
    {
      const double exact = 1e4 * (height - fluid.points.position[i][dim - 1]);
      worst              = std::max(worst, std::fabs(fluid.pressure[i] - exact) / (1e4 * height));
      fastest            = std::max(fastest, fluid.velocity[i].norm());
    }
  return {mpi::max(worst, comm), mpi::max(fastest, comm)};
}

template <int dim>
void
moving_wall()
{
  const unsigned int n = dim == 2 ? 20 : 8;
  Fluid<dim>         fluid("water", slipping<dim>(n), comm);
  auto               upper = all<dim>(2.5);
  upper[0]                 = 0.25;
  Body<dim>              wall(all<dim>(-1), upper, std::vector<unsigned int>(dim, 1), true);
  dealii::Tensor<1, dim> along;
  along[dim - 1] = 1;
  if (dim == 3)
    along[1] = -0.5;
  for (auto &node : wall.surface.nodes)
    node.velocity = along;
  fill_beside(fluid, wall, 0.25, 0.75);
  TimingTable  timed;
  const double dt = 0.01;
  for (unsigned int step = 0; step < 20; ++step)
    {
      wall.show(fluid);
      fluid.advance(step * dt, dt, timed);
      wall.move(dt * along);
      wall.show(fluid);
      fluid.refill();
      fluid.remesh();
    }
  const auto [pressure, speed] = errors(fluid, 0.75);
  deallog << "a wall that moves along itself: pressure of the water to 1e-9: " << (pressure < 1e-9)
          << ", at rest to 1e-9 m/s: " << (speed < 1e-9) << std::endl;
}

template <int dim>
void
under_water(const bool rigid)
{
  const unsigned int n = dim == 2 ? 20 : 10;
  Fluid<dim>         fluid("water", slipping<dim>(n), comm);
  // In space points on edges stay, so that these have facets; in the plane sides are one facet.
  Body<dim> body(all<dim>(0.3),
                 all<dim>(0.6),
                 std::vector<unsigned int>(dim, dim == 2 ? 1 : 3),
                 rigid);
  fill_beside(fluid, body, 0., 0.9);
  TimingTable  timed;
  const double dt = 0.01;
  body.show(fluid);
  fluid.advance(0., dt, timed);
  dealii::Tensor<1, dim> force;
  if (rigid)
    force = fluid.rigid_impulses[0].impulse / dt;
  else if (mpi::rank(comm) == 0)
    for (const auto &impulse : fluid.node_impulses)
      force += impulse / dt;
  dealii::Tensor<1, dim> exact;
  exact[dim - 1] = 1e4 * std::pow(0.3, dim);
  deallog << (rigid ? "rigid" : "by its nodes") << ": pushed up by what it displaces to 1e-8: "
          << (!rigid && mpi::rank(comm) > 0 ? true : (force - exact).norm() < 1e-8 * exact.norm())
          << std::endl;
}

/// The water's weight speeds up both masses, g m / (m + M).
template <int dim>
void
movable_bottom(const bool rigid)
{
  const unsigned int n     = dim == 2 ? 16 : 6;
  const double       depth = 0.5, mass = 250;
  auto               options = slipping<dim>(n);
  auto               deep    = all<dim>(0);
  deep[dim - 1]              = -2;
  options.box                = dealii::BoundingBox<dim>({deep, all<dim>(1)});
  Fluid<dim> fluid("water", options, comm);
  auto       lower = all<dim>(0), upper = all<dim>(1);
  lower[dim - 1] = -1;
  upper[dim - 1] = 0;
  // Facets of two spacings.
  std::vector<unsigned int> parts(dim, n / 2);
  if (dim == 3)
    parts[0] = parts[1] = n;
  parts[dim - 1] = 1;
  Body<dim> body(lower, upper, parts, rigid, rigid ? 1 / mass : n / 2 / mass);
  for (auto &node : body.surface.nodes)
    if (!rigid && (node.position[0] < 1e-9 || node.position[0] > 1 - 1e-9))
      node.inverse_mass *= 2;
  fill_beside(fluid, body, 0., depth);
  TimingTable  timed;
  const double dt = 0.01;
  body.show(fluid);
  fluid.advance(0., dt, timed);
  const double exact = -10 * dt * 1000 * depth / (1000 * depth + mass);
  double       worst = 0;
  for (std::size_t i = 0; i < fluid.n_fluid(); ++i)
    worst = std::max(worst,
                     std::fabs(fluid.columns[FluidLayout<dim>::velocity + dim - 1][i] / exact - 1));
  deallog << (rigid ? "rigid" : "by its nodes")
          << ": water and its bottom fall together, to 1e-7: " << (mpi::max(worst, comm) < 1e-7)
          << std::endl;
}

/// A block not quite a lattice, so that its elements are simplices, whose faces in space are those
/// of the surface; but one point comes to be exactly on the edge.
template <int dim>
void
fill_block(Fluid<dim> &fluid, const unsigned int n, const dealii::Tensor<1, dim> &velocity)
{
  const unsigned int n_points = std::pow(n, dim);
  for (unsigned int id = mpi::rank(comm); id < n_points; id += mpi::n_ranks(comm))
    {
      std::mt19937_64                        engine(id);
      std::uniform_real_distribution<double> random(-0.1, 0.1);
      dealii::Point<dim>                     x;
      for (unsigned int d = 0, rest = id; d < dim; rest /= n, ++d)
        {
          const bool on_body = d == 0 && rest % n == 0, on_edge = id == n_points - n;
          x[d] =
            0.25 + (rest % n + (on_body || on_edge ? 0. : random(engine))) * fluid.options.spacing;
        }
      fluid.add_point(x, velocity, id);
      fluid.columns[FluidLayout<dim>::sliding][fluid.n_fluid() - 1] = x[0] == 0.25;
    }
  fluid.remesh();
}

/// Without gravity: nothing but the edge could change the velocity.
template <int dim>
void
past_the_edge()
{
  const unsigned int n       = dim == 2 ? 20 : 8;
  auto               options = slipping<dim>(n);
  options.gravity            = dealii::Tensor<1, dim>();
  options.refill.enabled     = false;
  Fluid<dim> fluid("water", options, comm);
  auto       upper = all<dim>(2);
  upper[0]         = 0.25;
  upper[dim - 1]   = 0.6;
  std::vector<unsigned int> parts(dim, 1);
  if (dim == 3)
    parts[1] = 3 * n; // nodes along the edge
  Body<dim> body(all<dim>(-1), upper, parts, true);
  body.show(fluid);
  dealii::Tensor<1, dim> along;
  along[dim - 1] = 1;
  fill_block(fluid, n / 4 + 1, along);
  const auto   n_points = mpi::sum(fluid.n_fluid(), comm);
  TimingTable  timed;
  const double dt   = 0.01;
  double       push = 0, worst = 0;
  for (unsigned int step = 0; step < 40; ++step)
    {
      body.show(fluid);
      fluid.advance(step * dt, dt, timed);
      push = std::max(push, fluid.rigid_impulses[0].impulse.norm() / dt);
      fluid.refill();
      fluid.remesh();
    }
  for (std::size_t i = 0; i < fluid.n_fluid(); ++i)
    worst = std::max(worst, (fluid.velocity[i] - along).norm());
  deallog << "past the edge of a body: velocity kept to 1e-9 m/s: "
          << (mpi::max(worst, comm) < 1e-9) << ", no force to 1e-9 N: " << (push < 1e-9)
          << ", all points are left: " << (mpi::sum(fluid.n_fluid(), comm) == n_points)
          << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  moving_wall<dim>();
  under_water<dim>(true);
  under_water<dim>(false);
  past_the_edge<dim>();
  // In space bilinear faces of cubes beside triangles of the surface make this inexact.
  if (dim == 2)
    {
      movable_bottom<dim>(true);
      movable_bottom<dim>(false);
    }
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
