// SPDX-License-Identifier: GPL-3.0-or-later
// Contact gives the same motion on 1, 2 and 3 ranks, with facets on one rank,
// points on others and a rank with nothing: an elastic-free sheet of nodes is hit
// by points from both sides, with friction; momentum is conserved and nothing
// passes. Points change their rank every few steps and leave the impulses of the
// last step behind: the solution is the same. And points that start in a body are
// found on every rank.

#include <coracle/contact/initial_overlaps.h>

#include "scene.h"

using namespace scene;

/// Facets of row j belong to rank j modulo n, but the last rank of three has none.
template <int dim>
Surface<dim>
own_part(const Surface<dim> &whole, const unsigned int rank, const unsigned int n_ranks)
{
  const unsigned int n_owners = (n_ranks == 3 ? 2 : n_ranks);
  Surface<dim>       part     = whole;
  part.facets.clear();
  for (const auto &facet : whole.facets)
    if ((facet.key / 5) % n_owners == rank)
      part.facets.push_back(facet);
  for (auto &node : part.nodes)
    node.owner = node.key % n_owners;
  return part;
}

Surface<3>
make_sheet()
{
  auto sheet = one_body<3>(SurfaceKind::sheet, 0.01, 0.1);
  add_sheet(
    sheet,
    10,
    10,
    [](const unsigned int i, const unsigned int j) {
      return dealii::Point<3>(0.1 * i, 0.1 * j, 0.02 * std::sin(2. * i + 3. * j));
    },
    0.2);
  return sheet;
}

/// All points; ids are their places in the list.
Points<3>
make_points()
{
  Points<3>                        points;
  std::mt19937                     generator(3);
  std::uniform_real_distribution<> uniform(0, 1);
  points.radius = 0.01;
  for (unsigned int i = 0; i < 200; ++i)
    {
      const double           z = (i % 2 ? 1 : -1) * (0.05 + 0.05 * uniform(generator));
      const dealii::Point<3> x(0.1 + 0.8 * uniform(generator), 0.1 + 0.8 * uniform(generator), z);
      points.add(x, dealii::Tensor<1, 3>({0.5, 0.2, (i % 2 ? -5. : 5.)}), 0.5 + i % 3);
    }
  return points;
}

/// Those of rank `rank` in this step.
Points<3>
own_points(const Points<3>            &all,
           const unsigned int          step,
           const unsigned int          rank,
           const unsigned int          n_ranks,
           std::vector<std::uint64_t> &ids)
{
  Points<3> points;
  points.radius = all.radius;
  ids.clear();
  for (unsigned int i = 0; i < all.size(); ++i)
    {
      // On three ranks the points are on the last two: the second has both, the last no facets.
      const unsigned int shift = i + step,
                         home  = (n_ranks == 3 ? 1 + (shift % 3 == 0) : shift / 7 % n_ranks);
      if (home == rank)
        {
          points.add(all.x(i), all.v(i), all.mass[i]);
          points.side.back() = all.side[i];
          ids.push_back(i);
        }
    }
  return points;
}

/// Everywhere all points as their ranks have them.
void
share(const Points<3> &points, const std::vector<std::uint64_t> &ids, Points<3> &all, MPI_Comm comm)
{
  const unsigned int  n = all.size();
  std::vector<double> values(7 * n);
  for (unsigned int p = 0; p < points.size(); ++p)
    for (unsigned int d = 0; d < 3; ++d)
      {
        values[7 * ids[p] + d]     = points.position[d][p];
        values[7 * ids[p] + 3 + d] = points.velocity[d][p];
        values[7 * ids[p] + 6]     = points.side[p];
      }
  MPI_Allreduce(MPI_IN_PLACE, values.data(), values.size(), MPI_DOUBLE, MPI_SUM, comm);
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int d = 0; d < 3; ++d)
      {
        all.position[d][i] = values[7 * i + d];
        all.velocity[d][i] = values[7 * i + 3 + d];
        all.side[i]        = values[7 * i + 6];
      }
}

struct Result
{
  Points<3>            points;
  dealii::Tensor<1, 3> momentum;
  unsigned long        penetrations;
  bool                 converged;
};

Result
run(MPI_Comm comm)
{
  const unsigned int rank          = dealii::Utilities::MPI::this_mpi_process(comm),
                     n             = dealii::Utilities::MPI::n_mpi_processes(comm);
  const auto                 whole = make_sheet();
  auto                       part  = own_part(whole, rank, n);
  std::vector<std::uint64_t> ids;
  Points<3>                  all = make_points(), points;
  ContactOptions             options;
  options.tolerance          = 1e-11;
  options.maximum_iterations = options.position_iterations = 2000;
  ContactSystem<3> contacts(options, comm);
  const double     dt = 0.001;
  Result           result{{}, {}, 0, true};
  const auto       sum = [comm](std::vector<double> &v) {
    MPI_Allreduce(MPI_IN_PLACE, v.data(), v.size(), MPI_DOUBLE, MPI_SUM, comm);
  };
  for (unsigned int k = 0; k < 60; ++k)
    {
      if (k % 7 == 0)
        {
          points = own_points(all, k, rank, n, ids);
          contacts.points_renumbered();
        }
      auto set = points.set();
      set.ids  = ids.data();
      contacts.find(part, {set}, dt);
      contacts.build_rows(
        [](const unsigned int, const unsigned int p, std::vector<Rows::Entry> &entries) {
          entries.push_back({p, 1.});
        },
        [&](const unsigned int p) {
          Unknown<3> u;
          u.velocity = points.v(p);
          for (int d = 0; d < 3; ++d)
            u.inverse_mass[d] = 1. / points.mass[p];
          u.key   = ids[p];
          u.owner = rank;
          return u;
        });
      contacts.solve({}, dt);
      result.converged = result.converged && contacts.report().solver.velocity.converged;
      std::vector<dealii::Tensor<1, 3>> moved(points.size()), nodal(part.nodes.size()),
        nodal_move(part.nodes.size());
      contacts.point_impulses([&](const unsigned int          p,
                                  const dealii::Tensor<1, 3> &impulse,
                                  const dealii::Tensor<1, 3> &c) {
        points.change_velocity(p, impulse / points.mass[p]);
        moved[p] = c / points.mass[p];
      });
      contacts.surface_impulses(nodal, nodal_move);
      for (unsigned int p = 0; p < points.size(); ++p)
        points.move(p, dt * points.v(p) + moved[p]);
      // All copies of a node get the sum, as with element forces.
      std::vector<double> shared(6 * nodal.size());
      for (unsigned int i = 0; i < nodal.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          {
            shared[6 * i + d]     = nodal[i][d];
            shared[6 * i + 3 + d] = nodal_move[i][d];
          }
      sum(shared);
      for (unsigned int i = 0; i < nodal.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          {
            auto &node = part.nodes[i];
            node.velocity[d] += node.inverse_mass[d] * shared[6 * i + d];
            node.position[d] +=
              dt * node.velocity[d] + node.inverse_mass[d] * shared[6 * i + 3 + d];
          }
      contacts.audit(part, {set});
      share(points, ids, all, comm);
    }
  result.points = all;
  for (unsigned int d = 0; d < 3; ++d)
    {
      for (unsigned int p = 0; p < all.size(); ++p)
        result.momentum[d] += all.mass[p] * all.velocity[d][p];
      for (const auto &node : part.nodes)
        result.momentum[d] += node.velocity[d] / node.inverse_mass[d];
    }
  result.penetrations = contacts.report().n_penetrations;
  return result;
}

void
overlaps(MPI_Comm comm)
{
  // A block; points deep inside, near its face from inside and outside, on R, and far.
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(comm),
                     n    = dealii::Utilities::MPI::n_mpi_processes(comm);
  auto block              = one_body<2>(SurfaceKind::closed);
  if (rank == 0)
    add_polyline(block,
                 {dealii::Point<2>(0, 0),
                  dealii::Point<2>(1, 0),
                  dealii::Point<2>(1, 1),
                  dealii::Point<2>(0, 1)},
                 true);
  Points<2> points;
  points.radius = 0.01;
  std::vector<std::uint64_t> ids;
  const dealii::Point<2>     places[] = {
        {0.5, 0.5}, {0.5, 0.995}, {0.5, 1.004}, {0.5, 1.01}, {0.5, 1.5}, {1.5, 0.5}, {0.25, 0.}};
  for (unsigned int i = 0; i < 7; ++i)
    if (i % n == rank)
      {
        points.add(places[i], dealii::Tensor<1, 2>());
        ids.push_back(i);
      }
  auto set = points.set();
  set.ids  = ids.data();
  std::vector<double> depth(7);
  for (const auto &overlap : initial_overlaps<2>(block, {set}, comm))
    depth[overlap.id] = std::min(overlap.depth, 9.);
  MPI_Allreduce(MPI_IN_PLACE, depth.data(), 7, MPI_DOUBLE, MPI_SUM, comm);
  deallog << "depths at the start:";
  for (const double d : depth)
    deallog << " " << filter_out_small_numbers(d);
  deallog << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  const Result alone = run(MPI_COMM_SELF), together = run(MPI_COMM_WORLD);
  double       worst = 0, before = 0;
  for (unsigned int i = 0; i < 200; ++i)
    worst = std::max(worst, alone.points.x(i).distance(together.points.x(i)));
  for (unsigned int i = 0; i < 200; ++i)
    before += 0.5 * (0.5 + i % 3);
  deallog << "converged " << (alone.converged && together.converged) << ", same places to 1e-8 "
          << (worst < 1e-8) << ", momentum " << (std::abs(alone.momentum[0] - before) < 1e-11)
          << " " << (std::abs(together.momentum[0] - before) < 1e-11) << ", penetrations "
          << alone.penetrations + together.penetrations << std::endl;
  overlaps(MPI_COMM_WORLD);
}
