// SPDX-License-Identifier: GPL-3.0-or-later
// Surface nodes as points: in self contact a node meets the opposite leg of a U but never its own
// thin wall, nor anything in a coarse ring; two rows of nodes that meet node on node keep momentum
// to round-off and do not pass; rigid bodies that meet off-centre keep momentum and angular
// momentum to round-off and gain no energy.

#include "scene.h"

using namespace scene;

/// The nodes of one body as a set of points that owns its columns.
template <int dim>
struct Nodes
{
  std::vector<unsigned int>            node;
  std::vector<std::uint64_t>           keys;
  std::array<std::vector<double>, dim> position, velocity;

  void add_from(const Surface<dim> &surface, const unsigned int begin, const unsigned int end)
  {
    for (unsigned int i = begin; i < end; ++i)
      {
        node.push_back(i);
        keys.push_back(surface.nodes[i].key);
      }
  }

  PointSet<dim> set(const Surface<dim> &surface, const int body)
  {
    PointSet<dim> s;
    s.n_points        = node.size();
    s.body            = body;
    s.surface_node    = node.data();
    s.ids             = keys.data();
    s.constant_radius = 0.5 * surface.bodies[body].thickness;
    for (int d = 0; d < dim; ++d)
      {
        position[d].resize(node.size());
        velocity[d].resize(node.size());
        for (unsigned int i = 0; i < node.size(); ++i)
          {
            position[d][i] = surface.nodes[node[i]].position[d];
            velocity[d][i] = surface.nodes[node[i]].velocity[d];
          }
        s.position[d] = position[d].data();
        s.velocity[d] = velocity[d].data();
      }
    return s;
  }
};

/// One step of surfaces alone. Rigid bodies are turned only in 2-D.
template <int dim>
void
step_nodes(ContactSystem<dim>             &contacts,
           Surface<dim>                   &surface,
           std::vector<Nodes<dim>>        &nodes,
           std::vector<RigidUnknown<dim>> &rigid,
           const double                    dt)
{
  const auto make_sets = [&] {
    std::vector<PointSet<dim>> sets;
    for (unsigned int b = 0; b < nodes.size(); ++b)
      sets.push_back(nodes[b].set(surface, b));
    return sets;
  };
  contacts.find(surface, make_sets(), dt);
  contacts.build_rows([](const unsigned int, const unsigned int, std::vector<Rows::Entry> &) {},
                      [](const unsigned int) { return Unknown<dim>(); });
  contacts.solve(rigid, dt);
  std::vector<dealii::Tensor<1, dim>> impulse(surface.nodes.size()),
    correction(surface.nodes.size());
  contacts.surface_impulses(impulse, correction);
  for (unsigned int b = 0; b < rigid.size(); ++b)
    {
      const auto &all = contacts.rigid_impulses()[b];
      for (int d = 0; d < dim; ++d)
        rigid[b].velocity[d] += rigid[b].inverse_mass[d] * all.impulse[d];
      rigid[b].spin += rigid[b].inverse_inertia * all.moment;
    }
  std::vector<bool> is_rigid(surface.nodes.size());
  for (const auto &facet : surface.facets)
    if (const int r = surface.bodies[facet.body].rigid_body; r >= 0)
      for (const unsigned int i : facet.nodes)
        if (!is_rigid[i])
          {
            auto &node    = surface.nodes[i];
            node.velocity = rigid[r].velocity +
                            Delassus<dim>::cross(rigid[r].spin, node.position - rigid[r].centre);
            is_rigid[i] = true;
          }
  for (auto &body : rigid)
    body.centre += dt * body.velocity;
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    {
      auto &node = surface.nodes[i];
      for (int d = 0; d < dim && !is_rigid[i]; ++d)
        {
          node.velocity[d] += node.inverse_mass[d] * impulse[i][d];
          node.position[d] += node.inverse_mass[d] * correction[i][d];
        }
      node.position += dt * node.velocity;
    }
  contacts.audit(surface, make_sets());
}

/// A U, legs 1 long, 0.01 thick and 0.02 apart, in n facets along each face.
std::vector<dealii::Point<2>>
corners_of_u(const unsigned int n)
{
  std::vector<dealii::Point<2>> x;
  const auto                    line = [&](const dealii::Point<2> &a, const dealii::Point<2> &b) {
    for (unsigned int i = 0; i < n; ++i)
      x.push_back(a + (double(i) / n) * (b - a));
  };
  line({0, 0}, {0.04, 0});
  line({0.04, 0}, {0.04, 1});
  line({0.04, 1}, {0.03, 1});
  line({0.03, 1}, {0.03, 0.01});
  line({0.03, 0.01}, {0.01, 0.01});
  line({0.01, 0.01}, {0.01, 1});
  line({0.01, 1}, {0, 1});
  line({0, 1}, {0, 0});
  return x;
}

template <int dim>
Surface<dim>
make_body(const std::vector<dealii::Point<2>> &outline, const unsigned int nz = 3)
{
  auto s                   = one_body<dim>(SurfaceKind::closed, 0.004);
  s.bodies[0].self_contact = true;
  const unsigned int n     = outline.size();
  if constexpr (dim == 2)
    add_polyline(s, outline, true, 1.);
  else
    {
      for (unsigned int k = 0; k <= nz; ++k)
        for (const auto &x : outline)
          add_node<3>(s, {x[0], x[1], 0.05 * k}, 1.);
      for (unsigned int k = 0; k < nz; ++k)
        for (unsigned int i = 0; i < n; ++i)
          {
            const unsigned int a = k * n + i, b = k * n + (i + 1) % n;
            add_facet<3>(s, {{a, b, b + n, a + n}});
          }
    }
  for (auto &node : s.nodes)
    node.velocity[0] = 0.02;
  return s;
}

template <int dim>
void
self_contacts()
{
  // A step so long that everything within 0.024 is in the band.
  struct Count
  {
    unsigned int all = 0, across = 0;
    bool         facing = true;
  };
  const auto count = [](const Surface<dim> &surface) {
    std::vector<Nodes<dim>> nodes(1);
    nodes[0].add_from(surface, 0, surface.nodes.size());
    ContactSystem<dim> contacts(ContactOptions(), MPI_COMM_SELF);
    contacts.find(surface, {nodes[0].set(surface, 0)}, 1.);
    Count result;
    for (const auto &c : contacts.contacts())
      {
        ++result.all;
        result.across += std::abs(c.gap - 0.02) < 1e-12;
        // Farther ones are nodes of a leg's end that see the edge of the other's.
        result.facing = result.facing && c.gap > 0.02 - 1e-12 && std::abs(c.normal[1]) < 1e-12 &&
                        std::abs(c.distance - 0.004) < 1e-15;
      }
    return result;
  };
  for (const unsigned int n : {3, 50})
    {
      const Count found = count(make_body<dim>(corners_of_u(n)));
      deallog << "U of " << n << ": every node of both legs meets the other "
              << (found.across == 2 * n * (dim == 2 ? 1 : 4)) << ", nothing meets its own wall "
              << found.facing << std::endl;
    }
  unsigned int in_rings = 0;
  for (const unsigned int n : {4, 5, 6, 7, 16})
    {
      // A ring from within: the body lies outside of the circle.
      std::vector<dealii::Point<2>> x;
      const double                  r = 0.014;
      for (unsigned int i = 0; i < n; ++i)
        x.emplace_back(r * std::cos(2 * M_PI * i / n), -r * std::sin(2 * M_PI * i / n));
      in_rings += count(make_body<dim>(x)).all;
    }
  deallog << "contacts in coarse rings " << in_rings << std::endl;
}

/// Two rows of free nodes meet, node on node and then shifted by a third of a facet.
template <int dim>
void
rows_meet(const double shift)
{
  Surface<dim> s;
  s.bodies.resize(2);
  s.bodies[0].thickness = 0.01;
  s.bodies[1].thickness = 0.03;
  s.bodies[1].part      = 1;
  const unsigned int n = 6, m = (dim == 2 ? 0 : 4);
  for (unsigned int b = 0; b < 2; ++b)
    for (unsigned int j = 0; j <= m; ++j)
      for (unsigned int i = 0; i <= n; ++i)
        {
          dealii::Point<dim> x;
          x[0] = 0.1 * i + (b == 0 ? 0. : shift);
          if (dim == 3)
            x[1] = 0.1 * j;
          x[dim - 1]                      = (b == 0 ? 0. : 0.05);
          const unsigned int node         = add_node<dim>(s, x, 1. + i % 3);
          s.nodes[node].velocity[dim - 1] = (b == 0 ? 1. : -2.);
        }
  // Facing each other: the lower one's normal is up, the upper one's down.
  const unsigned int all = (n + 1) * (m + 1);
  for (unsigned int i = 0; i < n; ++i)
    if constexpr (dim == 2)
      {
        add_facet<2>(s, {{i + 1, i}}, 0);
        add_facet<2>(s, {{all + i, all + i + 1}}, 1);
      }
    else
      for (unsigned int j = 0; j < m; ++j)
        {
          const unsigned int a = j * (n + 1) + i, up = n + 1;
          add_facet<3>(s, {{a, a + 1, a + up + 1, a + up}}, 0);
          add_facet<3>(s, {{all + a, all + a + up, all + a + up + 1, all + a + 1}}, 1);
        }
  const auto momentum = [&] {
    dealii::Tensor<1, dim> sum;
    for (const auto &node : s.nodes)
      sum += node.velocity / node.inverse_mass[0];
    return sum;
  };
  const auto              before = momentum();
  std::vector<Nodes<dim>> nodes(2);
  nodes[0].add_from(s, 0, all);
  nodes[1].add_from(s, all, 2 * all);
  ContactSystem<dim>             contacts(ContactOptions(), MPI_COMM_SELF);
  std::vector<RigidUnknown<dim>> none;
  bool                           converged = true;
  unsigned int                   most      = 0;
  for (unsigned int i = 0; i < 60; ++i)
    {
      step_nodes(contacts, s, nodes, none, 0.001);
      converged = converged && contacts.report().solver.velocity.converged;
      most      = std::max<unsigned int>(most, contacts.report().n_contacts);
    }
  double worst = 1;
  for (unsigned int i = 0; i < all; ++i)
    worst = std::min(worst, s.nodes[all + i].position[dim - 1] - s.nodes[i].position[dim - 1]);
  deallog << "rows that meet: " << most << " contacts, converged " << converged
          << ", momentum kept " << ((momentum() - before).norm() < 1e-12)
          << ", nodes face to face stop at R " << (shift > 0 || std::abs(worst / 0.02 - 1) < 1e-3)
          << ", penetrations " << contacts.report().n_penetrations << std::endl;
}

/// A rigid square flies into another off its centre.
void
rigid_bodies_meet(const bool first_is_deformable)
{
  Surface<2> s;
  s.bodies.resize(2);
  const auto square = [&](const double x, const double y, const unsigned int body) {
    const unsigned int first = s.nodes.size();
    for (const auto &corner : {dealii::Point<2>(0, 0),
                               dealii::Point<2>(1, 0),
                               dealii::Point<2>(1, 1),
                               dealii::Point<2>(0, 1)})
      add_node<2>(s, {x + corner[0], y + corner[1]}, 4.);
    for (unsigned int k = 0; k < 4; ++k)
      add_facet<2>(s, {{first + k, first + (k + 1) % 4}}, body);
    s.bodies[body].thickness = 0.02;
    s.bodies[body].friction  = 0.3;
    s.bodies[body].part      = body;
  };
  square(0, 0, 0);
  square(1.05, 0.6, 1);
  std::vector<RigidUnknown<2>> rigid(first_is_deformable ? 1 : 2);
  for (unsigned int b = 0; b < rigid.size(); ++b)
    {
      auto &body = rigid[b];
      body.centre =
        (rigid.size() == 2 && b == 0 ? dealii::Point<2>(0.5, 0.5) : dealii::Point<2>(1.55, 1.1));
      body.inverse_mass[0] = body.inverse_mass[1] = 1;
      body.inverse_inertia[2][2]                  = 6;
    }
  s.bodies[1].rigid_body = rigid.size() - 1;
  if (!first_is_deformable)
    s.bodies[0].rigid_body = 0;
  // Four loose corners of a quarter each stand for the deformable one.
  for (unsigned int i = 0; i < 4; ++i)
    s.nodes[i].velocity[0] = 1;
  if (!first_is_deformable)
    rigid[0].velocity[0] = 1;
  const auto sums = [&] {
    std::array<double, 4> result{};
    const auto add = [&](const double m, const dealii::Point<2> &x, const dealii::Tensor<1, 2> &v) {
      result[0] += m * v[0];
      result[1] += m * v[1];
      result[2] += m * (x[0] * v[1] - x[1] * v[0]);
      result[3] += 0.5 * m * v.norm_square();
    };
    for (const auto &body : rigid)
      {
        add(1, body.centre, body.velocity);
        result[2] += body.spin[2] / 6;
        result[3] += 0.5 * body.spin[2] * body.spin[2] / 6;
      }
    for (unsigned int i = 0; i < 4 && first_is_deformable; ++i)
      add(0.25, s.nodes[i].position, s.nodes[i].velocity);
    return result;
  };
  const auto            before = sums();
  std::vector<Nodes<2>> nodes(2);
  nodes[0].add_from(s, 0, 4);
  nodes[1].add_from(s, 4, 8);
  ContactSystem<2> contacts(ContactOptions(), MPI_COMM_SELF);
  double           worst = 0, gain = 0, energy = before[3];
  unsigned int     touched = 0;
  for (unsigned int i = 0; i < 200; ++i)
    {
      step_nodes(contacts, s, nodes, rigid, 0.001);
      touched += contacts.report().n_contacts > 0;
      const auto now = sums();
      // Positions move after velocities: a moment about the origin is kept by equal and opposite
      // impulses on one line, and by momentum along the way.
      for (unsigned int k = 0; k < (first_is_deformable ? 2 : 3); ++k)
        worst = std::max(worst, std::abs(now[k] - before[k]));
      gain   = std::max(gain, now[3] - energy);
      energy = now[3];
    }
  deallog << (first_is_deformable ? "nodes and a rigid body: " : "two rigid bodies: ") << "touched "
          << (touched > 0) << ", spun " << (std::abs(rigid.back().spin[2]) > 0.1) << ", kept "
          << (worst < 1e-12) << ", energy gained " << (gain > 1e-12) << ", lost "
          << (energy < before[3]) << ", penetrations " << contacts.report().n_penetrations
          << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(dim == 2 ? "2d" : "3d");
  self_contacts<dim>();
  rows_meet<dim>(0.);
  rows_meet<dim>(0.1 / 3);
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  deallog << std::boolalpha;
  test<2>();
  test<3>();
  rigid_bodies_meet(false);
  rigid_bodies_meet(true);
}
