// SPDX-License-Identifier: GPL-3.0-or-later
// Sorting keeps the rows of particles whole and in order within a cell, drops holes, and copes with
// nothing at all; new rows are zero even where others have been.
#include <coracle/particles/material_points.h>

#include "tests.h"

using namespace coracle;

template <int dim>
void
test_layout()
{
  ParticleNeeds             needs;
  const ParticleLayout<dim> least = [&] {
    needs.isotropic_stress = true;
    return ParticleLayout<dim>(needs);
  }();
  needs.isotropic_stress     = false;
  needs.deformation_gradient = needs.affine = true;
  needs.n_history                           = 3;
  needs.n_sheets                            = 2;
  const ParticleLayout<dim> most(needs);
  deallog << "columns, least and most: " << least.n_columns << ' ' << most.n_columns << std::endl;
  deallog << "what a body has not is at -1: "
          << (least.history == -1 && least.deformation_gradient == -1 && least.affine == -1 &&
              least.side == -1)
          << std::endl;
  // Each column is of one quantity.
  std::vector<int> owners(most.n_columns, 0);
  const auto       take = [&](const int first, const int n) {
    for (int c = first; c < first + n; ++c)
      ++owners[c];
  };
  using Layout = ParticleLayout<dim>;
  for (const int vector : {Layout::position, Layout::velocity, Layout::next_position})
    take(vector, dim);
  for (const int scalar : {Layout::mass, Layout::density, Layout::size, Layout::id})
    take(scalar, 1);
  take(Layout::stress, most.n_stress);
  take(most.history, 3);
  take(most.deformation_gradient, dim * dim);
  take(most.affine, dim * dim);
  take(most.side, 2);
  deallog << "none overlap, none is left over: "
          << (std::count(owners.begin(), owners.end(), 1) == most.n_columns) << std::endl;
}

template <int dim>
void
append(const unsigned int id, MaterialPoints<dim> &points)
{
  std::vector<double> row(points.columns.n_columns());
  for (unsigned int c = 0; c < row.size(); ++c)
    row[c] = 100 * id + c + 1;
  points.append(row.data());
}

template <int dim>
void
test_sort()
{
  using Layout = ParticleLayout<dim>;
  MaterialPoints<dim> points("sand", ParticleNeeds());
  points.sort(0, {});
  points.sort(4, {});
  deallog << "nothing: " << points.n_rows() << ' ' << points.cell_begin().size() << ' '
          << points.occupied_cells().size() << ' ' << points.mass() << std::endl;

  const unsigned int n = 100, n_cells = 7;
  for (unsigned int id = 0; id < n; ++id)
    append(id, points);
  double expected_mass = 0;
  for (unsigned int id = 0; id < n; ++id)
    if (id % 9 == 4)
      points.remove(id);
    else
      expected_mass += 100 * id + Layout::mass + 1;
  deallog << "particles, rows: " << points.n_particles() << ' ' << points.n_rows()
          << ", holes have no mass: " << (points.mass() == expected_mass) << std::endl;

  // Cell 3 stays empty; holes may have any cell.
  std::vector<int> cell(n);
  const auto home = [](const unsigned int id) { return (id * 5) % 7 == 3 ? 6 : (id * 5) % 7; };
  for (unsigned int id = 0; id < n; ++id)
    cell[id] = id % 9 == 4 ? -1 : home(id);
  points.strays.push_back({3, 0});
  points.sort(n_cells, cell);
  bool good = points.n_rows() == points.n_particles() && points.n_particles() == n - 11 &&
              points.strays.empty() && points.cell_begin().size() == n_cells + 1 &&
              points.cell_begin().back() == points.n_rows();
  unsigned int occupied = 0;
  for (unsigned int c = 0; c < n_cells; ++c)
    {
      double last = -1;
      for (unsigned int row = points.cell_begin()[c]; row < points.cell_begin()[c + 1]; ++row)
        {
          const double first = points.column(0)[row];
          for (unsigned int k = 0; k < points.columns.n_columns(); ++k)
            good = good && points.column(k)[row] == first + k;
          good = good && home((first - 1) / 100) == c && first > last;
          last = first;
        }
      occupied += points.cell_begin()[c + 1] > points.cell_begin()[c];
    }
  deallog << "rows are whole, in their cells, in their old order: " << good << std::endl;
  deallog << "occupied cells: " << points.occupied_cells().size() << ' ' << occupied << ' '
          << (std::count(points.occupied_cells().begin(), points.occupied_cells().end(), 3u) == 0)
          << std::endl;

  // Appended rows stand behind the sorted ones; a pack may be read behind the end.
  append(1000, points);
  deallog << "appended: " << points.n_rows() - points.cell_begin().back() << ' '
          << points.column(0)[points.n_rows() - 1]
          << ", behind the end: " << points.column(0)[points.n_rows() + pack_size - 1] << std::endl;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    points.remove(row);
  points.sort(n_cells, std::vector<int>(points.n_rows(), 0));
  deallog << "all removed: " << points.n_rows() << ' ' << points.n_particles() << ' '
          << points.occupied_cells().size() << ' ' << points.kinetic_energy() << std::endl;
}

void
test_columns()
{
  Columns columns(2);
  columns.resize(20);
  for (unsigned int i = 0; i < 20; ++i)
    columns[0][i] = columns[1][i] = i + 1;
  columns.resize(3);
  columns.resize(9);
  bool zero = columns.size() == 9;
  for (unsigned int i = 3; i < 9 + pack_size; ++i)
    zero = zero && columns[0][i] == 0 && columns[1][i] == 0;
  deallog << "rows given up and taken again are zero: " << zero
          << ", the others stay: " << columns[1][2] << std::endl;
  columns.resize(1000);
  columns.reorder({2, 0, 1, 1});
  deallog << "reordered: " << columns.size() << ' ' << columns[0][0] << ' ' << columns[0][1] << ' '
          << columns[0][2] << ' ' << columns[0][3] << ' ' << columns[0][4] << std::endl;
  columns.resize(0);
  columns.reorder({});
  columns.resize(1);
  deallog << "from nothing: " << columns.size() << ' ' << columns[0][0] << std::endl;
}

int
main()
{
  initlog();
  test_columns();
  test_layout<2>();
  test_layout<3>();
  test_sort<2>();
  test_sort<3>();
}
