// SPDX-License-Identifier: GPL-3.0-or-later
// Where a sheet splits the nodes, particles on one side leave those on the other alone to
// round-off, also across hanging nodes and ranks; beyond its rim they feel each other. A split that
// hides every node from everybody changes nothing at all.
#include <coracle/grid/point_cutter.h>

#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

// y (z) = height + slope x, ending at x = rim: on which side, and does a way meet it?
template <int dim>
struct Sheet
{
  double height, slope, rim;

  double above(const dealii::Point<dim> &x) const { return x[dim - 1] - height - slope * x[0]; }

  std::uint64_t between(const dealii::Point<dim> &p, const dealii::Point<dim> &q) const
  {
    const double a = above(p), b = above(q);
    if ((a >= 0) == (b >= 0))
      return 0;
    const auto place = p + a / (a - b) * (q - p);
    return place[0] < rim ? 1 : 0;
  }
};

template <int dim>
struct Case
{
  Case(const ParticleNeeds &needs, const TransferOptions &options)
    : options(options)
    , margin(options.shape == ParticleShape::gimp ? 0.5 : 0.)
    , scene(dyadic_box<dim>(), FaceCondition::slip)
    , split(scene.octree)
    , field(scene.octree, scene.boundary, &split)
    , points("dust", needs)
  {
    add_particles(scene, 500, margin > 0 ? 0.02 : 0., points);
    sort_by_leaf(scene.octree, margin, points);
  }

  template <typename Between>
  unsigned int cut(const Between &between)
  {
    split.clear();
    PointCutter<dim> cutter(scene.octree, margin, split, points);
    for (std::size_t row = 0; row < points.n_rows(); ++row)
      cutter.cut(row, scene.octree.find(points.position(row)), [&](const unsigned int node) {
        return between(points.position(row), scene.octree.position(node));
      });
    cutter.finish();
    split.share();
    return mpi::sum(points.cuts.size(), comm);
  }

  void gather()
  {
    field.clear();
    particles_to_grid(scene.octree, points, options, Give::everything, field);
    field.sum();
  }

  TransferOptions     options;
  double              margin;
  Scene<dim>          scene;
  NodeSplit<dim>      split;
  NodalField<dim>     field;
  MaterialPoints<dim> points;
};

// Both sides move as one each, in opposite directions, without stress.
template <int dim>
void
test_sides(Case<dim> &c, const Sheet<dim> &sheet)
{
  using Layout                  = ParticleLayout<dim>;
  using Gathered                = typename NodalField<dim>::Gathered;
  auto                  &points = c.points;
  double                 mass = 0, nodal_mass = 0;
  dealii::Tensor<1, dim> momentum, nodal_momentum;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      const double m = points.column(Layout::mass)[row];
      mass += m;
      for (int k = 0; k < points.layout().n_stress; ++k)
        points.column(Layout::stress + k)[row] = 0;
      for (int d = 0; d < dim; ++d)
        {
          const double v =
            (sheet.above(points.position(row)) >= 0 ? 1. : -2.) * (d == 1 ? 0 : 1 + d);
          points.column(Layout::velocity + d)[row] = v;
          momentum[d] += m * v;
          for (int e = 0; e < dim && points.layout().affine >= 0; ++e)
            points.column(points.layout().affine + dim * d + e)[row] = 0;
        }
    }
  const auto         old = points.columns;
  const unsigned int n_cut =
    c.cut([&](const auto &p, const auto &q) { return sheet.between(p, q); });
  c.gather();
  for (unsigned int record = 0; record < c.split.n_records(); ++record)
    if (c.split.is_owned(record))
      {
        nodal_mass += c.field.gathered()[record][Gathered::mass];
        for (int d = 0; d < dim; ++d)
          nodal_momentum[d] += c.field.gathered()[record][Gathered::momentum + d];
      }
  c.field.predict(0., dealii::Tensor<1, dim>());
  c.field.clear_momentum();
  grid_to_particles(c.scene.octree, c.options, 1., true, c.field, points);
  c.field.sum();
  c.field.remap();
  // What a particle does now that it did not before: near walls of the box, and past the rim.
  bool         own   = true;
  unsigned int mixed = 0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      bool inner = true;
      for (int d = 0; d < dim; ++d)
        inner = inner && points.position(row)[d] > 0.26 &&
                points.position(row)[d] < c.scene.octree.box().upper_bound(d) - 0.26;
      double change = 0;
      for (int d = 0; d < dim; ++d)
        change = std::max(
          {change,
           std::fabs(points.column(Layout::velocity + d)[row] - old[Layout::velocity + d][row]),
           std::fabs(points.column(Layout::next_position + d)[row] - points.position(row)[d] -
                     old[Layout::velocity + d][row])});
      if (inner && points.position(row)[0] < sheet.rim - 0.26)
        own = own && change < 1e-13;
      else if (points.position(row)[0] > sheet.rim)
        mixed += change > 1e-3;
    }
  const double scale = mpi::sum(mass, comm);
  deallog << "cut " << n_cut << ", each side keeps its velocity " << !mpi::any(!own, comm)
          << ", mass and momentum kept "
          << (std::fabs(mpi::sum(nodal_mass - mass, comm)) < 1e-13 * scale) << ' '
          << (mpi::sum(nodal_momentum - momentum, comm).norm() < 1e-13 * scale)
          << ", particles beyond the rim that feel both sides " << mpi::sum(mixed, comm)
          << std::endl;
}

// All nodes hidden from all particles: everything happens on extra records, as it did before.
template <int dim>
void
test_all_hidden(const ParticleNeeds &needs, const TransferOptions &options)
{
  std::array<std::vector<std::vector<double>>, 2> result;
  std::array<dealii::Tensor<1, dim>, 2>           momentum;
  std::array<double, 2>                           energy;
  for (unsigned int hidden = 0; hidden < 2; ++hidden)
    {
      Case<dim> c(needs, options);
      if (hidden)
        c.cut([](const auto &, const auto &) { return 1; });
      c.gather();
      dealii::Tensor<1, dim> gravity;
      gravity[dim - 1] = -9.81;
      c.field.predict(1e-3, gravity);
      momentum[hidden] = mpi::sum(c.field.momentum(), comm);
      const auto &e    = c.field.energies();
      energy[hidden]   = mpi::sum(e.given + 2 * e.gathered + 3 * e.gravity + 4 * e.boundary, comm);
      c.field.clear_momentum();
      energy[hidden] +=
        mpi::sum(grid_to_particles(c.scene.octree, options, 1e-3, true, c.field, c.points), comm);
      c.field.sum();
      c.field.remap();
      for (unsigned int k = 0; k < c.points.columns.n_columns(); ++k)
        result[hidden].emplace_back(c.points.column(k), c.points.column(k) + c.points.n_rows());
    }
  double difference = 0;
  for (std::size_t k = 0; k < result[0].size(); ++k)
    for (std::size_t row = 0; row < result[0][k].size(); ++row)
      difference = std::max(difference, std::fabs(result[0][k][row] - result[1][k][row]));
  deallog << "all hidden is as none hidden " << (mpi::max(difference, comm) < 1e-11) << ' '
          << ((momentum[0] - momentum[1]).norm() < 1e-10) << ' '
          << (std::fabs(energy[0] - energy[1]) < 1e-10 * energy[0]) << std::endl;
}

template <int dim>
void
test()
{
  for (const bool gimp : {false, true})
    for (const bool apic : {false, true})
      {
        deallog.push(std::to_string(dim) + "d " + (gimp ? "gimp " : "linear ") +
                     (apic ? "apic" : "flip"));
        ParticleNeeds needs;
        needs.isotropic_stress = gimp != apic;
        needs.affine           = apic;
        TransferOptions options;
        options.shape            = gimp ? ParticleShape::gimp : ParticleShape::linear;
        options.velocity         = apic ? VelocityTransfer::apic : VelocityTransfer::flip;
        options.pic_fraction     = 0.3;
        options.average_pressure = !apic;
        const double height      = 0.45;
        // Askew through refined and coarse cells; along faces of cells, so that nodes are on it.
        for (const Sheet<dim> &sheet : {Sheet<dim>{height - 0.1, 0.3, 10.},
                                        Sheet<dim>{dim == 2 ? 0.5 : 0.25, 0., 10.},
                                        Sheet<dim>{dim == 2 ? 0.5 : 0.25, 0., 0.4}})
          {
            Case<dim> c(needs, options);
            test_sides(c, sheet);
          }
        test_all_hidden<dim>(needs, options);
        deallog.pop();
      }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
