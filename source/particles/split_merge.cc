// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/split_merge.h>

#include <cmath>

namespace coracle
{
namespace
{
/// Of a box of unit size about its middle, per mass and direction.
constexpr double inertia_of_box = 1. / 12.;
/// An energy below this share of the kinetic energy is round-off.
constexpr double round_off = 1e-13;
} // namespace

template <int dim>
typename SplitMerge<dim>::Arm
SplitMerge<dim>::arm(const MaterialPoints<dim>      &points,
                     const std::size_t               row,
                     const dealii::BoundingBox<dim> &box)
{
  const double             quarter = 0.25 * points.column(Layout::size)[row];
  const dealii::Point<dim> x       = points.position(row);
  Arm                      result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] =
      std::max(0., std::min({quarter, x[d] - box.lower_bound(d), box.upper_bound(d) - x[d]}));
  return result;
}

template <int dim>
dealii::Tensor<1, dim>
SplitMerge<dim>::velocity(const std::size_t row) const
{
  dealii::Tensor<1, dim> v;
  for (unsigned int d = 0; d < dim; ++d)
    v[d] = points.column(Layout::velocity + d)[row];
  return v;
}

template <int dim>
typename SplitMerge<dim>::Moment
SplitMerge<dim>::affine(const std::size_t row) const
{
  Moment c;
  if (const int first = points.layout().affine; first >= 0)
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        c[i][j] = points.column(first + dim * i + j)[row];
  return c;
}

template <int dim>
void
SplitMerge<dim>::split(const std::size_t row, const Arm &arm, const std::uint64_t first_id)
{
  const dealii::Point<dim>     x = points.position(row);
  const dealii::Tensor<1, dim> v = velocity(row);
  const Moment                 c = affine(row);
  std::vector<double>          child(points.columns.n_columns());
  points.columns.get_row(row, child.data());
  const double mass   = child[Layout::mass] / n_children;
  child[Layout::mass] = mass;
  child[Layout::size] *= 0.5;
  const double id = child[Layout::id];
  lost.add(0.5 * n_children * mass * v.norm_square());
  for (unsigned int k = 0; k < n_children; ++k)
    {
      const dealii::Point<dim>     place = child_place(x, arm, k);
      const dealii::Tensor<1, dim> speed = v + c * (place - x);
      for (unsigned int d = 0; d < dim; ++d)
        {
          child[Layout::position + d]      = place[d];
          child[Layout::next_position + d] = place[d];
          child[Layout::velocity + d]      = speed[d];
        }
      child[Layout::id] = k == 0 ? id : first_id + k - 1;
      lost.add(-0.5 * mass * speed.norm_square());
      if (k == 0)
        points.columns.set_row(row, child.data());
      else
        points.append(child.data());
    }
  points.ledger.split += n_children - 1;
}

template <int dim>
typename SplitMerge<dim>::Merged
SplitMerge<dim>::sum_up(const std::vector<unsigned int> &group) const
{
  Merged result;
  result.id = points.id(group.front());
  for (const unsigned int row : group)
    {
      const double m = points.column(Layout::mass)[row];
      result.mass += m;
      result.volume += m / points.column(Layout::density)[row];
      result.box += std::pow(points.column(Layout::size)[row], dim);
      result.place += m * points.position(row);
      result.velocity += m * velocity(row);
      result.affine += m * affine(row);
      result.id = std::min(result.id, points.id(row));
    }
  result.place /= result.mass;
  result.velocity /= result.mass;
  result.affine /= result.mass;
  for (const unsigned int row : group)
    {
      const double                 m = points.column(Layout::mass)[row];
      const dealii::Tensor<1, dim> x = points.position(row) - result.place,
                                   v = velocity(row) - result.velocity;
      const Moment c                 = affine(row);
      const double own = m * inertia_of_box * std::pow(points.column(Layout::size)[row], 2);
      result.turning += m * outer_product(v, x) + own * c;
      result.energy += 0.5 * m * v.norm_square() + 0.5 * own * c.norm_square();
    }
  return result;
}

// The skew part of C carries the turning; the symmetric part is the mean of the group.
template <int dim>
bool
SplitMerge<dim>::turn_alone(Merged &merged) const
{
  const double inertia = merged.mass * inertia_of_box * std::pow(merged.box, 2. / dim);
  const Moment skew    = (0.5 / inertia) * (merged.turning - transpose(merged.turning));
  // A group that is spread wider than the merged box turns faster in it.
  if (0.5 * inertia * skew.norm_square() >
      2 * merged.energy + round_off * merged.mass * merged.velocity.norm_square())
    return false;
  merged.affine = 0.5 * (merged.affine + transpose(merged.affine)) + skew;
  return true;
}

// All merged particles take the sum of what turned in their groups as one rotation.
template <int dim>
bool
SplitMerge<dim>::turn_together(std::vector<Merged> &merged)
{
  double                 mass = 0, energy = 0, kinetic = 0;
  dealii::Point<dim>     centre;
  dealii::Tensor<2, dim> turning;
  for (const Merged &m : merged)
    {
      mass += m.mass;
      centre += m.mass * m.place;
      energy += m.energy;
      kinetic += 0.5 * m.mass * m.velocity.norm_square();
      turning += m.turning;
    }
  centre /= mass;
  // The velocity W (x - centre) with a skew W has the turning W M; wanted is W M + M W = turning -
  // transposed.
  dealii::Tensor<2, dim> second;
  for (const Merged &m : merged)
    {
      const dealii::Tensor<1, dim> x = m.place - centre;
      second += m.mass * outer_product(x, x);
    }
  const dealii::Tensor<2, dim> wanted = turning - transpose(turning);
  dealii::Tensor<2, dim>       rotation;
  if constexpr (dim == 2)
    {
      const double inertia = trace(second);
      if (!(inertia > 0))
        return energy <= round_off * kinetic;
      rotation[0][1] = wanted[0][1] / inertia;
      rotation[1][0] = -rotation[0][1];
    }
  else
    {
      dealii::Tensor<2, dim> inertia = -second;
      for (unsigned int d = 0; d < dim; ++d)
        inertia[d][d] += trace(second);
      // In a line there is nothing that could turn about it.
      if (!(determinant(inertia) > 1e-6 * std::pow(trace(second), 3)))
        return energy <= round_off * kinetic;
      const dealii::Tensor<1, dim> spin({wanted[2][1], wanted[0][2], wanted[1][0]}),
        w            = invert(inertia) * spin;
      rotation[2][1] = w[0];
      rotation[0][2] = w[1];
      rotation[1][0] = w[2];
      rotation[1][2] = -w[0];
      rotation[2][0] = -w[1];
      rotation[0][1] = -w[2];
    }
  double cost = 0;
  for (const Merged &m : merged)
    cost += 0.5 * m.mass * (rotation * (m.place - centre)).norm_square();
  if (cost > energy + round_off * kinetic)
    return false;
  for (Merged &m : merged)
    m.velocity += rotation * (m.place - centre);
  return true;
}

template <int dim>
void
SplitMerge<dim>::store(const Merged &merged, const std::vector<unsigned int> &group)
{
  // What is averaged by volume: all columns behind the id, but the sides of sheets, which are the
  // same for all, and the affine velocity.
  const auto &layout = points.layout();
  const int   n_mean = layout.side >= 0 ? layout.side : layout.n_columns;
  for (int c = Layout::stress; c < n_mean; ++c)
    {
      double sum = 0;
      for (const unsigned int row : group)
        sum += points.column(Layout::mass)[row] / points.column(Layout::density)[row] *
               points.column(c)[row];
      points.column(c)[group.front()] = sum / merged.volume;
    }
  for (const unsigned int row : group)
    {
      lost.add(0.5 * points.column(Layout::mass)[row] * velocity(row).norm_square());
      if (row != group.front())
        points.remove(row);
    }
  const unsigned int row = group.front();
  lost.add(-0.5 * merged.mass * merged.velocity.norm_square());
  for (unsigned int d = 0; d < dim; ++d)
    {
      points.column(Layout::position + d)[row]      = merged.place[d];
      points.column(Layout::next_position + d)[row] = merged.place[d];
      points.column(Layout::velocity + d)[row]      = merged.velocity[d];
      if (layout.affine >= 0)
        for (unsigned int e = 0; e < dim; ++e)
          points.column(layout.affine + dim * d + e)[row] = merged.affine[d][e];
    }
  points.column(Layout::mass)[row]    = merged.mass;
  points.column(Layout::density)[row] = merged.mass / merged.volume;
  points.column(Layout::size)[row]    = std::pow(merged.box, 1. / dim);
  points.column(Layout::id)[row]      = merged.id;
  points.ledger.merged += group.size() - 1;
}

template <int dim>
bool
SplitMerge<dim>::merge(const std::vector<std::vector<unsigned int>> &groups)
{
  std::vector<Merged> merged;
  for (const auto &group : groups)
    merged.push_back(sum_up(group));
  if (points.layout().affine >= 0)
    {
      bool all = true;
      for (Merged &m : merged)
        all = turn_alone(m) && all;
      if (!all)
        return false;
    }
  else if (!turn_together(merged))
    return false;
  for (std::size_t g = 0; g < groups.size(); ++g)
    store(merged[g], groups[g]);
  return true;
}

template class SplitMerge<2>;
template class SplitMerge<3>;
} // namespace coracle
