// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/transfer.h>

namespace coracle
{
namespace
{
// What the grid tells one particle, or a pack of them.
template <int dim, typename T>
struct Taken
{
  Vector<dim, T> velocity{}, change{}, shift{};
  Matrix<dim, T> gradient{};
};

template <int dim, bool affine, bool remap>
class Sweep
{
public:
  using Layout   = ParticleLayout<dim>;
  using Motion   = typename NodalField<dim>::Motion;
  using Gathered = typename NodalField<dim>::Gathered;

  Sweep(const Octree<dim>     &octree,
        const TransferOptions &options,
        const double           dt,
        NodalField<dim>       &field,
        MaterialPoints<dim>   &points)
    : octree(octree)
    , gimp(options.shape == ParticleShape::gimp)
    , pic(affine ? 1. : options.pic_fraction)
    , dt(dt)
    , field(field)
    , motion(field.motion())
    , points(points)
    , affine_column(points.layout().affine)
    , cutting(!points.cuts.empty())
  {}

  /// Kinetic energy of the particles afterwards.
  double run()
  {
    for (const unsigned int leaf : points.occupied_cells())
      sweep_cell(leaf);
    for (const auto &stray : points.strays)
      if (!points.cuts.contains(stray.row))
        sweep_stray(stray);
    for (unsigned int i = 0; i < points.cuts.size(); ++i)
      sweep_cut(i);
    return sum(kinetic);
  }

private:
  // Corner by corner, its record broadcast to all lanes.
  void take(const PackShape<dim>                       &shape,
            const double                                inverse_size,
            const std::array<unsigned int, (1 << dim)> &nodes,
            const bool                                  shifted,
            Taken<dim, Pack8>                          &taken) const
  {
    for (int c = 0; c < (1 << dim); ++c)
      {
        const NodeRecord &node = motion[nodes[c]];
        const Pack8       w    = shape.value(c);
        for (int d = 0; d < dim; ++d)
          {
            taken.velocity[d] += w * node[Motion::velocity + d];
            if constexpr (!affine)
              taken.change[d] += w * node[Motion::change + d];
          }
        if constexpr (affine)
          for (int e = 0; e < dim; ++e)
            {
              const Pack8 slope = shape.gradient(c, e) * inverse_size;
              for (int d = 0; d < dim; ++d)
                taken.gradient[d][e] += slope * node[Motion::velocity + d];
            }
        if (shifted)
          for (int d = 0; d < dim; ++d)
            taken.shift[d] += w * field.shift(nodes[c])[d];
      }
  }

  template <typename T>
  Vector<dim, T> new_velocity(const Vector<dim, T> &old, const Taken<dim, T> &taken) const
  {
    Vector<dim, T> v;
    for (int d = 0; d < dim; ++d)
      v[d] = affine ? taken.velocity[d]
                    : (1. - pic) * (old[d] + taken.change[d]) + pic * taken.velocity[d];
    return v;
  }

  bool any_shifted(const std::array<unsigned int, (1 << dim)> &nodes) const
  {
    for (const unsigned int node : nodes)
      if (field.is_shifted(node))
        return true;
    return false;
  }

  void sweep_cell(const unsigned int leaf)
  {
    const auto               &nodes = octree.nodes(leaf);
    const dealii::Point<dim> &lower = octree.lower(leaf);
    const double              size = octree.size(leaf), inverse_size = 1. / size;
    const bool                shifted = field.has_shift() && any_shifted(nodes);
    const unsigned int        end     = points.cell_begin()[leaf + 1];
    CornerSums<dim>           sums;
    for (unsigned int row = points.cell_begin()[leaf]; row < end; row += pack_size)
      {
        const Vector<dim, Pack8> x = load_vector(points, Layout::position, row);
        const Pack8 margin = gimp ? 0.5 * load<Pack8>(points.column(Layout::size) + row) : Pack8{};
        Mask8       here   = inside_cell<dim>(x, lower, size, margin);
        if (cutting)
          here &= points.cuts.others(row);
        Vector<dim, Pack8> xi;
        for (int d = 0; d < dim; ++d)
          xi[d] = (x[d] - lower[d]) * inverse_size;

        Taken<dim, Pack8> taken;
        take(PackShape<dim>(xi), inverse_size, nodes, shifted, taken);

        const Vector<dim, Pack8> old     = load_vector(points, Layout::velocity, row);
        const Vector<dim, Pack8> v       = new_velocity(old, taken);
        const int                n_lanes = std::min<unsigned int>(pack_size, end - row);
        for (int d = 0; d < dim; ++d)
          {
            // Strays keep their velocity here: they are taken care of below, with their own cell.
            store_first(points.column(Layout::velocity + d) + row,
                        select(here, v[d], old[d]),
                        n_lanes);
            store_first(points.column(Layout::next_position + d) + row,
                        Pack8(x[d] + dt * taken.velocity[d] + taken.shift[d]),
                        n_lanes);
          }
        if constexpr (affine)
          store_affine(row, n_lanes, here, taken);
        const Pack8 m = load<Pack8>(points.column(Layout::mass) + row);
        Pack8       square{};
        for (int d = 0; d < dim; ++d)
          square += v[d] * v[d];
        kinetic += select(Mask8(here & first_lanes(n_lanes)), Pack8(0.5 * m * square), Pack8{});
        if constexpr (remap)
          for (int l = 0; l < n_lanes; ++l)
            if (__builtin_expect(here[l] != 0, 1))
              {
                Vector<dim, double> xi_l, v_l;
                for (int d = 0; d < dim; ++d)
                  {
                    xi_l[d] = xi[d][l];
                    v_l[d]  = v[d][l];
                  }
                if constexpr (affine)
                  give_back(row + l, xi_l, size, 1., dealii::Tensor<1, dim>(), sums);
                else
                  sums.add_momentum(CornerShape<dim>(xi_l), m[l], v_l);
              }
      }
    if constexpr (remap)
      sums.give_to(field, nodes);
  }

  void store_affine(const std::size_t        row,
                    const int                n_lanes,
                    const Mask8             &here,
                    const Taken<dim, Pack8> &taken)
  {
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        {
          double *const column = points.column(affine_column + dim * d + e) + row;
          store_first(column, select(here, taken.gradient[d][e], load<Pack8>(column)), n_lanes);
        }
  }

  void sweep_stray(const typename MaterialPoints<dim>::Stray &stray)
  {
    const std::size_t  row    = stray.row;
    const auto         centre = points.position(row);
    const double       half   = gimp ? 0.5 * points.column(Layout::size)[row] : 0.;
    Taken<dim, double> taken;
    for_each_piece(octree,
                   centre,
                   half,
                   [&](const int leaf, const dealii::Point<dim> &piece, const double fraction) {
                     take_piece(leaf, piece, fraction, taken);
                   });
    update_row(row, taken);
    if constexpr (remap)
      for_each_piece(octree,
                     centre,
                     half,
                     [&](const int leaf, const dealii::Point<dim> &piece, const double fraction) {
                       CornerSums<dim> sums;
                       give_back(row,
                                 unit_coordinates(octree, leaf, piece),
                                 octree.size(leaf),
                                 fraction,
                                 piece - centre,
                                 sums);
                       sums.give_to(field, octree.nodes(leaf));
                     });
  }

  // One particle with what it has taken.
  void update_row(const std::size_t row, const Taken<dim, double> &taken)
  {
    const Vector<dim, double> v = new_velocity(get_vector(points, Layout::velocity, row), taken);
    for (int d = 0; d < dim; ++d)
      {
        kinetic[0] += 0.5 * points.column(Layout::mass)[row] * v[d] * v[d];
        points.column(Layout::velocity + d)[row] = v[d];
        points.column(Layout::next_position + d)[row] =
          points.column(Layout::position + d)[row] + dt * taken.velocity[d] + taken.shift[d];
        if constexpr (affine)
          for (int e = 0; e < dim; ++e)
            points.column(affine_column + dim * d + e)[row] = taken.gradient[d][e];
      }
  }

  void sweep_cut(const unsigned int i)
  {
    const unsigned int row   = points.cuts.row[i];
    const auto        *begin = points.cuts.entries.data() + points.cuts.begin[i],
               *end          = points.cuts.entries.data() + points.cuts.begin[i + 1];
    Taken<dim, double> taken;
    for (const auto *entry = begin; entry != end; ++entry)
      {
        const NodeRecord &node = motion[entry->node];
        for (int d = 0; d < dim; ++d)
          {
            taken.velocity[d] += entry->value * node[Motion::velocity + d];
            taken.change[d] += entry->value * node[Motion::change + d];
            taken.shift[d] += entry->value * field.shift(entry->node)[d];
            for (int e = 0; e < dim; ++e)
              taken.gradient[d][e] += entry->gradient[e] * node[Motion::velocity + d];
          }
      }
    update_row(row, taken);
    if constexpr (remap)
      {
        const double              m        = points.column(Layout::mass)[row];
        const Vector<dim, double> velocity = get_vector(points, Layout::velocity, row);
        for (const auto *entry = begin; entry != end; ++entry)
          for (int d = 0; d < dim; ++d)
            field.give(entry->node,
                       Gathered::momentum + d,
                       m * entry_velocity<dim, affine>(points, row, velocity, *entry, d));
      }
  }

  void take_piece(const int                 leaf,
                  const dealii::Point<dim> &piece,
                  const double              fraction,
                  Taken<dim, double>       &taken) const
  {
    const CornerShape<dim> shape(unit_coordinates(octree, leaf, piece));
    const auto            &nodes = octree.nodes(leaf);
    for (int c = 0; c < (1 << dim); ++c)
      {
        const NodeRecord &node = motion[nodes[c]];
        const double      w    = fraction * shape.value[c];
        for (int d = 0; d < dim; ++d)
          {
            taken.velocity[d] += w * node[Motion::velocity + d];
            taken.change[d] += w * node[Motion::change + d];
            taken.shift[d] += w * field.shift(nodes[c])[d];
            for (int e = 0; e < dim; ++e)
              taken.gradient[d][e] +=
                fraction * shape.gradient[e][c] / octree.size(leaf) * node[Motion::velocity + d];
          }
      }
  }

  // The updated momentum of a particle or a piece, for the second gathering.
  void give_back(const std::size_t             row,
                 const Vector<dim, double>    &xi,
                 const double                  size,
                 const double                  fraction,
                 const dealii::Tensor<1, dim> &offset,
                 CornerSums<dim>              &sums) const
  {
    const CornerShape<dim>    shape(xi);
    const double              m = fraction * points.column(Layout::mass)[row];
    const Vector<dim, double> v = get_vector(points, Layout::velocity, row);
    if constexpr (affine)
      {
        Vector<dim, CornerPack<dim>> arm;
        Matrix<dim, double>          c;
        for (int d = 0; d < dim; ++d)
          {
            arm[d] = (corner_bits<dim>(d) - xi[d]) * size + offset[d];
            for (int e = 0; e < dim; ++e)
              c[d][e] = points.column(affine_column + dim * d + e)[row];
          }
        sums.add_affine_momentum(shape, m, v, c, arm);
      }
    else
      sums.add_momentum(shape, m, v);
  }

  const Octree<dim>   &octree;
  const bool           gimp;
  const double         pic, dt;
  NodalField<dim>     &field;
  const NodeRecords   &motion;
  MaterialPoints<dim> &points;
  const int            affine_column;
  const bool           cutting;
  Pack8                kinetic{};
};
} // namespace

template <int dim>
double
grid_to_particles(const Octree<dim>     &octree,
                  const TransferOptions &options,
                  const double           dt,
                  const bool             remap,
                  NodalField<dim>       &field,
                  MaterialPoints<dim>   &points)
{
  const bool affine = points.layout().affine >= 0;
  if (affine && remap)
    return Sweep<dim, true, true>(octree, options, dt, field, points).run();
  if (affine)
    return Sweep<dim, true, false>(octree, options, dt, field, points).run();
  if (remap)
    return Sweep<dim, false, true>(octree, options, dt, field, points).run();
  return Sweep<dim, false, false>(octree, options, dt, field, points).run();
}

template double grid_to_particles(const Octree<2> &,
                                  const TransferOptions &,
                                  const double,
                                  const bool,
                                  NodalField<2> &,
                                  MaterialPoints<2> &);
template double grid_to_particles(const Octree<3> &,
                                  const TransferOptions &,
                                  const double,
                                  const bool,
                                  NodalField<3> &,
                                  MaterialPoints<3> &);
} // namespace coracle
