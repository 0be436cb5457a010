// SPDX-License-Identifier: GPL-3.0-or-later
// Between particles and grid nothing is lost: mass, momentum, their moments, linear velocities, and
// (APIC) angular momentum are kept to round-off, across hanging nodes and ranks.
#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

// Largest deviation of two sums over all ranks, over a scale.
bool
equal(const double a, const double b, const double scale)
{
  return std::fabs(mpi::sum(a, comm) - mpi::sum(b, comm)) < 1e-12 * mpi::sum(scale, comm);
}

// Particles are sorted, then moved at random: some become strays, some change ranks.
template <int dim>
void
shake(const Scene<dim> &scene, const double margin, MaterialPoints<dim> &points)
{
  using Layout = ParticleLayout<dim>;
  sort_by_leaf(scene.octree, margin, points);
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    for (int d = 0; d < dim; ++d)
      {
        const double reach = margin * points.column(Layout::size)[row];
        const double x =
          points.column(Layout::position + d)[row] + 0.02 * std::sin(17. * points.id(row) + d);
        // Those at the upper corner stay there.
        points.column(Layout::next_position + d)[row] =
          std::min(scene.octree.box().upper_bound(d) - reach,
                   std::max(scene.octree.box().lower_bound(d) + reach,
                            points.id(row) % 100 == 22 ? points.column(Layout::position + d)[row]
                                                       : x));
      }
  move_and_locate(scene.octree, scene.boundary, margin, 0., points);
}

template <int dim>
void
test_gather(const ParticleNeeds &needs, const TransferOptions &options, const bool refined)
{
  using Layout     = ParticleLayout<dim>;
  using Gathered   = typename NodalField<dim>::Gathered;
  auto description = dyadic_box<dim>();
  if (!refined)
    description.refinements.clear();
  Scene<dim>          scene(description);
  MaterialPoints<dim> points("dust", needs);
  add_particles(scene, 420, options.shape == ParticleShape::gimp ? 0.02 : 0., points);
  shake(scene, options.shape == ParticleShape::gimp ? 0.5 : 0., points);

  scene.field.clear();
  particles_to_grid(scene.octree, points, options, Give::mass_and_momentum, scene.field);
  particles_to_grid(scene.octree, points, options, Give::force, scene.field);
  const NodeRecords apart = scene.field.gathered();
  scene.field.clear();
  particles_to_grid(scene.octree, points, options, Give::everything, scene.field);
  double difference = 0;
  for (unsigned int node = 0; node < scene.octree.n_nodes(); ++node)
    for (unsigned int k = 0; k < 8; ++k)
      difference =
        std::max(difference, std::fabs(apart[node][k] - scene.field.gathered()[node][k]));
  scene.field.sum();

  // Sums over particles and nodes: mass and its first moment, momentum, force and its first moment,
  // angular momentum.
  double                 m_p = 0, m_n = 0, scale_f = 0;
  dealii::Tensor<1, dim> x_p, x_n, p_p, p_n, f_n;
  dealii::Tensor<2, dim> s_p, s_n, l_p, l_n;
  bool                   positive = true;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      const double m = points.column(Layout::mass)[row],
                   v = m / points.column(Layout::density)[row];
      const auto x   = points.position(row);
      m_p += m;
      x_p += m * x;
      const int  leaf = points.is_hole(row) ? 0 : scene.octree.find(x);
      const auto xi   = unit_coordinates(scene.octree, leaf, x);
      for (int d = 0; d < dim; ++d)
        {
          const double v_d = points.column(Layout::velocity + d)[row];
          p_p[d] += m * v_d;
          for (int e = 0; e < dim; ++e)
            {
              const double stress =
                needs.isotropic_stress
                  ? (d == e ? -points.column(Layout::stress)[row] : 0.)
                  : points.column(Layout::stress + Symmetric<dim, double>::index(d, e))[row];
              s_p[d][e] -= v * stress;
              scale_f += std::fabs(v * stress) / 0.03;
              l_p[d][e] += m * v_d * x[e];
              if (needs.affine)
                l_p[d][e] += m * points.column(points.layout().affine + dim * d + e)[row] * xi[e] *
                             (1 - xi[e]) * std::pow(scene.octree.size(leaf), 2);
            }
        }
    }
  for (unsigned int i = 0; i < scene.octree.n_owned_nodes(); ++i)
    {
      const NodeRecord &r = scene.field.gathered()[i];
      const auto        x = scene.octree.position(i);
      positive            = positive && r[Gathered::mass] >= 0;
      m_n += r[Gathered::mass];
      x_n += r[Gathered::mass] * x;
      for (int d = 0; d < dim; ++d)
        {
          p_n[d] += r[Gathered::momentum + d];
          f_n[d] += r[Gathered::force + d];
          for (int e = 0; e < dim; ++e)
            {
              s_n[d][e] += r[Gathered::force + d] * x[e];
              l_n[d][e] += r[Gathered::momentum + d] * x[e];
            }
        }
    }
  bool mass = equal(m_p, m_n, m_p), momentum = true, force = true, moment = true, angular = true,
       centre = true;
  // A mean pressure per cell is volume-weighted, so that the sum of all stays; a single one does
  // not.
  for (int d = 0; d < dim; ++d)
    {
      centre   = equal(x_p[d], x_n[d], m_p) && centre;
      momentum = equal(p_p[d], p_n[d], m_p) && momentum;
      force    = equal(f_n[d], 0, scale_f) && force;
      for (int e = 0; e < dim; ++e)
        moment = equal(-s_p[d][e], -s_n[d][e], scale_f) && moment;
      // Cut GIMP particles keep their momentum, but their affine velocity is a fit.
      if (options.shape == ParticleShape::linear)
        for (int e = 0; e < dim; ++e)
          angular = equal(l_p[d][e] - l_p[e][d], l_n[d][e] - l_n[e][d], m_p) && angular;
    }
  deallog << "mass, centre, momentum, force, its moment, angular momentum: " << mass << ' '
          << centre << ' ' << momentum << ' ' << force << ' ' << moment << ' ' << angular
          << std::endl;
  deallog << "in one sweep or in two, nodes have mass >= 0: "
          << (mpi::max(difference, comm) < 1e-12) << ' ' << !mpi::any(!positive, comm) << std::endl;
  deallog << "some particles are strays: " << mpi::any(!points.strays.empty(), comm) << std::endl;

  // And back: what particles then have is what nodes had.
  if (options.velocity == VelocityTransfer::apic && options.shape == ParticleShape::linear)
    {
      scene.field.predict(0., dealii::Tensor<1, dim>());
      grid_to_particles(scene.octree, options, 0., false, scene.field, points);
      dealii::Tensor<2, dim> back;
      dealii::Tensor<1, dim> p_back;
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        if (!points.is_hole(row))
          {
            const double m    = points.column(Layout::mass)[row];
            const auto   x    = points.position(row);
            const int    leaf = scene.octree.find(x);
            const auto   xi   = unit_coordinates(scene.octree, leaf, x);
            for (int d = 0; d < dim; ++d)
              {
                const double v_d = points.column(Layout::velocity + d)[row];
                p_back[d] += m * v_d;
                for (int e = 0; e < dim; ++e)
                  back[d][e] +=
                    m * v_d * x[e] + m * points.column(points.layout().affine + dim * d + e)[row] *
                                       xi[e] * (1 - xi[e]) * std::pow(scene.octree.size(leaf), 2);
              }
          }
      bool kept = true;
      for (int d = 0; d < dim; ++d)
        {
          kept = equal(p_back[d], p_p[d], m_p) && kept;
          // A hanging node follows the mean of its parents, whose spin about it is lost.
          for (int e = 0; e < dim && !refined; ++e)
            kept = equal(back[d][e] - back[e][d], l_p[d][e] - l_p[e][d], m_p) && kept;
        }
      deallog << (refined ? "APIC keeps momentum there and back: "
                          : "APIC keeps momentum and angular momentum there and back: ")
              << kept << std::endl;
    }
}

// A velocity that is linear in space comes back exactly, whatever the cells.
template <int dim>
void
test_linear_field(const ParticleNeeds &needs, const TransferOptions &options)
{
  using Layout   = ParticleLayout<dim>;
  using Gathered = typename NodalField<dim>::Gathered;
  Scene<dim>          scene(dyadic_box<dim>());
  MaterialPoints<dim> points("dust", needs);
  add_particles(scene, 420, options.shape == ParticleShape::gimp ? 0.02 : 0., points);
  shake(scene, options.shape == ParticleShape::gimp ? 0.5 : 0., points);

  const auto a = [](const int d, const int e) { return d == e ? 0.5 + d : 0.3 * d - 0.2 * e; };
  const auto v = [&](const dealii::Point<dim> &x, const int d) {
    double result = 1. + d;
    for (int e = 0; e < dim; ++e)
      result += a(d, e) * x[e];
    return result;
  };
  scene.field.clear();
  for (unsigned int i = 0; i < scene.octree.n_owned_nodes(); ++i)
    if (scene.octree.hanging_index(i) < 0)
      {
        scene.field.gathered()[i][Gathered::mass] = 2.;
        for (int d = 0; d < dim; ++d)
          scene.field.gathered()[i][Gathered::momentum + d] = 2. * v(scene.octree.position(i), d);
      }
  const double           dt = 1e-3;
  dealii::Tensor<1, dim> g;
  g[dim - 1] = -9.81;
  scene.field.predict(dt, g);

  const auto old = points.columns;
  scene.field.clear_momentum();
  grid_to_particles(scene.octree, options, dt, true, scene.field, points);
  bool velocities = true, places = true, gradients = true;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      for (int d = 0; d < dim; ++d)
        {
          const auto   x    = points.position(row);
          const double grid = v(x, d) + dt * g[d],
                       flip = old[Layout::velocity + d][row] + dt * g[d];
          const double expected =
            options.velocity == VelocityTransfer::apic
              ? grid
              : (1 - options.pic_fraction) * flip + options.pic_fraction * grid;
          velocities =
            velocities && std::fabs(points.column(Layout::velocity + d)[row] - expected) < 1e-13;
          places = places && std::fabs(points.column(Layout::next_position + d)[row] - x[d] -
                                       dt * grid) < 1e-13;
          if (needs.affine)
            for (int e = 0; e < dim; ++e)
              gradients =
                gradients && std::fabs(points.column(points.layout().affine + dim * d + e)[row] -
                                       a(d, e)) < 1e-12;
        }
  deallog << "velocities, places, gradients: " << !mpi::any(!velocities, comm) << ' '
          << !mpi::any(!places, comm) << ' ' << !mpi::any(!gradients, comm) << std::endl;

  // The second gathering is the same as a gathering of its own.
  const NodeRecords given = scene.field.gathered();
  scene.field.clear_momentum();
  particles_to_grid(scene.octree, points, options, Give::mass_and_momentum, scene.field);
  double difference = 0;
  for (unsigned int node = 0; node < scene.octree.n_nodes(); ++node)
    for (int d = 0; d < dim; ++d)
      difference = std::max(difference,
                            std::fabs(given[node][Gathered::momentum + d] -
                                      scene.field.gathered()[node][Gathered::momentum + d]));
  deallog << "momenta given back are those gathered afterwards: "
          << (mpi::max(difference, comm) < 1e-12) << std::endl;
}

// The pieces of a cut particle against a sum over its box, in boxes so small that no cell face cuts
// them.
template <int dim>
void
test_cut()
{
  using Layout   = ParticleLayout<dim>;
  using Gathered = typename NodalField<dim>::Gathered;
  ParticleNeeds needs;
  needs.isotropic_stress = true;
  TransferOptions options;
  options.shape = ParticleShape::gimp;
  Scene<dim> scene(dyadic_box<dim>());
  Random     random;
  bool       good = true;
  for (unsigned int i = 0; i < 40; ++i)
    {
      // Multiples of 1/128; all cell faces are multiples of 1/32.
      dealii::Point<dim> x;
      for (int d = 0; d < dim; ++d)
        x[d] =
          std::floor(128 * (1. / 32 + random() * (scene.octree.box().side_length(d) - 1. / 16))) /
          128;
      MaterialPoints<dim> points("one", needs);
      add_particle(scene, x, i, 1. / 32, points);
      sort_by_leaf(scene.octree, 0.5, points);
      scene.field.clear();
      particles_to_grid(scene.octree, points, options, Give::everything, scene.field);
      std::vector<NodeRecord> expected(scene.octree.n_nodes());
      unsigned int            n_boxes = 1;
      for (int d = 0; d < dim; ++d)
        n_boxes *= 8;
      for (unsigned int b = 0; b < n_boxes && points.n_rows() > 0; ++b)
        {
          dealii::Point<dim> y;
          for (int d = 0; d < dim; ++d)
            y[d] = x[d] + ((b >> (3 * d)) % 8 - 3.5) / 256;
          const int    leaf = scene.octree.find(y);
          const double h = scene.octree.size(leaf), m = points.column(Layout::mass)[0] / n_boxes;
          const double pv =
            points.column(Layout::stress)[0] * m / points.column(Layout::density)[0];
          for (unsigned int c = 0; c < scene.octree.n_corners; ++c)
            {
              const unsigned int     node = scene.octree.nodes(leaf)[c];
              double                 n    = 1;
              dealii::Tensor<1, dim> slope;
              for (int d = 0; d < dim; ++d)
                slope[d] = 1;
              for (int d = 0; d < dim; ++d)
                {
                  const double r = y[d] - scene.octree.position(node)[d], w = 1 - std::fabs(r) / h;
                  n *= w;
                  for (int e = 0; e < dim; ++e)
                    slope[e] *= (e == d ? (r > 0 ? -1 : 1) / h : w);
                }
              expected[node][Gathered::mass] += m * n;
              for (int d = 0; d < dim; ++d)
                {
                  expected[node][Gathered::momentum + d] +=
                    m * n * points.column(Layout::velocity + d)[0];
                  expected[node][Gathered::force + d] += pv * slope[d];
                }
            }
        }
      for (unsigned int node = 0; node < scene.octree.n_nodes(); ++node)
        for (unsigned int k = 0; k < 8; ++k)
          good = good && std::fabs(scene.field.gathered()[node][k] - expected[node][k]) < 1e-13;
    }
  deallog << "cut particles equal the sum over their box: " << !mpi::any(!good, comm) << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  for (const ParticleShape shape : {ParticleShape::linear, ParticleShape::gimp})
    for (const bool apic : {false, true})
      for (const bool isotropic : {true, false})
        {
          deallog.push(std::string(shape == ParticleShape::gimp ? "gimp " : "linear ") +
                       (apic ? "apic " : "flip ") + (isotropic ? "fluid" : "solid"));
          ParticleNeeds needs;
          needs.isotropic_stress = isotropic;
          needs.affine           = apic;
          TransferOptions options;
          options.shape        = shape;
          options.velocity     = apic ? VelocityTransfer::apic : VelocityTransfer::flip;
          options.pic_fraction = 0.3;
          test_gather<dim>(needs, options, true);
          if (apic)
            test_gather<dim>(needs, options, false);
          if (isotropic)
            test_linear_field<dim>(needs, options);
          deallog.pop();
        }
  test_cut<dim>();
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
