// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/transfer.h>

namespace coracle
{
namespace
{
// A particle, or a piece of one, as the corners of a cell see it.
template <int dim>
struct Sample
{
  std::size_t         row;
  Vector<dim, double> xi;
  Vector<dim, double> velocity;
  double              mass;
  double              volume_per_size;
  /// Mean pressure of the leaf the particle is in, if forces are made from it.
  double mean_pressure;
  double cell_size;
  /// Centre of the piece minus centre of the particle.
  dealii::Tensor<1, dim> offset;
};

// One compiled sweep for each combination, so that no particle asks what is wanted.
template <int dim, bool isotropic, bool affine, bool mass, bool force>
class Sweep
{
public:
  using Layout = ParticleLayout<dim>;

  Sweep(const Octree<dim>     &octree,
        MaterialPoints<dim>   &points,
        const TransferOptions &options,
        NodalField<dim>       &field)
    : octree(octree)
    , points(points)
    , gimp(options.shape == ParticleShape::gimp)
    , averaging(force && options.average_pressure)
    , cutting(!points.cuts.empty())
    , field(field)
    , stress(points.layout().stress)
    , affine_column(points.layout().affine)
  {}

  void run()
  {
    if (averaging)
      {
        points.means.reinit(octree.n_leaves() + points.cuts.n_means);
        for (const auto &stray : points.strays)
          if (!points.cuts.contains(stray.row))
            points.means.add(stray.leaf, volume(stray.row), pressure(stray.row));
        for (unsigned int i = 0; i < points.cuts.size(); ++i)
          points.means.add(points.cuts.mean[i],
                           volume(points.cuts.row[i]),
                           pressure(points.cuts.row[i]));
      }
    for (const unsigned int leaf : points.occupied_cells())
      sweep_cell(leaf);
    for (const auto &stray : points.strays)
      if (!points.cuts.contains(stray.row))
        give_stray(stray);
    for (unsigned int i = 0; i < points.cuts.size(); ++i)
      give_cut(i);
  }

private:
  Mask8 inside(const unsigned int leaf, const std::size_t row, const Vector<dim, Pack8> &x) const
  {
    const Pack8 margin = gimp ? 0.5 * load<Pack8>(points.column(Layout::size) + row) : Pack8{};
    const Mask8 here   = inside_cell<dim>(x, octree.lower(leaf), octree.size(leaf), margin);
    return cutting ? Mask8(here & points.cuts.others(row)) : here;
  }

  void sweep_cell(const unsigned int leaf)
  {
    if (averaging)
      add_mean(leaf);
    const double              mean  = averaging ? points.means.mean(leaf) : 0.;
    const dealii::Point<dim> &lower = octree.lower(leaf);
    const double              size = octree.size(leaf), inverse_size = 1. / size;
    const unsigned int        end = points.cell_begin()[leaf + 1];
    CornerSums<dim>           sums;
    for (unsigned int row = points.cell_begin()[leaf]; row < end; row += pack_size)
      {
        const Vector<dim, Pack8> x    = load_vector(points, Layout::position, row);
        const Mask8              here = inside(leaf, row, x);
        const Vector<dim, Pack8> v    = load_vector(points, Layout::velocity, row);
        const Pack8              m    = load<Pack8>(points.column(Layout::mass) + row);
        const Pack8              volume_per_size =
          m / load<Pack8>(points.column(Layout::density) + row) * inverse_size;
        Vector<dim, Pack8> xi;
        for (int d = 0; d < dim; ++d)
          xi[d] = (x[d] - lower[d]) * inverse_size;
        const int n_lanes = std::min<unsigned int>(pack_size, end - row);
        for (int l = 0; l < n_lanes; ++l)
          if (__builtin_expect(here[l] != 0, 1))
            {
              Sample<dim> sample;
              sample.row = row + l;
              for (int d = 0; d < dim; ++d)
                {
                  sample.xi[d]       = xi[d][l];
                  sample.velocity[d] = v[d][l];
                }
              sample.mass            = m[l];
              sample.volume_per_size = volume_per_size[l];
              sample.mean_pressure   = mean;
              sample.cell_size       = size;
              give(sample, sums);
            }
      }
    sums.give_to(field, octree.nodes(leaf));
  }

  void give_stray(const typename MaterialPoints<dim>::Stray &stray)
  {
    const auto   centre = points.position(stray.row);
    const double half   = gimp ? 0.5 * points.column(Layout::size)[stray.row] : 0.;
    const double m = points.column(Layout::mass)[stray.row], v = volume(stray.row);
    Sample<dim>  sample;
    sample.row           = stray.row;
    sample.velocity      = get_vector(points, Layout::velocity, stray.row);
    sample.mean_pressure = averaging ? points.means.mean(stray.leaf) : 0.;
    for_each_piece(octree,
                   centre,
                   half,
                   [&](const int leaf, const dealii::Point<dim> &piece, const double fraction) {
                     sample.xi              = unit_coordinates(octree, leaf, piece);
                     sample.cell_size       = octree.size(leaf);
                     sample.mass            = fraction * m;
                     sample.volume_per_size = fraction * v / sample.cell_size;
                     sample.offset          = piece - centre;
                     CornerSums<dim> sums;
                     give(sample, sums);
                     sums.give_to(field, octree.nodes(leaf));
                   });
  }

  // Stress as forces see it.
  Symmetric<dim, double> stress_of(const std::size_t row, const double mean_pressure) const
  {
    Symmetric<dim, double> s;
    for (int k = 0; k < Symmetric<dim, double>::size; ++k)
      s[k] = points.column(stress + k)[row];
    if (averaging)
      {
        const double change = -s.trace() / 3. - mean_pressure;
        for (int k = 0; k < 3; ++k)
          s[k] += change;
      }
    return s;
  }

  void give_cut(const unsigned int i)
  {
    using Gathered                 = typename NodalField<dim>::Gathered;
    const unsigned int        row  = points.cuts.row[i];
    const double              mean = averaging ? points.means.mean(points.cuts.mean[i]) : 0.;
    const double              m = points.column(Layout::mass)[row], v = volume(row);
    const Vector<dim, double> velocity = get_vector(points, Layout::velocity, row);
    Symmetric<dim, double>    s;
    if constexpr (force && !isotropic)
      s = stress_of(row, mean);
    const double p = averaging ? mean : points.column(stress)[row];
    for (std::size_t e = points.cuts.begin[i]; e < points.cuts.begin[i + 1]; ++e)
      {
        const auto &entry = points.cuts.entries[e];
        if constexpr (mass)
          {
            field.give(entry.node, Gathered::mass, m * entry.value);
            for (int d = 0; d < dim; ++d)
              field.give(entry.node,
                         Gathered::momentum + d,
                         m * entry_velocity<dim, affine>(points, row, velocity, entry, d));
          }
        if constexpr (force)
          for (int d = 0; d < dim; ++d)
            {
              if constexpr (isotropic)
                field.give(entry.node, Gathered::force + d, v * p * entry.gradient[d]);
              else
                for (int k = 0; k < dim; ++k)
                  field.give(entry.node, Gathered::force + d, -v * s(d, k) * entry.gradient[k]);
            }
      }
  }

  void give(const Sample<dim> &sample, CornerSums<dim> &sums) const
  {
    const CornerShape<dim> shape(sample.xi);
    if constexpr (mass)
      {
        sums.mass += shape.value * sample.mass;
        if constexpr (affine)
          give_affine(sample, shape, sums);
        else
          sums.add_momentum(shape, sample.mass, sample.velocity);
      }
    if constexpr (force && isotropic)
      sums.add_pressure(shape,
                        averaging ? sample.mean_pressure : points.column(stress)[sample.row],
                        sample.volume_per_size);
    if constexpr (force && !isotropic)
      {
        const Symmetric<dim, double> s = stress_of(sample.row, sample.mean_pressure);
        sums.add_stress(shape, s, sample.volume_per_size);
      }
  }

  void
  give_affine(const Sample<dim> &sample, const CornerShape<dim> &shape, CornerSums<dim> &sums) const
  {
    Vector<dim, CornerPack<dim>> arm;
    Matrix<dim, double>          affine_velocity;
    for (int d = 0; d < dim; ++d)
      {
        arm[d] = (corner_bits<dim>(d) - sample.xi[d]) * sample.cell_size + sample.offset[d];
        for (int e = 0; e < dim; ++e)
          affine_velocity[d][e] = points.column(affine_column + dim * d + e)[sample.row];
      }
    sums.add_affine_momentum(shape, sample.mass, sample.velocity, affine_velocity, arm);
  }

  double volume(const std::size_t row) const
  {
    return points.column(Layout::mass)[row] / points.column(Layout::density)[row];
  }

  double pressure(const std::size_t row) const
  {
    if constexpr (isotropic)
      return points.column(stress)[row];
    else
      return -(points.column(stress)[row] + points.column(stress + 1)[row] +
               points.column(stress + 2)[row]) /
             3.;
  }

  void add_mean(const unsigned int leaf)
  {
    const unsigned int end = points.cell_begin()[leaf + 1];
    for (unsigned int row = points.cell_begin()[leaf]; row < end; row += pack_size)
      {
        const Mask8 here    = inside(leaf, row, load_vector(points, Layout::position, row));
        const int   n_lanes = std::min<unsigned int>(pack_size, end - row);
        for (int l = 0; l < n_lanes; ++l)
          if (here[l])
            points.means.add(leaf, volume(row + l), pressure(row + l));
      }
  }

  const Octree<dim>   &octree;
  MaterialPoints<dim> &points;
  const bool           gimp, averaging, cutting;
  NodalField<dim>     &field;
  const int            stress, affine_column;
};

template <int dim, bool isotropic, bool affine>
void
run_sweep(const Octree<dim>     &octree,
          MaterialPoints<dim>   &points,
          const TransferOptions &options,
          const Give             give,
          NodalField<dim>       &field)
{
  switch (give)
    {
      case Give::mass_and_momentum:
        return Sweep<dim, isotropic, affine, true, false>(octree, points, options, field).run();
      case Give::force:
        return Sweep<dim, isotropic, affine, false, true>(octree, points, options, field).run();
      case Give::everything:
        return Sweep<dim, isotropic, affine, true, true>(octree, points, options, field).run();
    }
}
} // namespace

template <int dim>
void
particles_to_grid(const Octree<dim>     &octree,
                  MaterialPoints<dim>   &points,
                  const TransferOptions &options,
                  const Give             give,
                  NodalField<dim>       &field)
{
  const bool isotropic = points.layout().n_stress == 1, affine = points.layout().affine >= 0;
  if (isotropic && !affine)
    run_sweep<dim, true, false>(octree, points, options, give, field);
  else if (isotropic)
    run_sweep<dim, true, true>(octree, points, options, give, field);
  else if (!affine)
    run_sweep<dim, false, false>(octree, points, options, give, field);
  else
    run_sweep<dim, false, true>(octree, points, options, give, field);
}

template void particles_to_grid(const Octree<2> &,
                                MaterialPoints<2> &,
                                const TransferOptions &,
                                const Give,
                                NodalField<2> &);
template void particles_to_grid(const Octree<3> &,
                                MaterialPoints<3> &,
                                const TransferOptions &,
                                const Give,
                                NodalField<3> &);
} // namespace coracle
