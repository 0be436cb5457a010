// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that wander at random stay whole, are on the rank that owns their leaf, and are all
// accounted for; those that leave are counted at an open face and named at a closed one. Rows
// handed to the wrong ranks find back.
#include <coracle/base/exceptions.h>

#include "grid/scene.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

// The same formula elsewhere in a program may be rounded otherwise.
bool
differ(const double a, const double b)
{
  return !(std::fabs(a - b) < 1e-12);
}

// Every particle is with its leaf's owner, in its home cell or listed once as a stray, and its
// columns are still those of its id.
template <int dim>
bool
is_consistent(const Scene<dim> &scene, const double margin, const MaterialPoints<dim> &points)
{
  using Layout = ParticleLayout<dim>;
  std::vector<int> visits(points.n_rows(), 0);
  for (const auto &stray : points.strays)
    {
      visits[stray.row] += 1;
      if (stray.leaf != scene.octree.find(points.position(stray.row)))
        return false;
    }
  std::size_t last = 0;
  for (const unsigned int leaf : points.occupied_cells())
    for (std::size_t row = points.cell_begin()[leaf]; row < points.cell_begin()[leaf + 1]; ++row)
      {
        // Sorted rows have no gap.
        if (row != last++)
          return false;
        bool inside = true;
        for (int d = 0; d < dim; ++d)
          {
            const double x     = points.column(Layout::position + d)[row],
                         reach = margin * points.column(Layout::size)[row];
            inside             = inside && x - reach >= scene.octree.lower(leaf)[d] &&
                     x + reach < scene.octree.lower(leaf)[d] + scene.octree.size(leaf);
          }
        visits[row] += inside;
      }
  std::size_t n_holes = 0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      n_holes += points.is_hole(row);
      if (points.is_hole(row))
        continue;
      if (visits[row] != 1 || !scene.is_mine(points.position(row)))
        return false;
      for (unsigned int c = 0; c < points.columns.n_columns(); ++c)
        if (c >= Layout::stress &&
            differ(points.column(c)[row], std::sin(1.3 * double(points.id(row)) + 0.7 * c)))
          return false;
      if (differ(points.column(Layout::mass)[row], 1. + 0.1 * std::cos(double(points.id(row)))))
        return false;
    }
  return points.n_rows() - n_holes == points.n_particles();
}

template <int dim>
bool
ledger_closes(const MaterialPoints<dim> &points)
{
  const std::int64_t open = std::int64_t(points.ledger.created) -
                            std::int64_t(points.ledger.removed) -
                            std::int64_t(points.n_particles());
  return mpi::sum(open, comm) == 0;
}

// All rows go to the next rank, whether they belong there or not, and back to their owners.
template <int dim>
bool
find_back(const Scene<dim> &scene, const double margin, MaterialPoints<dim> &points)
{
  const unsigned int width = points.columns.n_columns(), n_ranks = mpi::n_ranks(comm);
  std::map<unsigned int, std::vector<double>> to_send;
  std::vector<double>                         values(width);
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      points.columns.get_row(row, values.data());
      auto &rows = to_send[(mpi::rank(comm) + 1) % n_ranks];
      rows.insert(rows.end(), values.begin(), values.end());
    }
  points.clear();
  for (const auto &[rank, rows] : mpi::exchange_values(to_send, comm))
    for (std::size_t first = 0; first < rows.size(); first += width)
      points.append(rows.data() + first);
  redistribute(scene.octree, margin, points);
  return ledger_closes(points) && is_consistent(scene, margin, points);
}

template <int dim>
void
test_walk(const OctreeDescription<dim> &description, const double margin)
{
  using Layout = ParticleLayout<dim>;
  ParticleNeeds needs;
  needs.deformation_gradient = true;
  needs.affine               = true;
  Scene<dim>          scene(description, FaceCondition::slip);
  MaterialPoints<dim> points("dust", needs);
  const unsigned int  n = 300;
  add_particles(scene, n, 0.01, points);
  sort_by_leaf(scene.octree, margin, points);
  bool good = is_consistent(scene, margin, points);

  const double n_all = n + 4, reach = 0.005;
  unsigned int received = 0, sorted_strays = 0;
  for (unsigned int step = 0; step < 40; ++step)
    {
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        for (int d = 0; d < dim; ++d)
          {
            const double x = points.column(Layout::position + d)[row] +
                             0.03 * std::sin(12.9 * points.id(row) + 78.2 * step + 37.7 * d);
            points.column(Layout::next_position + d)[row] =
              std::max(scene.octree.box().lower_bound(d) + reach,
                       std::min(scene.octree.box().upper_bound(d) - reach, x));
          }
      received += move_and_locate(scene.octree, scene.boundary, margin, 0.1 * step, points);
      good = ledger_closes(points) && is_consistent(scene, margin, points) && good;
      if (step % 7 == 6)
        {
          sort_by_leaf(scene.octree, margin, points);
          good =
            is_consistent(scene, margin, points) && points.n_rows() == points.n_particles() && good;
          sorted_strays += points.strays.size();
        }
    }
  sort_by_leaf(scene.octree, margin, points);
  good = find_back(scene, margin, points) && good;
  const auto ids =
    sum_over_particles(points, [&](const std::size_t row) { return double(points.id(row)); });
  const auto square = sum_over_particles(points, [&](const std::size_t row) {
    return std::pow(double(points.id(row)), 2);
  });
  deallog << "consistent after every step: " << !mpi::any(!good, comm) << std::endl;
  deallog << "all ids are there: "
          << (ids == n_all * (n_all - 1) / 2 && square == n_all * (n_all - 1) * (2 * n_all - 1) / 6)
          << std::endl;
  deallog << "some changed ranks, if there are several with leaves: "
          << (mpi::any(received > 0, comm) ||
              mpi::sum<unsigned int>(scene.octree.n_owned_leaves() > 0, comm) == 1)
          << std::endl;
  deallog << "GIMP particles that reach out are strays after sorting: "
          << (mpi::any(sorted_strays > 0, comm) == (margin > 0)) << std::endl;
}

template <int dim>
void
test_open_face()
{
  using Layout                    = ParticleLayout<dim>;
  auto                description = dyadic_box<dim>();
  Scene<dim>          scene(description, FaceCondition::open);
  MaterialPoints<dim> points("spray", ParticleNeeds());
  const unsigned int  n = 400;
  add_particles(scene, n, 0., points);
  sort_by_leaf(scene.octree, 0., points);
  // The same places on all ranks.
  std::vector<double> x_0;
  Random              random;
  for (unsigned int i = 0; i < n; ++i)
    x_0.push_back(random.in(scene.octree.box())[0]);
  const double upper = scene.octree.box().upper_bound(0), middle = 0.5 * upper;
  x_0.insert(x_0.end(), {middle, middle - 0.125, upper, 0.});

  const double step = 1. / 64;
  bool         good = true;
  for (unsigned int k = 1; step * (k - 1) <= upper; ++k)
    {
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        for (int d = 0; d < dim; ++d)
          points.column(Layout::next_position + d)[row] =
            points.column(Layout::position + d)[row] + (d == 0 ? step : 0.);
      move_and_locate(scene.octree, scene.boundary, 0., k, points);
      if (k % 9 == 0)
        sort_by_leaf(scene.octree, 0., points);
      // Round-off of the sum must not decide.
      std::uint64_t gone = 0, unsure = 0;
      for (const double x : x_0)
        {
          gone += x + k * step > upper + 1e-12;
          unsure += std::fabs(x + k * step - upper) <= 1e-12;
        }
      const auto removed = mpi::sum(points.ledger.removed, comm);
      good = good && removed >= gone && removed <= gone + unsure && ledger_closes(points);
    }
  deallog << "removed as they pass, in the end all " << mpi::sum(points.ledger.removed, comm)
          << ": " << !mpi::any(!good, comm) << std::endl;
  sort_by_leaf(scene.octree, 0., points);
  deallog << "nothing left, no rows, no occupied cells: "
          << !mpi::any(points.n_rows() > 0 || !points.occupied_cells().empty(), comm) << std::endl;
}

template <int dim>
void
test_closed_face()
{
  using Layout = ParticleLayout<dim>;
  for (const bool not_a_number : {false, true})
    {
      Scene<dim>          scene(dyadic_box<dim>(), FaceCondition::slip);
      MaterialPoints<dim> points("water", ParticleNeeds());
      add_particles(scene, 200, 0., points);
      sort_by_leaf(scene.octree, 0., points);
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        if (points.id(row) == 202)
          points.column(Layout::next_position + 1)[row] += not_a_number ? std::nan("") : 0.25;
      std::string details;
      try
        {
          move_and_locate(scene.octree, scene.boundary, 0., 0.5, points);
        }
      catch (const RunFailure &failure)
        {
          details = failure.details;
        }
      const auto all = dealii::Utilities::MPI::gather(comm, details);
      deallog << "ranks that fail: " << mpi::sum<unsigned int>(!details.empty(), comm) << std::endl;
      for (const auto &text : all)
        if (!text.empty())
          deallog << text.substr(0, text.find(", velocity")) << text.substr(text.find(" m/s:"))
                  << std::endl;
      deallog << "the ledger closes all the same: " << ledger_closes(points) << std::endl;
    }
}

template <int dim>
void
test()
{
  deallog.push(std::to_string(dim) + "d");
  for (const double margin : {0., 0.5})
    {
      test_walk<dim>(dyadic_box<dim>(), margin);
      // Two cells: with three ranks or more, some have no leaf.
      std::array<unsigned int, dim> n;
      n.fill(1);
      n[0]             = 2;
      auto description = refined_box<dim>(n, 0.3, -0.1);
      description.refinements.clear();
      test_walk<dim>(description, margin);
    }
  test_open_face<dim>();
  test_closed_face<dim>();
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
