// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/base/point.h>

#include <coracle/particles/material_points.h>

#include <algorithm>

namespace coracle
{
template <int dim>
MaterialPoints<dim>::MaterialPoints(const std::string &name, const ParticleNeeds &needs)
  : columns(ParticleLayout<dim>(needs).n_columns)
  , body_name(name)
  , columns_layout(needs)
  , begins(1, 0)
{}

template <int dim>
dealii::Point<dim>
MaterialPoints<dim>::position(const std::size_t row) const
{
  dealii::Point<dim> result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] = columns[Layout::position + d][row];
  return result;
}

template <int dim>
void
MaterialPoints<dim>::sort(const unsigned int n_cells, const std::vector<int> &cell)
{
  AssertDimension(cell.size(), n_rows());
  begins.assign(n_cells + 1, 0);
  for (std::size_t row = 0; row < n_rows(); ++row)
    if (!is_hole(row))
      ++begins[cell[row] + 1];
  occupied.clear();
  for (unsigned int c = 0; c < n_cells; ++c)
    {
      if (begins[c + 1] > 0)
        occupied.push_back(c);
      begins[c + 1] += begins[c];
    }
  source.resize(n_particles());
  for (std::size_t row = 0; row < n_rows(); ++row)
    if (!is_hole(row))
      source[begins[cell[row]]++] = row;
  // The loop above moved each begin to its end: shift back.
  for (unsigned int c = n_cells; c > 0; --c)
    begins[c] = begins[c - 1];
  begins[0] = 0;
  if (reproducible)
    for (const unsigned int c : occupied)
      std::sort(source.begin() + begins[c],
                source.begin() + begins[c + 1],
                [this](const unsigned int a, const unsigned int b) {
                  return columns[Layout::id][a] < columns[Layout::id][b];
                });
  columns.reorder(source);
  n_holes = 0;
  strays.clear();
}

template <int dim>
void
MaterialPoints<dim>::append(const double *const row)
{
  columns.resize(n_rows() + 1);
  columns.set_row(n_rows() - 1, row);
}

template <int dim>
void
MaterialPoints<dim>::remove(const std::size_t row)
{
  Assert(!is_hole(row), dealii::ExcInternalError());
  columns[Layout::mass][row] = 0;
  for (unsigned int d = 0; d < dim; ++d)
    columns[Layout::velocity + d][row] = 0;
  ++n_holes;
}

template <int dim>
void
MaterialPoints<dim>::clear()
{
  columns.resize(0);
  begins.assign(1, 0);
  occupied.clear();
  strays.clear();
  n_holes = 0;
}

template <int dim>
void
MaterialPoints<dim>::serialize(Archive &archive)
{
  archive.rows("rows", columns);
  archive.own("n_holes", n_holes);
  archive.own("cell_begin", begins);
  archive.own("occupied_cells", occupied);
  archive.own("strays", strays);
  archive.share("created", ledger.created);
  archive.share("removed", ledger.removed);
  archive.share("converted", ledger.converted);
  archive.share("split", ledger.split);
  archive.share("merged", ledger.merged);
  if (archive.is_exact())
    return;
  begins.assign(1, 0);
  occupied.clear();
  strays.clear();
  n_holes = std::count(columns[Layout::mass], columns[Layout::mass] + columns.size(), 0.);
}

template <int dim>
dealii::SymmetricTensor<2, dim>
MaterialPoints<dim>::touch(const std::size_t row) const
{
  dealii::SymmetricTensor<2, dim> result;
  if (columns_layout.touch >= 0)
    for (unsigned int k = 0; k < result.n_independent_components; ++k)
      result.access_raw_entry(k) = columns[columns_layout.touch + k][row];
  return result;
}

template <int dim>
void
MaterialPoints<dim>::set_touch(const std::size_t row, const dealii::SymmetricTensor<2, dim> &touch)
{
  for (unsigned int k = 0; k < touch.n_independent_components; ++k)
    columns[columns_layout.touch + k][row] = touch.access_raw_entry(k);
}

template <int dim>
void
MaterialPoints<dim>::find_touched()
{
  touched.clear();
  if (columns_layout.touch >= 0)
    for (std::size_t row = 0; row < n_rows(); ++row)
      if (!is_hole(row) && touch(row).norm() > 0)
        touched.push_back(row);
}

template <int dim>
double
MaterialPoints<dim>::kinetic_energy() const
{
  // The spare rows behind the end have no mass.
  Pack8 result{};
  for (std::size_t row = 0; row < n_rows(); row += pack_size)
    {
      Pack8 square{};
      for (int d = 0; d < dim; ++d)
        {
          const Pack8 v = load<Pack8>(column(Layout::velocity + d) + row);
          square += v * v;
        }
      result += 0.5 * load<Pack8>(column(Layout::mass) + row) * square;
    }
  return sum(result);
}

template <int dim>
ExactSum
MaterialPoints<dim>::exact_kinetic_energy() const
{
  ExactSum result;
  for (std::size_t row = 0; row < n_rows(); ++row)
    {
      double square = 0;
      for (int d = 0; d < dim; ++d)
        square += column(Layout::velocity + d)[row] * column(Layout::velocity + d)[row];
      result.add(0.5 * column(Layout::mass)[row] * square);
    }
  return result;
}

template <int dim>
double
MaterialPoints<dim>::mass() const
{
  double result = 0;
  for (std::size_t row = 0; row < n_rows(); ++row)
    result += columns[Layout::mass][row];
  return result;
}

template class MaterialPoints<2>;
template class MaterialPoints<3>;
} // namespace coracle
