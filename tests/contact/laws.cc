// SPDX-License-Identifier: GPL-3.0-or-later
// What each law does to one contact and to three that share a node is exact, on
// any number of ranks; law split gives no energy and its friction lies in the
// cone against the sliding, while the published laws feed energy in; a block on
// an incline slides with g (sin - mu cos) over many facets, or stays.

#include "random_contacts.h"

ContactOptions
with_law(const Law law, const double alpha = 0)
{
  ContactOptions options;
  options.law   = law;
  options.alpha = alpha;
  return options;
}

const char *const law_names[] = {"split", "blended", "stick/slip"};

/// A point at this height that meets a plate with (1, -3) m/s; its velocity afterwards.
dealii::Tensor<1, 2>
meet(const ContactOptions &options, const double mu, const double height, const double v = -3)
{
  auto plate = one_body<2>(SurfaceKind::closed, 0, mu);
  add_polyline(plate, {dealii::Point<2>(1, 0), dealii::Point<2>(-1, 0)}, false);
  Points<2> points;
  points.radius = 0.01;
  points.add(dealii::Point<2>(0, height), dealii::Tensor<1, 2>({1., v}), 2.);
  ContactSystem<2>             contacts(options, MPI_COMM_SELF);
  std::vector<RigidUnknown<2>> rigid;
  step(contacts, plate, points, rigid, 0.001);
  return points.v(0);
}

void
one_contact()
{
  const auto stick_slip = with_law(Law::stick_slip);
  deallog << "stick/slip, mu 0.2: " << meet(stick_slip, 0.2, 0.008)
          << ", mu 0.5: " << meet(stick_slip, 0.5, 0.008)
          << ", not in contact: " << meet(stick_slip, 0.2, 0.0105)
          << ", parting: " << meet(stick_slip, 0.2, 0.008, 0.5) << std::endl;
  for (const double alpha : {0., 0.3, 1.})
    deallog << "blended " << alpha << ": " << meet(with_law(Law::blended, alpha), 0, 0.008)
            << std::endl;
}

/// Three points in one place of the grid, as far as its only node of mass 1 is concerned.
void
three_on_a_node()
{
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  for (const Law law : {Law::split, Law::blended, Law::stick_slip})
    {
      std::vector<Contact<2>>        contacts;
      std::vector<WarmStart<2>::Key> keys;
      Rows                           rows;
      Unknown<2>                     node;
      node.velocity     = dealii::Tensor<1, 2>({1., -3.});
      node.inverse_mass = dealii::Tensor<1, 2>({1., 1.});
      for (unsigned int c = rank; c < 3; c += n_ranks)
        {
          Contact<2> contact{};
          contact.point     = c;
          contact.normal[1] = 1;
          contact.distance  = 0.01;
          contact.gap       = 0.009;
          contact.friction  = 0.5;
          contacts.push_back(contact);
          keys.push_back({c, 0});
          rows.entries.push_back({0, 1.});
          rows.begin.push_back(rows.entries.size());
          rows.begin.push_back(rows.entries.size());
          rows.rigid_body.push_back({{-1, -1}});
        }
      Solver<2> solver(with_law(law), MPI_COMM_WORLD);
      solver.solve(contacts,
                   keys,
                   rows,
                   contacts.empty() ? std::vector<Unknown<2>>() : std::vector<Unknown<2>>{node},
                   {},
                   0.001);
      const auto v = (contacts.empty() ? dealii::Tensor<1, 2>() : solver.velocities().nodes[0]);
      deallog << law_names[static_cast<int>(law)]
              << ", three on a node: " << dealii::Utilities::MPI::max(v[0], MPI_COMM_WORLD) << " "
              << dealii::Utilities::MPI::max(v[1], MPI_COMM_WORLD) << ", work "
              << solver.report().work << std::endl;
    }
}

/// Kinetic energy of what is free, and the energy that prescribed directions take up.
template <int dim>
double
energy(const Problem<dim> &problem, const Velocities<dim> &v)
{
  double result = 0;
  for (unsigned int i = 0; i < problem.unknowns.size(); ++i)
    for (int d = 0; d < dim; ++d)
      if (problem.unknowns[i].inverse_mass[d] > 0)
        result += 0.5 * v.nodes[i][d] * v.nodes[i][d] / problem.unknowns[i].inverse_mass[d];
  for (unsigned int b = 0; b < problem.rigid.size(); ++b)
    {
      for (int d = 0; d < dim; ++d)
        result += 0.5 * v.rigid[b][d] * v.rigid[b][d] / problem.rigid[b].inverse_mass[d];
      for (int d = (dim == 2 ? 2 : 0); d < 3; ++d)
        result += 0.5 * v.spin[b][d] * v.spin[b][d] / problem.rigid[b].inverse_inertia[d][d];
    }
  return result;
}

template <int dim>
void
random_energy(const Law law)
{
  double worst_book = 0, most = -1e300, cone = 0, along = 0, sliding = 0;
  for (unsigned int seed = 0; seed < 40; ++seed)
    {
      const Problem<dim> problem(9, seed, 0.3, seed % 2);
      ContactOptions     options = sharp();
      options.law                = law;
      options.tolerance          = (law == Law::split ? 1e-10 : 1e-4);
      Solver<dim> solver(options, MPI_COMM_SELF);
      solver.solve(
        problem.contacts, problem.keys, problem.rows, problem.unknowns, problem.rigid, 0.01);
      const auto     &v = solver.velocities();
      Velocities<dim> before;
      for (const auto &u : problem.unknowns)
        before.nodes.push_back(u.velocity);
      for (const auto &b : problem.rigid)
        {
          before.rigid.push_back(b.velocity);
          before.spin.push_back(b.spin);
        }
      // What node 3 receives across its wall is taken up there.
      double wall = 0;
      for (unsigned int c = 0; c < problem.contacts.size(); ++c)
        for (unsigned int side = 0; side < 2; ++side)
          for (std::size_t e = problem.rows.begin[2 * c + side];
               e < problem.rows.begin[2 * c + side + 1];
               ++e)
            if (problem.rows.entries[e].unknown == 3)
              wall += (side == 0 ? 1 : -1) * problem.rows.entries[e].weight *
                      solver.impulses().impulse[c][0] * before.nodes[3][0];
      const double change = energy(problem, v) - energy(problem, before) + wall;
      worst_book =
        std::max(worst_book, std::abs(change - solver.report().work) / energy(problem, v));
      most = std::max(most, solver.report().work);
      for (unsigned int c = 0; c < problem.contacts.size(); ++c)
        {
          dealii::Tensor<1, dim> u;
          for (unsigned int side = 0; side < 2; ++side)
            {
              for (std::size_t e = problem.rows.begin[2 * c + side];
                   e < problem.rows.begin[2 * c + side + 1];
                   ++e)
                u += (side == 0 ? 1 : -1) * problem.rows.entries[e].weight *
                     v.nodes[problem.rows.entries[e].unknown];
              if (problem.rows.rigid_body[c][side] >= 0)
                u -= v.rigid[0] +
                     Delassus<dim>::cross(v.spin[0],
                                          problem.contacts[c].place +
                                            problem.contacts[c].gap * problem.contacts[c].normal -
                                            problem.rigid[0].centre);
            }
          const auto  &n      = problem.contacts[c].normal;
          const auto  &P      = solver.impulses().impulse[c];
          const double normal = P * n;
          const auto   Pt = P - normal * n, ut = u - (u * n) * n;
          cone  = std::max(cone, Pt.norm() - 0.3 * normal);
          along = std::max(along, Pt * ut);
          // Where it slides, all of the cone is used, straight against the sliding.
          if (normal > 1e-6 && ut.norm() > 1e-6)
            sliding = std::max(sliding, (Pt + 0.3 * normal * ut / ut.norm()).norm() / normal);
        }
    }
  deallog << dim << "-D " << law_names[static_cast<int>(law)]
          << ": work as booked by kinetic energy and wall " << (worst_book < 1e-12)
          << ", ever positive " << (most > 1e-12) << ", in the cone " << (cone < 1e-13);
  if (law == Law::split)
    deallog << ", against the sliding " << (along < 1e-9) << " " << (sliding < 1e-3);
  deallog << std::endl;
}

/// A block of 5 x 5 points that move together, on 10 x 10 facets in a slope of 30 degrees.
double
slide(const double mu, bool &straight)
{
  const double angle = dealii::numbers::PI / 6, g = 9.81, dt = 1e-3;
  auto         slope = one_body<3>(SurfaceKind::closed, 0, mu);
  add_sheet(slope, 40, 10, [&](const unsigned int i, const unsigned int j) {
    const double s = 0.03 * i - 0.3;
    return dealii::Point<3>(s * std::cos(angle), 0.03 * j, -s * std::sin(angle));
  });
  const dealii::Point<3> down(std::cos(angle), 0, -std::sin(angle)),
    up(std::sin(angle), 0, std::cos(angle));
  Points<3> points;
  points.radius = 0.01;
  for (unsigned int i = 0; i < 25; ++i)
    points.add(dealii::Point<3>(0, 0.04 + 0.05 * (i / 5), 0) + 0.05 * (i % 5) * down + 0.01 * up,
               dealii::Tensor<1, 3>(),
               1. / 25);
  ContactSystem<3>     contacts(ContactOptions(), MPI_COMM_SELF);
  dealii::Tensor<1, 3> v;
  for (unsigned int k = 0; k < 200; ++k)
    {
      v[2] -= g * dt;
      for (unsigned int p = 0; p < points.size(); ++p)
        points.change_velocity(p, v - points.v(p));
      const std::vector<PointSet<3>> sets = {points.set()};
      contacts.find(slope, sets, dt);
      contacts.build_rows(
        [](const unsigned int, const unsigned int, std::vector<Rows::Entry> &entries) {
          entries.push_back({0, 1.});
        },
        [&](const unsigned int) {
          Unknown<3> block;
          block.velocity     = v;
          block.inverse_mass = dealii::Tensor<1, 3>({1., 1., 1.});
          return block;
        });
      contacts.solve({}, dt);
      dealii::Tensor<1, 3> moved;
      contacts.point_impulses([&](const unsigned int, const auto &impulse, const auto &correction) {
        v += impulse;
        moved = correction;
      });
      for (unsigned int p = 0; p < points.size(); ++p)
        points.move(p, dt * v + moved);
      contacts.audit(slope, sets);
    }
  straight = (v - (v * down) * down).norm() < 1e-9 && contacts.report().energy_fed < 1e-15 &&
             contacts.report().n_contacts == 25 && contacts.report().n_penetrations == 0;
  return v * down / (200 * dt);
}

void
incline()
{
  const double angle = dealii::numbers::PI / 6;
  for (const double mu : {0., 0.2, 0.5, 0.7})
    {
      bool         straight = false;
      const double expected = std::max(0., 9.81 * (std::sin(angle) - mu * std::cos(angle))),
                   found    = slide(mu, straight);
      deallog << "incline, mu " << mu << ": g (sin - mu cos) "
              << (std::abs(found - expected) < 1e-6) << ", along the slope, no energy fed "
              << straight << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  one_contact();
  three_on_a_node();
  for (const Law law : {Law::split, Law::blended, Law::stick_slip})
    {
      random_energy<2>(law);
      random_energy<3>(law);
    }
  incline();
}
