// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/coupling/particle_stress.h>
#include <coracle/material/rotation.h>

namespace coracle
{
namespace
{
template <int dim, typename Material>
class Sweep
{
public:
  using Layout = ParticleLayout<dim>;

  // Only its trace is asked of the velocity gradient of an inviscid fluid.
  static constexpr bool trace_only =
    Material::isotropic_stress && !Material::needs_deformation_gradient;

  const Octree<dim>   &octree;
  const NodeRecords   &velocity;
  const unsigned int   place;
  const Material      &material;
  const bool           gimp, cell_mean;
  const double         smoothing, dt;
  const bool           exact_work;
  MaterialPoints<dim> &points;
  StressSweep          result{};
  Pack8 work{}, kinetic{}, smallest_density = splat<Pack8>(std::numeric_limits<double>::max());
  /// Of the cell at hand [1/s, m^3/kg].
  double mean_divergence = 0, mean_specific_volume = 0;
  /// Of the cell at hand: square of the largest particle speed, largest wave speed.
  Pack8 speed_square{}, wave_speed{};
  /// Velocity gradients of one cell's particles, kept while their mean is formed.
  std::vector<Matrix<dim, Pack8>> gradients{};

  void run()
  {
    if (cell_mean)
      begin_means();
    for (const unsigned int leaf : points.occupied_cells())
      sweep_cell(leaf);
    for (const auto &stray : points.strays)
      if (!points.cuts.contains(stray.row))
        update_lone(stray.row, stray_gradient(stray), stray.leaf, stray.leaf);
    for (unsigned int i = 0; i < points.cuts.size(); ++i)
      update_lone(points.cuts.row[i], cut_gradient(i), points.cuts.leaf[i], points.cuts.mean[i]);
    result.work    = exact_work ? result.exact_work.value() : sum(work);
    result.kinetic = sum(kinetic);
    if (!std::isfinite(result.work + result.kinetic) || !std::isfinite(result.rate) ||
        !(-largest(Pack8(-smallest_density)) > 0))
      find_bad_row();
  }

private:
  Mask8 inside(const unsigned int leaf, const std::size_t row, const Vector<dim, Pack8> &x) const
  {
    const Pack8 margin = gimp ? 0.5 * load<Pack8>(points.column(Layout::size) + row) : Pack8{};
    const Mask8 here   = inside_cell<dim>(x, octree.lower(leaf), octree.size(leaf), margin);
    return points.cuts.empty() ? here : Mask8(here & points.cuts.others(row));
  }

  Matrix<dim, Pack8> gradient(const PackShape<dim>                       &shape,
                              const double                                inverse_size,
                              const std::array<unsigned int, (1 << dim)> &nodes) const
  {
    Matrix<dim, Pack8> l{};
    for (int c = 0; c < (1 << dim); ++c)
      {
        const NodeRecord &node = velocity[nodes[c]];
        for (int e = 0; e < dim; ++e)
          {
            const Pack8 slope = shape.gradient(c, e) * inverse_size;
            if constexpr (trace_only)
              l[e][e] += slope * node[place + e];
            else
              for (int d = 0; d < dim; ++d)
                l[d][e] += slope * node[place + d];
          }
      }
    return l;
  }

  // Strays first, so that each cell knows all that is in it.
  void begin_means()
  {
    points.means.reinit(octree.n_leaves() + points.cuts.n_means);
    for (const auto &stray : points.strays)
      if (!points.cuts.contains(stray.row))
        add_to_mean(stray.row, stray_gradient(stray), stray.leaf);
    for (unsigned int i = 0; i < points.cuts.size(); ++i)
      add_to_mean(points.cuts.row[i], cut_gradient(i), points.cuts.mean[i]);
  }

  void add_to_mean(const std::size_t row, const Matrix<dim, double> &l, const unsigned int place)
  {
    const double v = volume(row);
    points.means.add_sums(place, v, v * trace<dim>(l), points.column(Layout::mass)[row]);
  }

  double volume(const std::size_t row) const
  {
    return points.column(Layout::mass)[row] / points.column(Layout::density)[row];
  }

  void sweep_cell(const unsigned int leaf)
  {
    const double       size = octree.size(leaf), inverse_size = 1. / size;
    const auto        &nodes = octree.nodes(leaf);
    const unsigned int begin = points.cell_begin()[leaf], end = points.cell_begin()[leaf + 1];
    gradients.resize((end - begin + pack_size - 1) / pack_size);
    Pack8 weights{}, divergences{}, masses{};
    for (unsigned int row = begin, k = 0; row < end; row += pack_size, ++k)
      {
        const Vector<dim, Pack8> x = load_vector(points, Layout::position, row);
        Vector<dim, Pack8>       xi;
        for (int d = 0; d < dim; ++d)
          xi[d] = (x[d] - octree.lower(leaf)[d]) * inverse_size;
        gradients[k] = gradient(PackShape<dim>(xi), inverse_size, nodes);
        if (cell_mean)
          {
            const Pack8 m       = load<Pack8>(points.column(Layout::mass) + row);
            const Pack8 v       = m / load<Pack8>(points.column(Layout::density) + row);
            const Mask8 counted = inside(leaf, row, x) & first_lanes(end - row);
            masses += select(counted, m, Pack8{});
            weights += select(counted, v, Pack8{});
            divergences += select(counted, Pack8(v * trace<dim, Pack8>(gradients[k])), Pack8{});
          }
      }
    if (cell_mean)
      {
        points.means.add_sums(leaf, sum(weights), sum(divergences), sum(masses));
        take_means(leaf);
      }
    for (unsigned int row = begin, k = 0; row < end; row += pack_size, ++k)
      {
        const Mask8 here = inside(leaf, row, load_vector(points, Layout::position, row));
        update_rows(row, std::min<unsigned int>(pack_size, end - row), here, size, gradients[k]);
      }
    end_cell(size);
  }

  void take_means(const unsigned int place)
  {
    mean_divergence      = points.means.mean(place);
    mean_specific_volume = points.means.weight_per_mass(place);
  }

  // One square root a cell. Comparisons turn a NaN into 0 here; the sums find it.
  void end_cell(const double size)
  {
    const double rate     = (largest(wave_speed) + std::sqrt(largest(speed_square))) / size;
    result.rate           = std::max(result.rate, rate);
    result.diffusion_rate = std::max(result.diffusion_rate, material.diffusivity() / (size * size));
    speed_square = wave_speed = Pack8{};
    if (exact_work)
      {
        result.exact_work.add(sum(work));
        work = Pack8{};
      }
  }

  Matrix<dim, double> stray_gradient(const typename MaterialPoints<dim>::Stray &stray) const
  {
    Matrix<dim, double> l{};
    const double        half = gimp ? 0.5 * points.column(Layout::size)[stray.row] : 0.;
    for_each_piece(octree,
                   points.position(stray.row),
                   half,
                   [&](const int leaf, const dealii::Point<dim> &piece, const double fraction) {
                     const CornerShape<dim> shape(unit_coordinates(octree, leaf, piece));
                     const double           scale = fraction / octree.size(leaf);
                     for (int c = 0; c < (1 << dim); ++c)
                       for (int d = 0; d < dim; ++d)
                         for (int e = 0; e < dim; ++e)
                           l[d][e] += scale * shape.gradient[e][c] *
                                      velocity[octree.nodes(leaf)[c]][place + d];
                   });
    return l;
  }

  Matrix<dim, double> cut_gradient(const unsigned int i) const
  {
    Matrix<dim, double> l{};
    for (std::size_t k = points.cuts.begin[i]; k < points.cuts.begin[i + 1]; ++k)
      {
        const auto &entry = points.cuts.entries[k];
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            l[d][e] += entry.gradient[e] * velocity[entry.node][place + d];
      }
    return l;
  }

  // A particle on its own: a stray or one that a sheet cuts.
  void update_lone(const std::size_t          row,
                   const Matrix<dim, double> &scalar,
                   const unsigned int         leaf,
                   const unsigned int         mean)
  {
    Matrix<dim, Pack8> l;
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        l[d][e] = splat<Pack8>(scalar[d][e]);
    Mask8 first{};
    first[0] = -1;
    if (cell_mean)
      take_means(mean);
    update_rows(row, 1, first, octree.size(leaf), l);
    end_cell(octree.size(leaf));
  }

  // Rows row ... row + n_lanes - 1 where `here`; the other lanes are computed and thrown away.
  void update_rows(const std::size_t   row,
                   const int           n_lanes,
                   const Mask8        &here,
                   const double        size,
                   Matrix<dim, Pack8> &l)
  {
    Pack8 divergence = trace<dim, Pack8>(l);
    if (cell_mean)
      {
        const Pack8 change = (mean_divergence - divergence) / double(dim);
        for (int d = 0; d < dim; ++d)
          l[d][d] += change;
        divergence = splat<Pack8>(mean_divergence);
      }
    Motion<dim, Pack8> motion;
    motion.velocity_gradient = l;
    motion.dt                = dt;
    motion.length            = splat<Pack8>(size);
    double *const density    = points.column(Layout::density) + row;
    const Pack8   old        = load<Pack8>(density);
    // The sum of volumes is that of the unsmoothed ones: mean volume per mass is the cell's.
    const Pack8 start =
      smoothing > 0 ? 1. / ((1. - smoothing) / old + smoothing * mean_specific_volume) : old;
    motion.density = start / (1. + dt * divergence);
    // A lone particle may be asked to lose all its volume in a step: to first order the same, but
    // always positive. F keeps its own volume.
    if constexpr (!Material::needs_deformation_gradient)
      motion.density =
        select(divergence < 0., Pack8(start * (1. - dt * divergence)), motion.density);
    const Pack8 mass       = load<Pack8>(points.column(Layout::mass) + row);
    const Pack8 mid_volume = 0.5 * mass * (1. / start + 1. / motion.density);
    store_first(density, select(here, motion.density, old), n_lanes);
    if constexpr (Material::needs_deformation_gradient)
      update_deformation(row, n_lanes, here, motion);

    Pack8 power;
    if constexpr (Material::isotropic_stress)
      {
        double *const pressure = points.column(Layout::stress) + row;
        const Pack8 before = load<Pack8>(pressure), after = material.template pressure<dim>(motion);
        store_first(pressure, select(here, after, before), n_lanes);
        power = -0.5 * (before + after) * divergence;
      }
    else
      power = update_tensor(row, n_lanes, here, motion);

    Pack8 square{};
    for (int d = 0; d < dim; ++d)
      {
        const Pack8 v = load<Pack8>(points.column(Layout::velocity + d) + row);
        square += v * v;
      }
    const Mask8 counted = here & (mass > 0.) & first_lanes(n_lanes);
    work += select(counted, Pack8(dt * mid_volume * power), Pack8{});
    kinetic += select(counted, Pack8(0.5 * mass * square), Pack8{});
    speed_square = select(counted, max(speed_square, square), speed_square);
    wave_speed =
      select(counted,
             max(wave_speed, Pack8(splat<Pack8>(0.) + material.sound_speed(motion.density))),
             wave_speed);
    // Written so that a NaN replaces what is there.
    smallest_density =
      select(counted & ~(motion.density >= smallest_density), motion.density, smallest_density);
  }

  // F <- (1 + dt L) F, with the third diagonal entry of plane strain equal to one.
  void update_deformation(const std::size_t   row,
                          const int           n_lanes,
                          const Mask8        &here,
                          Motion<dim, Pack8> &motion)
  {
    Matrix<dim, Pack8> step  = identity<dim, Pack8>(), f;
    const int          first = points.layout().deformation_gradient;
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        {
          step[d][e] += dt * motion.velocity_gradient[d][e];
          f[d][e] = load<Pack8>(points.column(first + dim * d + e) + row);
        }
    motion.deformation_gradient = product<dim, Pack8>(step, f);
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        store_first(points.column(first + dim * d + e) + row,
                    select(here, motion.deformation_gradient[d][e], f[d][e]),
                    n_lanes);
  }

  Pack8 update_tensor(const std::size_t   row,
                      const int           n_lanes,
                      const Mask8        &here,
                      Motion<dim, Pack8> &motion)
  {
    // The grid gives the gradient at the step's start; rate forms ask for the middle.
    motion.velocity_gradient = mid_step_gradient<dim, Pack8>(motion.velocity_gradient, dt);
    constexpr int         n  = Symmetric<dim, Pack8>::size;
    Symmetric<dim, Pack8> before, after;
    for (int k = 0; k < n; ++k)
      before[k] = load<Pack8>(points.column(Layout::stress + k) + row);
    after = before;
    std::array<Pack8, Material::n_history + 1> history, old_history;
    for (int k = 0; k < Material::n_history; ++k)
      history[k] = load<Pack8>(points.column(points.layout().history + k) + row);
    old_history = history;
    material.template update<dim>(motion, after, history.data());
    for (int k = 0; k < n; ++k)
      store_first(points.column(Layout::stress + k) + row,
                  select(here, after[k], before[k]),
                  n_lanes);
    for (int k = 0; k < Material::n_history; ++k)
      store_first(points.column(points.layout().history + k) + row,
                  select(here, history[k], old_history[k]),
                  n_lanes);
    const Symmetric<dim, Pack8> rate = symmetric_part<dim, Pack8>(motion.velocity_gradient);
    Pack8                       power{};
    for (int k = 0; k < n; ++k)
      power += (k < 3 ? 0.5 : 1.) * (before[k] + after[k]) * rate[k];
    return power;
  }

  void find_bad_row()
  {
    for (std::size_t row = 0; row < points.n_rows(); ++row)
      if (!points.is_hole(row))
        {
          const double rho = points.column(Layout::density)[row];
          double       all = rho + points.column(Layout::stress)[row];
          for (int d = 0; d < dim; ++d)
            all += points.column(Layout::velocity + d)[row];
          if (!std::isfinite(all) || !(rho > 0))
            {
              result.bad_row = row;
              return;
            }
        }
  }
};
} // namespace

template <int dim>
StressSweep
update_particle_stress(const Octree<dim>     &octree,
                       const NodeRecords     &velocity,
                       const unsigned int     velocity_place,
                       const MaterialVariant &material,
                       const StressOptions   &options,
                       MaterialPoints<dim>   &points)
{
  return std::visit(
    [&](const auto &model) {
      const bool cell_mean = options.volume_strain == VolumeStrain::cell_mean;
      Sweep<dim, std::decay_t<decltype(model)>> sweep{octree,
                                                      velocity,
                                                      velocity_place,
                                                      model,
                                                      options.shape == ParticleShape::gimp,
                                                      cell_mean,
                                                      cell_mean ? options.volume_smoothing : 0.,
                                                      options.dt,
                                                      options.exact_work,
                                                      points};
      sweep.run();
      return sweep.result;
    },
    material);
}

template <int dim>
void
initialise_particle_stress(const MaterialVariant &material, MaterialPoints<dim> &points)
{
  std::visit(
    [&](const auto &model) {
      using Material = std::decay_t<decltype(model)>;
      for (std::size_t row = 0; row < points.n_rows(); ++row)
        {
          Motion<dim, double> motion{};
          motion.deformation_gradient = identity<dim, double>();
          motion.density              = points.column(ParticleLayout<dim>::density)[row];
          if constexpr (Material::isotropic_stress)
            points.column(ParticleLayout<dim>::stress)[row] = model.template pressure<dim>(motion);
          if constexpr (Material::needs_deformation_gradient)
            for (int d = 0; d < dim; ++d)
              points.column(points.layout().deformation_gradient + (dim + 1) * d)[row] = 1.;
        }
    },
    material);
}

#define INSTANTIATE(dim)                                               \
  template StressSweep update_particle_stress(const Octree<dim> &,     \
                                              const NodeRecords &,     \
                                              const unsigned int,      \
                                              const MaterialVariant &, \
                                              const StressOptions &,   \
                                              MaterialPoints<dim> &);  \
  template void        initialise_particle_stress(const MaterialVariant &, MaterialPoints<dim> &);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
