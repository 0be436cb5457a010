// SPDX-License-Identifier: GPL-3.0-or-later
// The contact solver finds the solution that trying all active sets finds, on 1,
// 2 or 3 ranks (one of them without contacts) alike; friction slides a block with
// exactly mu g and holds it below; momentum and angular momentum are conserved to
// round-off, also with a rigid body. Many problems solved as one have their own
// solutions, although those that are solved first rest while others go on.

#include <deal.II/lac/lapack_full_matrix.h>

#include "random_contacts.h"

/// All active sets, without friction: velocities of the unknowns in the solution.
std::vector<dealii::Tensor<1, 2>>
try_all(const Problem<2> &problem, const double dt)
{
  const unsigned int         n = problem.contacts.size(), m = 2 * problem.unknowns.size();
  dealii::FullMatrix<double> J(n, m), A(n, n);
  dealii::Vector<double>     v(m), w(m), missing(n);
  for (unsigned int i = 0; i < m; ++i)
    {
      v(i) = problem.unknowns[i / 2].velocity[i % 2];
      w(i) = problem.unknowns[i / 2].inverse_mass[i % 2];
    }
  for (unsigned int c = 0; c < n; ++c)
    for (unsigned int side = 0; side < 2; ++side)
      for (std::size_t e = problem.rows.begin[2 * c + side];
           e < problem.rows.begin[2 * c + side + 1];
           ++e)
        for (unsigned int d = 0; d < 2; ++d)
          J(c, 2 * problem.rows.entries[e].unknown + d) +=
            (side == 0 ? 1 : -1) * problem.rows.entries[e].weight * problem.contacts[c].normal[d];
  for (unsigned int c = 0; c < n; ++c)
    {
      missing(c) = problem.target(c, dt);
      for (unsigned int i = 0; i < m; ++i)
        missing(c) -= J(c, i) * v(i);
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int i = 0; i < m; ++i)
          A(c, k) += J(c, i) * w(i) * J(k, i);
    }
  for (unsigned int set = 0; set < (1u << n); ++set)
    {
      // Rows outside the set are those of a unit matrix with nothing asked for.
      dealii::LAPACKFullMatrix<double> a(n, n);
      dealii::Vector<double>           b(n), lambda(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          const bool active = set & (1u << i);
          b(i)              = active ? missing(i) : 0.;
          for (unsigned int j = 0; j < n; ++j)
            a(i, j) = (active && set & (1u << j)) ? A(i, j) : (i == j && !active);
        }
      // More contacts than unknowns: the smallest of many solutions.
      a.compute_inverse_svd(1e-12);
      a.vmult(lambda, b);
      bool solves = true;
      for (unsigned int i = 0; i < n; ++i)
        {
          double change = 0;
          for (unsigned int j = 0; j < n; ++j)
            change += A(i, j) * lambda(j);
          solves = solves && lambda(i) >= -1e-10 && change - missing(i) >= -1e-10;
        }
      if (!solves)
        continue;
      std::vector<dealii::Tensor<1, 2>> result(problem.unknowns.size());
      for (unsigned int i = 0; i < m; ++i)
        {
          result[i / 2][i % 2] = v(i);
          for (unsigned int c = 0; c < n; ++c)
            result[i / 2][i % 2] += w(i) * J(c, i) * lambda(c);
        }
      return result;
    }
  AssertThrow(false, dealii::ExcInternalError());
  return {};
}

/// Against all active sets, and parts on several ranks against the whole on one.
template <int dim>
void
compare(const double friction, const bool with_rigid)
{
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  double worst = 0, worst_oracle = 0, momentum = 0;
  bool   converged = true;
  for (unsigned int seed = 0; seed < 30; ++seed)
    {
      const Problem<dim> whole(9, seed, friction, with_rigid), part = whole.part(rank, n_ranks);
      Solver<dim>        serial(sharp(), MPI_COMM_SELF), parallel(sharp(), MPI_COMM_WORLD);
      const double       dt = 0.01;
      serial.solve(whole.contacts, whole.keys, whole.rows, whole.unknowns, whole.rigid, dt);
      parallel.solve(part.contacts, part.keys, part.rows, part.unknowns, part.rigid, dt);
      converged =
        converged && serial.report().velocity.converged && parallel.report().velocity.converged;
      const auto &v = serial.velocities();
      for (unsigned int i = 0; i < part.unknowns.size(); ++i)
        worst =
          std::max(worst,
                   (parallel.velocities().nodes[i] - v.nodes[part.unknowns[i].key / 77]).norm());
      if (with_rigid && !part.contacts.empty())
        worst = std::max(worst, (parallel.velocities().spin[0] - v.spin[0]).norm());
      if constexpr (dim == 2)
        if (friction == 0 && !with_rigid)
          {
            const auto exact = try_all(whole, dt);
            for (unsigned int i = 0; i < exact.size(); ++i)
              worst_oracle = std::max(worst_oracle, (exact[i] - v.nodes[i]).norm());
          }
      // Momentum of what is free to move in y.
      dealii::Tensor<1, dim> change;
      for (unsigned int i = 0; i < whole.unknowns.size(); ++i)
        change[1] +=
          (v.nodes[i][1] - whole.unknowns[i].velocity[1]) / whole.unknowns[i].inverse_mass[1];
      if (with_rigid)
        change[1] += (v.rigid[0][1] - whole.rigid[0].velocity[1]) / whole.rigid[0].inverse_mass[1];
      momentum = std::max(momentum, std::abs(change[1]));
    }
  worst = dealii::Utilities::MPI::max(worst, MPI_COMM_WORLD);
  deallog << dim << "-D, friction " << friction << ", rigid " << with_rigid << ": converged "
          << converged << ", ranks agree to 1e-7 " << (worst < 1e-7) << ", as all active sets "
          << (worst_oracle < 1e-8) << ", momentum " << (momentum < 1e-13) << std::endl;
}

/// Many problems as one against each by itself.
template <int dim>
void
many(const double friction)
{
  const unsigned int rank                = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks             = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const double                        dt = 0.01;
  Problem<dim>                        whole(9, 0, friction, true);
  std::vector<dealii::Tensor<1, dim>> expected, expected_rigid;
  for (unsigned int seed = 0; seed < 40; ++seed)
    {
      const Problem<dim> one(9, seed, friction, true);
      Solver<dim>        solver(sharp(), MPI_COMM_SELF);
      solver.solve(one.contacts, one.keys, one.rows, one.unknowns, one.rigid, dt);
      const auto v = solver.velocities();
      expected.insert(expected.end(), v.nodes.begin(), v.nodes.end());
      expected_rigid.push_back(v.rigid[0]);
      if (seed > 0)
        whole.append(one);
    }
  const Problem<dim> part = whole.part(rank, n_ranks);
  Solver<dim>        solver(sharp(), MPI_COMM_WORLD);
  solver.solve(part.contacts, part.keys, part.rows, part.unknowns, part.rigid, dt);
  const auto v     = solver.velocities();
  double     worst = 0;
  for (unsigned int i = 0; i < part.unknowns.size(); ++i)
    worst = std::max(worst, (v.nodes[i] - expected[part.unknowns[i].key / 77]).norm());
  for (unsigned int b = 0; b < part.rigid.size() && !part.contacts.empty(); ++b)
    worst = std::max(worst, (v.rigid[b] - expected_rigid[b]).norm());
  worst = dealii::Utilities::MPI::max(worst, MPI_COMM_WORLD);
  // On one rank all is there, and momentum can be added up.
  double momentum = 0;
  for (unsigned int i = 0; i < part.unknowns.size() && n_ranks == 1; ++i)
    momentum += (v.nodes[i][1] - part.unknowns[i].velocity[1]) / part.unknowns[i].inverse_mass[1];
  for (unsigned int b = 0; b < part.rigid.size() && n_ranks == 1; ++b)
    momentum += (v.rigid[b][1] - part.rigid[b].velocity[1]) / part.rigid[b].inverse_mass[1];
  deallog << dim << "-D, friction " << friction << ", 40 at once: converged "
          << solver.report().velocity.converged << ", each as by itself to 1e-7 " << (worst < 1e-7)
          << ", momentum " << (std::abs(momentum) < 1e-12) << std::endl;
}

/// A block on a plate: it slides, slows down with mu g, and stays.
void
friction()
{
  const double mu = 0.3, g = 9.81, dt = 1e-3;
  auto         plate = one_body<3>(SurfaceKind::closed, 0, mu);
  add_sheet(plate, 20, 2, [](const unsigned int i, const unsigned int j) {
    return dealii::Point<3>(0.1 * i - 0.5, 0.5 * j - 0.5, 0);
  });
  Points<3> points;
  points.radius = 0.01;
  points.add(dealii::Point<3>(0, 0.1, 0.01), dealii::Tensor<1, 3>({1.2, 0.5, 0.}), 2.);
  ContactSystem<3>             contacts(ContactOptions(), MPI_COMM_SELF);
  std::vector<RigidUnknown<3>> rigid;
  double                       worst = 0;
  for (unsigned int k = 1; k <= 600; ++k)
    {
      points.velocity[2][0] -= g * dt;
      step(contacts, plate, points, rigid, dt);
      const double expected = std::max(0., 1.3 - mu * g * dt * k);
      worst =
        std::max(worst,
                 std::abs(std::hypot(points.velocity[0][0], points.velocity[1][0]) - expected));
    }
  deallog << "sliding block: speed is 1.3 - mu g t, then 0: " << (worst < 1e-5)
          << ", direction kept "
          << (std::abs(points.position[1][0] - 0.1 - 0.5 / 1.2 * points.position[0][0]) < 1e-6)
          << std::endl;
}

/// A particle strikes a free rigid body off its centre, with friction.
template <int dim>
void
angular_momentum()
{
  RigidUnknown<dim> body;
  for (int d = 0; d < dim; ++d)
    body.inverse_mass[d] = 0.25;
  for (unsigned int d = 0; d < 3; ++d)
    body.inverse_inertia[d][d] = 1. / (1 + d);
  std::vector<RigidUnknown<dim>> rigid   = {body};
  auto                           surface = one_body<dim>(SurfaceKind::closed, 0, 0.4);
  surface.bodies[0].rigid_body           = 0;
  if constexpr (dim == 2)
    add_polyline(surface, {dealii::Point<2>(1, 0.5), dealii::Point<2>(-1, 0.5)}, false);
  else
    add_sheet(surface, 2, 2, [](const unsigned int i, const unsigned int j) {
      return dealii::Point<3>(i - 1., j - 1., 0.5);
    });
  Points<dim> points;
  points.radius = 0.1;
  dealii::Point<dim>     x;
  dealii::Tensor<1, dim> v0;
  x[0]        = 0.7;
  x[dim - 1]  = 0.56;
  v0[0]       = 3;
  v0[dim - 1] = -2;
  points.add(x, v0, 1.5);
  ContactSystem<dim> contacts(ContactOptions(), MPI_COMM_SELF);
  step(contacts, surface, points, rigid, 0.01);
  const auto &given  = contacts.rigid_impulses()[0];
  const auto  taken  = 1.5 * (points.v(0) - v0);
  const auto  moment = Delassus<dim>::torque(dealii::Tensor<1, dim>(x), taken);
  deallog << dim << "-D: momentum " << ((given.impulse + taken).norm() < 1e-14)
          << ", angular momentum " << ((given.moment + moment).norm() < 1e-14) << ", cone "
          << (std::abs(taken[0]) <= 0.4 * taken[dim - 1] * (1 + 1e-12)) << ", something happened "
          << (taken.norm() > 1) << std::endl;
}

/// The blended law turns the share alpha of the depth into velocity (Song, Liu & Zhang 2020, Eq.
/// 65).
void
blended()
{
  auto plate = one_body<2>(SurfaceKind::closed);
  add_polyline(plate, {dealii::Point<2>(1, 0), dealii::Point<2>(-1, 0)}, false);
  Points<2> points;
  points.radius = 0.01;
  points.add(dealii::Point<2>(0, 0.008), dealii::Tensor<1, 2>({1., -3.}));
  points.add(dealii::Point<2>(0.3, 0.0105), dealii::Tensor<1, 2>({0., -3.}));
  ContactOptions options;
  options.law   = Law::blended;
  options.alpha = 0.4;
  ContactSystem<2>             contacts(options, MPI_COMM_SELF);
  std::vector<RigidUnknown<2>> rigid;
  step(contacts, plate, points, rigid, 0.001);
  deallog << "blended: " << points.velocity[1][0]
          << " (0.8), not yet in contact: " << points.velocity[1][1] << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  for (const double mu : {0., 0.3})
    for (const bool with_rigid : {false, true})
      {
        compare<2>(mu, with_rigid);
        compare<3>(mu, with_rigid);
      }
  for (const double mu : {0., 0.3})
    {
      many<2>(mu);
      many<3>(mu);
    }
  friction();
  angular_momentum<2>();
  angular_momentum<3>();
  blended();
}
