// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/partition.h>

#include <zoltan_cpp.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

namespace coracle::meshless
{
namespace
{
/// What Zoltan asks for.
template <int dim>
struct Objects
{
  const PointCloud<dim>     &points;
  const std::vector<double> &weight;

  static const Objects &of(void *data) { return *static_cast<const Objects *>(data); }

  static int count(void *data, int *error)
  {
    *error = ZOLTAN_OK;
    return of(data).points.n_own;
  }

  static void list(void         *data,
                   int           n_global,
                   int           n_local,
                   ZOLTAN_ID_PTR global,
                   ZOLTAN_ID_PTR local,
                   int           n_weights,
                   float        *weights,
                   int          *error)
  {
    *error = ZOLTAN_OK;
    for (std::size_t i = 0; i < of(data).points.n_own; ++i)
      {
        // Zoltan's numbers are 32 bits wide: two for an id.
        const std::uint64_t id   = of(data).points.id[i];
        global[n_global * i]     = static_cast<ZOLTAN_ID_TYPE>(id);
        global[n_global * i + 1] = static_cast<ZOLTAN_ID_TYPE>(id >> 32);
        local[n_local * i]       = i;
        if (n_weights > 0)
          weights[i] = of(data).weight[i];
      }
  }

  static int dimension(void *, int *error)
  {
    *error = ZOLTAN_OK;
    return dim;
  }

  static void coordinates(void *data,
                          int,
                          int n_local,
                          int n,
                          ZOLTAN_ID_PTR,
                          ZOLTAN_ID_PTR local,
                          int,
                          double *x,
                          int    *error)
  {
    *error = ZOLTAN_OK;
    for (int i = 0; i < n; ++i)
      for (unsigned int d = 0; d < dim; ++d)
        x[dim * i + d] = of(data).points.position[local[n_local * i]][d];
  }
};

void
start_zoltan()
{
  float version;
  AssertThrow(Zoltan_Initialize(0, nullptr, &version) == ZOLTAN_OK,
              dealii::ExcMessage("Zoltan does not start"));
}

/// Place on the Z-curve through the smallest box around all own points.
template <int dim>
std::vector<std::uint64_t>
curve_of(const std::vector<dealii::Point<dim>> &position)
{
  constexpr unsigned int bits = 63 / dim;
  dealii::Point<dim>     low, high;
  for (unsigned int d = 0; d < dim; ++d)
    {
      low[d] = std::numeric_limits<double>::max(), high[d] = std::numeric_limits<double>::lowest();
      for (const auto &p : position)
        low[d] = std::min(low[d], p[d]), high[d] = std::max(high[d], p[d]);
    }
  double size = std::numeric_limits<double>::min();
  for (unsigned int d = 0; d < dim; ++d)
    size = std::max(size, high[d] - low[d]);

  std::vector<std::uint64_t> result;
  result.reserve(position.size());
  for (const auto &p : position)
    {
      std::uint64_t key = 0;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double scaled = (p[d] - low[d]) / size * ((std::uint64_t(1) << bits) - 1);
          for (std::uint64_t place = scaled, b = 0; b < bits; ++b)
            key |= (place >> b & 1) << (dim * b + d);
        }
      result.push_back(key);
    }
  return result;
}

/// Points, and rows of columns, as bytes.
template <int dim>
struct Row
{
  dealii::Point<dim> position;
  double             spacing;
  std::uint64_t      id;
  PointKind          kind;
};

template <int dim>
void
append(mpi::Buffer &buffer, const Row<dim> &row, const std::vector<double> &values)
{
  const std::size_t at = buffer.size(), n_bytes = values.size() * sizeof(double);
  buffer.resize(at + sizeof(row) + n_bytes);
  std::memcpy(&buffer[at], &row, sizeof(row));
  if (n_bytes > 0)
    std::memcpy(&buffer[at + sizeof(row)], values.data(), n_bytes);
}
} // namespace

template <int dim>
std::vector<unsigned int>
partition(const PointCloud<dim> &points, const std::vector<double> &weight, const MPI_Comm comm)
{
  AssertDimension(weight.size(), points.n_own);
  std::vector<unsigned int> result(points.n_own, mpi::rank(comm));
  if (mpi::n_ranks(comm) == 1)
    return result;

  static const bool started = (start_zoltan(), true);
  (void)started;
  Objects<dim> objects{points, weight};
  Zoltan       zoltan(comm);
  for (const auto &[name, value] : {std::pair{"DEBUG_LEVEL", "0"},
                                    {"LB_METHOD", "RCB"},
                                    {"NUM_GID_ENTRIES", "2"},
                                    {"NUM_LID_ENTRIES", "1"},
                                    {"OBJ_WEIGHT_DIM", "1"},
                                    {"RETURN_LISTS", "EXPORT"},
                                    {"IMBALANCE_TOL", "1.02"}})
    zoltan.Set_Param(name, value);
  zoltan.Set_Num_Obj_Fn(&Objects<dim>::count, &objects);
  zoltan.Set_Obj_List_Fn(&Objects<dim>::list, &objects);
  zoltan.Set_Num_Geom_Fn(&Objects<dim>::dimension, &objects);
  zoltan.Set_Geom_Multi_Fn(&Objects<dim>::coordinates, &objects);

  int           changes, n_global, n_local, n_import, n_export;
  ZOLTAN_ID_PTR import_global, import_local, export_global, export_local;
  int          *import_rank, *import_part, *export_rank, *export_part;
  const int     error = zoltan.LB_Partition(changes,
                                        n_global,
                                        n_local,
                                        n_import,
                                        import_global,
                                        import_local,
                                        import_rank,
                                        import_part,
                                        n_export,
                                        export_global,
                                        export_local,
                                        export_rank,
                                        export_part);
  AssertThrow(error == ZOLTAN_OK, dealii::ExcMessage("Zoltan has not found a partition"));
  for (int i = 0; i < n_export; ++i)
    result[export_local[i]] = export_rank[i];
  Zoltan::LB_Free_Part(&import_global, &import_local, &import_rank, &import_part);
  Zoltan::LB_Free_Part(&export_global, &export_local, &export_rank, &export_part);
  return result;
}

double
imbalance(const std::vector<double> &weight, const MPI_Comm comm)
{
  const double mine = std::accumulate(weight.begin(), weight.end(), 0.);
  const double all  = mpi::sum(mine, comm);
  return all > 0. ? mpi::max(mine, comm) * mpi::n_ranks(comm) / all : 1.;
}

template <int dim>
void
migrate(PointCloud<dim>                 &points,
        Columns                         &columns,
        const std::vector<unsigned int> &destination,
        const MPI_Comm                   comm)
{
  AssertDimension(destination.size(), points.n_own);
  std::map<unsigned int, mpi::Buffer> sent;
  std::vector<double>                 values(columns.n_columns());
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      columns.get_row(i, values.data());
      append(sent[destination[i]],
             Row<dim>{points.position[i], points.spacing[i], points.id[i], points.kind[i]},
             values);
    }

  std::vector<Row<dim>> rows;
  std::vector<double>   all_values;
  for (const auto &[rank, buffer] : mpi::exchange_buffers(sent, comm))
    for (auto from = buffer.begin(); from < buffer.end();)
      {
        std::memcpy(&rows.emplace_back(), &*from, sizeof(Row<dim>));
        from += sizeof(Row<dim>);
        if (!values.empty())
          std::memcpy(values.data(), &*from, values.size() * sizeof(double));
        from += values.size() * sizeof(double);
        all_values.insert(all_values.end(), values.begin(), values.end());
      }

  std::vector<dealii::Point<dim>> position;
  for (const auto &row : rows)
    position.push_back(row.position);
  const auto                curve = curve_of(position);
  std::vector<unsigned int> order(rows.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](const unsigned int a, const unsigned int b) {
    return std::pair(curve[a], rows[a].id) < std::pair(curve[b], rows[b].id);
  });

  points       = PointCloud<dim>();
  points.n_own = rows.size();
  columns.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const auto &row = rows[order[i]];
      points.position.push_back(row.position);
      points.spacing.push_back(row.spacing);
      points.id.push_back(row.id);
      points.kind.push_back(row.kind);
      columns.set_row(i, all_values.data() + order[i] * values.size());
    }
}

#define INSTANTIATE(dim)                                                        \
  template std::vector<unsigned int> partition(const PointCloud<dim> &,         \
                                               const std::vector<double> &,     \
                                               const MPI_Comm);                 \
  template void                      migrate(PointCloud<dim> &,                 \
                                             Columns &,                         \
                                             const std::vector<unsigned int> &, \
                                             const MPI_Comm);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace coracle::meshless
