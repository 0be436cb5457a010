// SPDX-License-Identifier: GPL-3.0-or-later
// Impulses on nodes are all found again as momentum, but for those that walls take; corrections
// move particles and leave velocities alone; the energy of the nodes is booked. The same on any
// number of ranks.
#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

// Every owned leaf pushes at a point inside of it: through hanging nodes, to nodes of other ranks
// too.
template <int dim>
void
push(Scene<dim>             &scene,
     dealii::Tensor<1, dim> &total_impulse,
     dealii::Tensor<1, dim> &total_correction)
{
  for (unsigned int leaf = 0; leaf < scene.octree.n_owned_leaves(); ++leaf)
    {
      const double           h = scene.octree.size(leaf);
      dealii::Point<dim>     x = scene.octree.lower(leaf);
      dealii::Tensor<1, dim> impulse, correction;
      for (int d = 0; d < dim; ++d)
        {
          x[d] += h * (0.3 + 0.1 * d);
          impulse[d]    = std::sin(20 * x[0] + d);
          correction[d] = 0.01 * std::cos(20 * x[1] + d);
        }
      const auto give = [&](const unsigned int node, const double weight) {
        scene.field.add_impulse(node, weight * impulse, weight * correction);
        for (int d = 0; d < dim; ++d)
          if (scene.field.inverse_mass(node)[d] > 0)
            {
              total_impulse[d] += weight * impulse[d];
              total_correction[d] += weight * correction[d];
            }
      };
      const CornerShape<dim> shape(unit_coordinates(scene.octree, leaf, x));
      for (unsigned int c = 0; c < scene.octree.n_corners; ++c)
        {
          const unsigned int node    = scene.octree.nodes(leaf)[c];
          const int          hanging = scene.octree.hanging_index(node);
          if (hanging < 0)
            give(node, shape.value[c]);
          else
            for (const auto &[parent, share] : scene.octree.hanging_nodes()[hanging].parents)
              give(parent, share * shape.value[c]);
        }
    }
}

template <int dim>
void
test(const FaceCondition faces)
{
  using Layout = ParticleLayout<dim>;
  using Motion = typename NodalField<dim>::Motion;
  deallog.push(std::to_string(dim) + "d " +
               (faces == FaceCondition::slip    ? "slip"
                : faces == FaceCondition::stick ? "stick"
                                                : "open"));
  Scene<dim>    scene(dyadic_box<dim>(), faces);
  ParticleNeeds needs;
  needs.isotropic_stress = true;
  MaterialPoints<dim> points("dust", needs);
  add_particles(scene, 600, 0., points);
  sort_by_leaf(scene.octree, 0., points);
  TransferOptions options;
  auto           &field = scene.field;
  field.clear();
  particles_to_grid(scene.octree, points, options, Give::mass_and_momentum, field);
  field.sum();
  const double           dt = 0.01;
  dealii::Tensor<1, dim> gravity;
  gravity[dim - 1] = -10.;
  field.predict(dt, gravity);
  const auto momentum_before = mpi::sum(field.momentum(), comm);
  if (faces == FaceCondition::open)
    {
      double                 m = 0;
      dealii::Tensor<1, dim> p;
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        {
          m += points.column(Layout::mass)[row];
          for (int d = 0; d < dim; ++d)
            p[d] += points.column(Layout::mass)[row] *
                    (points.column(Layout::velocity + d)[row] + dt * gravity[d]);
        }
      deallog << "gravity adds m g dt: "
              << ((mpi::sum(p, comm) - momentum_before).norm() < 1e-12 * mpi::sum(m, comm))
              << std::endl;
    }

  const auto  &e       = field.energies();
  const double balance = e.given - e.gathered - e.gravity + e.boundary;
  deallog << "energy is booked: "
          << (std::fabs(mpi::sum(balance, comm)) < 1e-10 * mpi::sum(e.given, comm))
          << ", boundary takes some: " << mpi::any(e.boundary > 0, comm) << std::endl;

  dealii::Tensor<1, dim> impulse, correction;
  push(scene, impulse, correction);
  field.apply_impulses();
  impulse = mpi::sum(impulse, comm);
  deallog << "impulses become momentum: "
          << ((mpi::sum(field.momentum(), comm) - momentum_before - impulse).norm() < 1e-11)
          << std::endl;

  bool   walls = true, hanging_follow = true, copies = true;
  double checksum = 0, energy = 0;
  auto   from_owners = field.motion();
  scene.octree.exchange.update_ghosts(from_owners);
  dealii::Tensor<1, dim> moved;
  for (unsigned int node = 0; node < scene.octree.n_nodes(); ++node)
    {
      const auto v = field.velocity(node);
      for (int d = 0; d < dim; ++d)
        {
          if (scene.boundary.fixed(node) & (1u << d))
            walls = walls && v[d] == 0 && field.shift(node)[d] == 0;
          copies = copies && std::fabs(from_owners[node][Motion::velocity + d] - v[d]) < 1e-13 &&
                   std::fabs(from_owners[node][Motion::change + d] -
                             field.motion()[node][Motion::change + d]) < 1e-13;
        }
      if (node < scene.octree.n_owned_nodes() && scene.octree.hanging_index(node) < 0)
        {
          energy += 0.5 * field.motion()[node][Motion::mass] * v.norm_square();
          checksum += v.norm_square() + 1e3 * field.shift(node).norm_square();
          for (int d = 0; d < dim; ++d)
            moved[d] += field.motion()[node][Motion::mass] * field.shift(node)[d];
        }
      if (scene.octree.hanging_index(node) >= 0)
        {
          dealii::Tensor<1, dim> mean, shift;
          for (const auto &[parent, weight] :
               scene.octree.hanging_nodes()[scene.octree.hanging_index(node)].parents)
            {
              mean += weight * field.velocity(parent);
              shift += weight * field.shift(parent);
            }
          hanging_follow = hanging_follow && (mean - v).norm() < 1e-13 &&
                           (shift - field.shift(node)).norm() < 1e-15;
        }
    }
  deallog << "walls stand, hanging nodes follow, ghosts equal owners: " << !mpi::any(!walls, comm)
          << ' ' << !mpi::any(!hanging_follow, comm) << ' ' << !mpi::any(!copies, comm)
          << std::endl;
  deallog << "corrections move the centre of mass as they should: "
          << ((mpi::sum(moved, comm) - mpi::sum(correction, comm)).norm() < 1e-12) << std::endl;
  deallog << "velocities: " << mpi::sum(checksum, comm) << std::endl;

  deallog << "energy given is that of the nodes: "
          << (std::fabs(mpi::sum(field.energies().given - energy, comm)) <
              1e-10 * mpi::sum(energy, comm))
          << std::endl;

  // Particles: moved by velocity and correction, their own velocity changed without the correction.
  const auto old       = points.columns;
  options.pic_fraction = 0;
  grid_to_particles(scene.octree, options, dt, false, field, points);
  dealii::Tensor<1, dim> dp, dx;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    for (int d = 0; d < dim; ++d)
      {
        const double m = points.column(Layout::mass)[row];
        dp[d] += m * (points.column(Layout::velocity + d)[row] - old[Layout::velocity + d][row]);
        dx[d] +=
          m * (points.column(Layout::next_position + d)[row] - old[Layout::position + d][row]);
      }
  dealii::Tensor<1, dim> p_0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    for (int d = 0; d < dim; ++d)
      p_0[d] += old[Layout::mass][row] * old[Layout::velocity + d][row];
  const auto p_nodes = mpi::sum(field.momentum(), comm);
  deallog << "particles take the momentum: "
          << ((mpi::sum(dp, comm) + mpi::sum(p_0, comm) - p_nodes).norm() < 1e-10)
          << ", and move with it and the corrections: "
          << ((mpi::sum(dx, comm) - dt * p_nodes - mpi::sum(correction, comm)).norm() < 1e-10)
          << std::endl;

  // The next step knows nothing of it.
  field.clear();
  bool forgotten = !field.has_shift();
  for (unsigned int node = 0; node < scene.octree.n_nodes(); ++node)
    forgotten = forgotten && field.shift(node).norm() == 0 && !field.is_shifted(node);
  deallog << "corrections are forgotten: " << !mpi::any(!forgotten, comm) << std::endl;
  deallog.pop();
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  for (const FaceCondition faces : {FaceCondition::open, FaceCondition::slip, FaceCondition::stick})
    {
      test<2>(faces);
      test<3>(faces);
    }
}
