// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/halo.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace coracle::meshless
{
namespace
{
template <int dim>
struct Record
{
  /// That of the point, and what is added to it.
  dealii::Point<dim>     position;
  dealii::Tensor<1, dim> shift;
  double                 spacing;
  std::uint64_t          id;
  PointKind              kind;
};

template <int dim>
struct Corners
{
  dealii::Point<dim> low, high;

  double distance_square(const dealii::Point<dim> &p) const
  {
    double result = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double outside = std::max({0., low[d] - p[d], p[d] - high[d]});
        result += outside * outside;
      }
    return result;
  }

  Corners moved(const dealii::Tensor<1, dim> &shift) const { return {low + shift, high + shift}; }

  double distance_square(const Corners &other) const
  {
    double result = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double between = std::max({0., low[d] - other.high[d], other.low[d] - high[d]});
        result += between * between;
      }
    return result;
  }
};

/// Box around the own points; of a rank without points infinitely far from everything.
template <int dim>
Corners<dim>
box_around_own(const PointCloud<dim> &points)
{
  Corners<dim> box;
  for (unsigned int d = 0; d < dim; ++d)
    {
      box.low[d]  = std::numeric_limits<double>::infinity();
      box.high[d] = -std::numeric_limits<double>::infinity();
    }
  for (std::size_t i = 0; i < points.n_own; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.low[d]  = std::min(box.low[d], points.position[i][d]);
        box.high[d] = std::max(box.high[d], points.position[i][d]);
      }
  return box;
}

template <int dim>
void
resize(PointCloud<dim> &points, const std::size_t n)
{
  points.position.resize(n);
  points.spacing.resize(n);
  points.id.resize(n);
  points.kind.resize(n);
}

/// Copies in the order of their ids, images of one point in that of their shifts.
template <int dim>
std::vector<unsigned int>
order_of(const std::vector<std::pair<unsigned int, Record<dim>>> &copies)
{
  std::vector<unsigned int> order(copies.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](const unsigned int a, const unsigned int b) {
    const auto &first = copies[a].second, &second = copies[b].second;
    if (first.id != second.id)
      return first.id < second.id;
    for (unsigned int d = 0; d < dim; ++d)
      if (first.shift[d] != second.shift[d])
        return first.shift[d] < second.shift[d];
    return false;
  });
  return order;
}
} // namespace

template <int dim>
void
Halo::rebuild(PointCloud<dim> &points, const double width, const Period<dim> &period)
{
  n_own_rows = points.n_own;
  resize(points, n_own_rows);
  lent.clear();
  borrowed.clear();

  const unsigned int        me = mpi::rank(comm), n_ranks = mpi::n_ranks(comm);
  const Corners<dim>        mine = box_around_own(points);
  std::vector<Corners<dim>> boxes(n_ranks);
  MPI_Allgather(&mine, sizeof(mine), MPI_BYTE, boxes.data(), sizeof(mine), MPI_BYTE, comm);

  std::map<unsigned int, std::vector<Record<dim>>> sent;
  for (const auto &shift : period.shifts())
    for (unsigned int r = 0; r < n_ranks; ++r)
      if ((r != me || shift.norm_square() > 0) &&
          boxes[r].distance_square(mine.moved(shift)) <= width * width)
        for (unsigned int i = 0; i < n_own_rows; ++i)
          if (boxes[r].distance_square(points.position[i] + shift) <= width * width)
            {
              lent[r].push_back(i);
              sent[r].push_back(
                {points.position[i], shift, points.spacing[i], points.id[i], points.kind[i]});
            }

  const auto                                        received = mpi::exchange_values(sent, comm);
  std::vector<std::pair<unsigned int, Record<dim>>> copies;
  for (const auto &[rank, records] : received)
    for (const auto &record : records)
      copies.emplace_back(rank, record);
  const auto                order = order_of(copies);
  std::vector<unsigned int> place(copies.size());

  resize(points, n_own_rows + copies.size());
  owner_of_copy.resize(copies.size());
  images.clear();
  for (unsigned int c = 0; c < copies.size(); ++c)
    {
      const auto &[rank, record]      = copies[order[c]];
      place[order[c]]                 = n_own_rows + c;
      owner_of_copy[c]                = rank;
      points.position[n_own_rows + c] = record.position + record.shift;
      points.spacing[n_own_rows + c]  = record.spacing;
      points.id[n_own_rows + c]       = record.id;
      points.kind[n_own_rows + c]     = record.kind;
      if (record.shift.norm_square() > 0)
        {
          auto &[copy, shift] = images.emplace_back(c, std::array<double, 3>{});
          for (unsigned int d = 0; d < dim; ++d)
            shift[d] = record.shift[d];
        }
    }
  for (unsigned int c = 0; c < copies.size(); ++c)
    borrowed[copies[c].first].push_back(place[c]);
}

void
Halo::exchange(std::map<unsigned int, mpi::Buffer> &sent,
               std::map<unsigned int, mpi::Buffer> &received) const
{
  constexpr int            tag = 4811; // no other exchange may probe for it
  std::vector<MPI_Request> requests;
  requests.reserve(sent.size() + received.size());
  for (auto &[rank, buffer] : received)
    MPI_Irecv(buffer.data(), buffer.size(), MPI_BYTE, rank, tag, comm, &requests.emplace_back());
  for (auto &[rank, buffer] : sent)
    MPI_Isend(buffer.data(), buffer.size(), MPI_BYTE, rank, tag, comm, &requests.emplace_back());
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}

template void Halo::rebuild(PointCloud<2> &, const double, const Period<2> &);
template void Halo::rebuild(PointCloud<3> &, const double, const Period<3> &);
} // namespace coracle::meshless
