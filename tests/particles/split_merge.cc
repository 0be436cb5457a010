// SPDX-License-Identifier: GPL-3.0-or-later
// Splitting and merging keep mass, centre of mass, momentum, angular momentum and volume to
// round-off, in the plane and in space, with and without affine velocity; a particle that split and
// merged is what it was.
#include <coracle/particles/split_merge.h>

#include <random>

#include "tests.h"

using namespace coracle;

std::mt19937 generator(4711);

double
random_number()
{
  return generator() / 2147483648. - 1.;
}

// Sums over particles, and the largest terms of the vector sums as their scale.
template <int dim>
struct Sums
{
  double                 mass = 0, volume = 0, kinetic = 0, spin_scale = 0;
  dealii::Tensor<1, dim> centre, momentum;
  /// x_i v_j - x_j v_i of all pairs, boxes that turn included.
  dealii::Tensor<2, dim> spin;

  explicit Sums(const MaterialPoints<dim> &points)
  {
    using Layout = ParticleLayout<dim>;
    for (std::size_t row = 0; row < points.n_rows(); ++row)
      {
        if (points.is_hole(row))
          continue;
        const auto   get = [&](const int column) { return points.column(column)[row]; };
        const double m = get(Layout::mass), s = get(Layout::size);
        mass += m;
        volume += m / get(Layout::density);
        for (int i = 0; i < dim; ++i)
          {
            const double v = get(Layout::velocity + i), x = get(Layout::position + i);
            centre[i] += m * x;
            momentum[i] += m * v;
            kinetic += 0.5 * m * v * v;
            for (int j = 0; j < dim; ++j)
              {
                double moment = x * get(Layout::velocity + j) - get(Layout::position + j) * v;
                // A square of edge s has s^2/12 about its middle in each direction.
                if (const int c = points.layout().affine; c >= 0)
                  moment += s * s / 12 * (get(c + dim * j + i) - get(c + dim * i + j));
                spin[i][j] += m * moment;
                spin_scale += std::fabs(m * moment);
              }
          }
      }
  }
};

template <int dim>
bool
agree(const Sums<dim> &a, const Sums<dim> &b)
{
  return std::fabs(a.mass - b.mass) < 1e-13 * a.mass &&
         std::fabs(a.volume - b.volume) < 1e-13 * a.volume &&
         (a.centre - b.centre).norm() < 1e-13 * a.mass &&
         (a.momentum - b.momentum).norm() < 1e-13 * a.mass &&
         (a.spin - b.spin).norm() < 1e-13 * (a.spin_scale + b.spin_scale);
}

ParticleNeeds
needs(const bool affine)
{
  ParticleNeeds result;
  result.isotropic_stress     = false;
  result.deformation_gradient = true;
  result.n_history            = 2;
  result.affine               = affine;
  result.n_sheets             = 1;
  return result;
}

template <int dim>
void
add(const dealii::Point<dim> &x, const double size, const double id, MaterialPoints<dim> &points)
{
  using Layout = ParticleLayout<dim>;
  std::vector<double> row(points.columns.n_columns());
  for (double &value : row)
    value = random_number();
  for (int d = 0; d < dim; ++d)
    row[Layout::position + d] = row[Layout::next_position + d] = x[d];
  row[Layout::mass]         = 1 + 0.3 * random_number();
  row[Layout::density]      = 1000 + 100 * random_number();
  row[Layout::size]         = size;
  row[Layout::id]           = id;
  row[points.layout().side] = -1;
  points.append(row.data());
  ++points.ledger.created;
}

// As they come when a uniform body moves: four across a cell of unit size, somewhat disordered.
template <int dim>
void
add_cell(MaterialPoints<dim> &points)
{
  const unsigned int n = 4;
  for (unsigned int i = 0; i < std::pow(n, dim); ++i)
    {
      dealii::Point<dim> x;
      for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
        x[d] = 2 + (rest % n + 0.5 + 0.3 * random_number()) / n;
      add(x, 1. / n, i, points);
    }
}

// Those in each eighth (quarter) of the cell.
template <int dim>
std::vector<std::vector<unsigned int>>
groups_of_cell(const MaterialPoints<dim> &points)
{
  std::vector<std::vector<unsigned int>> groups(1 << dim);
  for (unsigned int row = 0; row < points.n_rows(); ++row)
    {
      unsigned int group = 0;
      for (int d = 0; d < dim; ++d)
        group |= (points.position(row)[d] > 2.5) << d;
      groups[group].push_back(row);
    }
  return groups;
}

template <int dim>
void
test_split(const bool affine)
{
  MaterialPoints<dim> points("water", needs(affine));
  add_cell(points);
  const unsigned int n = points.n_particles();
  const Sums<dim>    before(points);
  SplitMerge<dim>    split_merge(points);
  dealii::Point<dim> far;
  for (int d = 0; d < dim; ++d)
    far[d] = 10;
  const dealii::BoundingBox<dim> box({dealii::Point<dim>(), far});
  for (unsigned int row = 0; row < n; ++row)
    split_merge.split(row, SplitMerge<dim>::arm(points, row, box), 1000 + row * ((1 << dim) - 1));
  const Sums<dim> after(points);
  deallog << "split: " << n << " to " << points.n_particles() << ", sums are kept "
          << agree(before, after) << ", energy is accounted for "
          << (std::fabs(before.kinetic - after.kinetic - split_merge.lost_energy()) <
              1e-13 * before.kinetic)
          << ", none is lost without affine velocity "
          << (affine || std::fabs(split_merge.lost_energy()) < 1e-13 * before.kinetic) << std::endl;
  std::vector<std::uint64_t> ids;
  for (unsigned int row = 0; row < points.n_rows(); ++row)
    ids.push_back(points.id(row));
  std::sort(ids.begin(), ids.end());
  deallog << "ids differ " << (std::unique(ids.begin(), ids.end()) == ids.end())
          << ", ledger is closed "
          << (points.ledger.expected() == std::int64_t(points.n_particles())) << std::endl;
}

template <int dim>
void
test_merge(const bool affine)
{
  unsigned int n_merged = 0, n_refused = 0;
  bool         kept = true, energy = true, ledger = true, less = true;
  for (unsigned int trial = 0; trial < 200; ++trial)
    {
      MaterialPoints<dim> points("water", needs(affine));
      add_cell(points);
      const Sums<dim> before(points);
      SplitMerge<dim> split_merge(points);
      const bool      done = split_merge.merge(groups_of_cell(points));
      const Sums<dim> after(points);
      (done ? n_merged : n_refused) += 1;
      kept   = kept && agree(before, after);
      energy = energy && std::fabs(before.kinetic - after.kinetic - split_merge.lost_energy()) <
                           1e-13 * before.kinetic;
      less   = less && points.n_particles() == (done ? 1u << dim : 1u << (2 * dim));
      ledger = ledger && points.ledger.expected() == std::int64_t(points.n_particles());
    }
  deallog << "merge: sums are kept " << kept << ", energy is accounted for " << energy
          << ", ledger is closed " << ledger << ", 2^dim are left " << less << std::endl;
  deallog << "most can: " << (n_merged > 190) << std::endl;
}

// One particle, its children, and what they become again.
template <int dim>
void
test_there_and_back(const bool affine)
{
  using Layout = ParticleLayout<dim>;
  MaterialPoints<dim> points("water", needs(affine));
  dealii::Point<dim>  x;
  x[0] = 3;
  add(x, 0.5, 7, points);
  std::vector<double> before(points.columns.n_columns()), after(before);
  points.columns.get_row(0, before.data());
  SplitMerge<dim>               split_merge(points);
  typename SplitMerge<dim>::Arm arm;
  for (int d = 0; d < dim; ++d)
    arm[d] = 0.125;
  split_merge.split(0, arm, 8);
  std::vector<unsigned int> group;
  for (unsigned int row = 0; row < points.n_rows(); ++row)
    group.push_back(row);
  const bool done = split_merge.merge({group});
  points.columns.get_row(0, after.data());
  double worst = 0;
  for (unsigned int c = 0; c < before.size(); ++c)
    // The place at the end of the step is that of now.
    if (c < static_cast<unsigned int>(Layout::next_position) ||
        c >= static_cast<unsigned int>(Layout::next_position + dim))
      worst = std::max(worst, std::fabs(before[c] - after[c]) / (1 + std::fabs(before[c])));
  deallog << "there and back: " << done << ", nothing changed " << (worst < 1e-14)
          << ", no energy lost " << (std::fabs(split_merge.lost_energy()) < 1e-14) << std::endl;
}

// What cannot be carried is refused, and near a face of the box children stay inside.
template <int dim>
void
test_limits()
{
  MaterialPoints<dim> points("water", needs(false));
  dealii::Point<dim>  a, b;
  a[0] = 1;
  b[0] = 1.5;
  add(a, 0.5, 0, points);
  add(b, 0.5, 1, points);
  for (int i = 0; i < 2; ++i)
    {
      points.column(ParticleLayout<dim>::velocity + 1)[i] = i == 0 ? 1 : -1;
      points.column(ParticleLayout<dim>::velocity)[i]     = 0;
    }
  SplitMerge<dim> split_merge(points);
  deallog << "two that turn about each other do not become one: " << !split_merge.merge({{0, 1}})
          << ' ' << (points.n_particles() == 2) << std::endl;
  dealii::Point<dim> far;
  for (int d = 0; d < dim; ++d)
    far[d] = 10;
  const auto arm =
    SplitMerge<dim>::arm(points, 0, dealii::BoundingBox<dim>({dealii::Point<dim>(), far}));
  deallog << "arms at the faces of the box: " << arm << std::endl;
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  for (const bool affine : {false, true})
    {
      deallog.push(affine ? "affine" : "plain");
      test_split<dim>(affine);
      test_merge<dim>(affine);
      test_there_and_back<dim>(affine);
      deallog.pop();
    }
  test_limits<dim>();
  deallog.pop();
}

int
main()
{
  initlog();
  test<2>();
  test<3>();
}
