// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/grid/locate.h>
#include <coracle/grid/transfer.h>

#include <map>
#include <optional>
#include <sstream>

namespace coracle
{
namespace
{
template <int dim>
using Layout = ParticleLayout<dim>;

template <int dim>
RunFailure
lost(const MaterialPoints<dim> &points,
     const std::size_t          row,
     const std::string         &what,
     const double               time)
{
  std::ostringstream details;
  details.precision(6);
  details << "particle " << points.id(row) << " of '" << points.name() << "' at ("
          << points.position(row) << ") m, t = " << time << " s, velocity (";
  for (int d = 0; d < dim; ++d)
    details << (d > 0 ? " " : "") << points.column(Layout<dim>::velocity + d)[row];
  details << ") m/s: " << what;
  return RunFailure("a particle left the box",
                    details.str(),
                    "enlarge the box, make the face open, or lower the time step's safety factor");
}

// Rows that are not wholly in their home cell any more, in order; positions are updated on the way.
template <int dim>
std::vector<unsigned int>
take_positions(const Octree<dim> &octree, const double margin_of_shape, MaterialPoints<dim> &points)
{
  std::vector<unsigned int> leavers;
  unsigned int              last = 0;
  for (const unsigned int leaf : points.occupied_cells())
    {
      const unsigned int end = points.cell_begin()[leaf + 1];
      for (unsigned int row = points.cell_begin()[leaf]; row < end; row += pack_size)
        {
          const int                n_lanes = std::min<unsigned int>(pack_size, end - row);
          const Vector<dim, Pack8> next    = load_vector(points, Layout<dim>::next_position, row);
          for (int d = 0; d < dim; ++d)
            store_first(points.column(Layout<dim>::position + d) + row, next[d], n_lanes);
          const Pack8 margin =
            margin_of_shape * load<Pack8>(points.column(Layout<dim>::size) + row);
          const Mask8 inside =
            inside_cell<dim>(next, octree.lower(leaf), octree.size(leaf), margin);
          for (int l = 0; l < n_lanes; ++l)
            if (__builtin_expect(inside[l] == 0, 0))
              leavers.push_back(row + l);
        }
      last = end;
    }
  for (unsigned int row = last; row < points.n_rows(); ++row)
    {
      for (int d = 0; d < dim; ++d)
        points.column(Layout<dim>::position + d)[row] =
          points.column(Layout<dim>::next_position + d)[row];
      leavers.push_back(row);
    }
  return leavers;
}

// A particle with an extent moves with the mean of the grid over its box, which is not zero at a
// closed face: its centre stays at the face, by less than its own reach.
template <int dim>
void
hold_at_closed_faces(const BoxBoundary<dim>         &boundary,
                     const dealii::BoundingBox<dim> &box,
                     const double                    margin_of_shape,
                     const std::size_t               row,
                     MaterialPoints<dim>            &points)
{
  const double reach = margin_of_shape * points.column(Layout<dim>::size)[row];
  for (int d = 0; d < dim; ++d)
    {
      double      &x     = points.column(Layout<dim>::position + d)[row];
      const double lower = box.lower_bound(d), upper = box.upper_bound(d);
      if (x < lower && x > lower - reach && boundary.condition(2 * d) != FaceCondition::open)
        x = lower;
      if (x > upper && x < upper + reach && boundary.condition(2 * d + 1) != FaceCondition::open)
        x = upper;
    }
}

constexpr int tag_migration = 7310;

// Neighbours are the ranks that own ghost leaves; each gets one message a step, possibly empty.
template <int dim>
unsigned int
exchange_rows(const Octree<dim>                        &octree,
              const std::map<int, std::vector<double>> &outgoing,
              MaterialPoints<dim>                      &points)
{
  const MPI_Comm                   comm       = octree.triangulation.get_communicator();
  const auto                      &neighbours = octree.triangulation.ghost_owners();
  std::vector<MPI_Request>         requests;
  static const std::vector<double> nothing;
  for (const int rank : neighbours)
    {
      const auto  found = outgoing.find(rank);
      const auto &rows  = found == outgoing.end() ? nothing : found->second;
      requests.emplace_back();
      MPI_Isend(rows.data(), rows.size(), MPI_DOUBLE, rank, tag_migration, comm, &requests.back());
    }
  unsigned int        received = 0;
  const unsigned int  width    = points.columns.n_columns();
  std::vector<double> rows;
  for (const int rank : neighbours)
    {
      MPI_Status status;
      MPI_Probe(rank, tag_migration, comm, &status);
      int count = 0;
      MPI_Get_count(&status, MPI_DOUBLE, &count);
      rows.resize(count);
      MPI_Recv(rows.data(), count, MPI_DOUBLE, rank, tag_migration, comm, MPI_STATUS_IGNORE);
      for (int first = 0; first < count; first += width, ++received)
        points.append(rows.data() + first);
    }
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
  return received;
}
} // namespace

template <int dim>
unsigned int
move_and_locate(const Octree<dim>      &octree,
                const BoxBoundary<dim> &boundary,
                const double            margin_of_shape,
                const double            time,
                MaterialPoints<dim>    &points)
{
  const std::vector<unsigned int>    leavers = take_positions(octree, margin_of_shape, points);
  std::map<int, std::vector<double>> outgoing;
  std::optional<RunFailure>          failure;
  points.strays.clear();
  for (const unsigned int row : leavers)
    {
      if (points.is_hole(row))
        continue;
      hold_at_closed_faces(boundary, octree.box(), margin_of_shape, row, points);
      const dealii::Point<dim> x    = points.position(row);
      const int                leaf = octree.find(x);
      if (leaf >= 0 && leaf < static_cast<int>(octree.n_owned_leaves()))
        points.strays.push_back({row, leaf});
      else if (leaf >= 0)
        {
          auto &buffer = outgoing[octree.owner(leaf)];
          buffer.resize(buffer.size() + points.columns.n_columns());
          points.columns.get_row(row, buffer.data() + buffer.size() - points.columns.n_columns());
          points.remove(row);
        }
      else
        {
          const unsigned int face = boundary.face_left(x);
          std::string        why;
          if (!std::isfinite(x.norm()))
            why = "its position is not a number";
          else if (octree.box().point_inside(x))
            why = "it crossed more than a whole cell in one step";
          else if (boundary.condition(face) != FaceCondition::open)
            why = "face '" + BoxBoundary<dim>::face_name(face) + "' is not open";
          if (!why.empty() && !failure)
            failure.emplace(lost(points, row, why, time));
          points.remove(row);
          ++points.ledger.removed;
        }
    }
  const unsigned int first    = points.n_rows();
  const unsigned int received = exchange_rows(octree, outgoing, points);
  for (unsigned int row = first; row < points.n_rows(); ++row)
    points.strays.push_back({row, octree.find(points.position(row))});
  // Only now, because other ranks wait for this one in the exchange.
  if (failure)
    throw *failure;
  return received;
}

namespace
{
// A GIMP particle that reaches into a neighbour is a stray even in its home cell, and so is any
// on the upper face of the box, which no cell's half-open range holds.
template <int dim>
void
sort_rows(const Octree<dim>      &octree,
          const double            margin_of_shape,
          const std::vector<int> &cell,
          MaterialPoints<dim>    &points)
{
  points.sort(octree.n_owned_leaves(), cell);
  for (const unsigned int leaf : points.occupied_cells())
    for (unsigned int row = points.cell_begin()[leaf]; row < points.cell_begin()[leaf + 1]; ++row)
      {
        const double margin = margin_of_shape * points.column(Layout<dim>::size)[row];
        if (!is_inside_leaf(octree, leaf, points.position(row), margin))
          points.strays.push_back({row, static_cast<int>(leaf)});
      }
}
} // namespace

template <int dim>
void
redistribute(const Octree<dim> &octree, const double margin_of_shape, MaterialPoints<dim> &points)
{
  const MPI_Comm                              comm  = octree.triangulation.get_communicator();
  const int                                   me    = mpi::rank(comm);
  const unsigned int                          width = points.columns.n_columns();
  std::map<unsigned int, std::vector<double>> outgoing;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      if (const int owner = octree.owner_of(points.position(row)); owner != me)
        {
          auto &buffer = outgoing[owner];
          buffer.resize(buffer.size() + width);
          points.columns.get_row(row, buffer.data() + buffer.size() - width);
          points.remove(row);
        }
  for (const auto &[rank, rows] : mpi::exchange_values(outgoing, comm))
    for (std::size_t first = 0; first < rows.size(); first += width)
      points.append(rows.data() + first);
  std::vector<int> cell(points.n_rows(), 0);
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      {
        cell[row] = octree.find(points.position(row));
        Assert(cell[row] >= 0 && cell[row] < static_cast<int>(octree.n_owned_leaves()),
               dealii::ExcInternalError());
      }
  sort_rows(octree, margin_of_shape, cell, points);
}

template <int dim>
void
sort_by_leaf(const Octree<dim> &octree, const double margin_of_shape, MaterialPoints<dim> &points)
{
  std::vector<int> cell(points.n_rows(), 0);
  for (const unsigned int leaf : points.occupied_cells())
    std::fill(cell.begin() + points.cell_begin()[leaf],
              cell.begin() + points.cell_begin()[leaf + 1],
              leaf);
  // Everything behind the sorted rows was appended; right after generation that is all.
  for (std::size_t row = points.cell_begin().back(); row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      cell[row] = octree.find(points.position(row));
  for (const auto &stray : points.strays)
    cell[stray.row] = stray.leaf;
  sort_rows(octree, margin_of_shape, cell, points);
}

#define INSTANTIATE(dim)                                                                        \
  template unsigned int move_and_locate(const Octree<dim> &,                                    \
                                        const BoxBoundary<dim> &,                               \
                                        const double,                                           \
                                        const double,                                           \
                                        MaterialPoints<dim> &);                                 \
  template void         redistribute(const Octree<dim> &, const double, MaterialPoints<dim> &); \
  template void         sort_by_leaf(const Octree<dim> &, const double, MaterialPoints<dim> &);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
