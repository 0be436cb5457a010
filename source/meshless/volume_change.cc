// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/volume_change.h>

#include <algorithm>
#include <numeric>

namespace coracle::meshless
{
namespace
{
using dealii::Tensor;

/// A facet with nodes by rising id, and how often it is boundary after minus before; turned the
/// other way it counts negative.
template <int dim>
struct CountedFacet
{
  BoundaryFacet<dim> facet;
  int                count;

  bool operator<(const CountedFacet &other) const { return facet.id < other.facet.id; }
};

template <int dim>
CountedFacet<dim>
sorted(BoundaryFacet<dim> facet, int count)
{
  for (unsigned int end = dim - 1; end > 0; --end)
    for (unsigned int i = 0; i < end; ++i)
      if (facet.id[i] > facet.id[i + 1])
        {
          std::swap(facet.id[i], facet.id[i + 1]);
          std::swap(facet.position[i], facet.position[i + 1]);
          count = -count;
        }
  return {facet, count};
}

/// Equal facets are counted together, and those with a sum of zero go.
template <int dim>
void
cancel(std::vector<CountedFacet<dim>> &facets)
{
  std::sort(facets.begin(), facets.end());
  std::size_t n = 0;
  for (std::size_t i = 0; i < facets.size();)
    {
      CountedFacet<dim> sum = facets[i];
      for (++i; i < facets.size() && facets[i].facet.id == sum.facet.id; ++i)
        sum.count += facets[i].count;
      if (sum.count != 0)
        facets[n++] = sum;
    }
  facets.resize(n);
}

/// Facets from all ranks, each with those of the same points.
template <int dim>
std::vector<CountedFacet<dim>>
gather(const std::map<unsigned int, std::vector<CountedFacet<dim>>> &sent, const MPI_Comm comm)
{
  std::vector<CountedFacet<dim>> result;
  for (const auto &[rank, facets] : mpi::exchange_values(sent, comm))
    result.insert(result.end(), facets.begin(), facets.end());
  cancel(result);
  return result;
}

/// Volume of the cone from a point to the facet, positive where the facet looks away from it.
double
cone(const std::array<Tensor<1, 2>, 2> &x)
{
  return x[0] * cross_product_2d(x[1]) / 2.;
}

double
cone(const std::array<Tensor<1, 3>, 3> &x)
{
  return x[0] * cross_product_3d(x[1], x[2]) / 6.;
}

template <int dim>
double
cone(const BoundaryFacet<dim> &facet, const dealii::Point<dim> &apex, const Period<dim> &period)
{
  std::array<Tensor<1, dim>, dim> x;
  for (unsigned int i = 0; i < dim; ++i)
    x[i] = period.nearest(facet.position[i] - apex);
  return cone(x);
}

/// Number facets so that those of one closed surface have the same number.
template <int dim>
std::vector<unsigned int>
surfaces(const std::vector<CountedFacet<dim>> &facets)
{
  std::vector<unsigned int> parent(facets.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](unsigned int i) {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  // What two facets share: all but one of their points.
  using Ridge = std::array<std::uint64_t, dim - 1>;
  std::vector<std::pair<Ridge, unsigned int>> ridges;
  for (unsigned int f = 0; f < facets.size(); ++f)
    for (unsigned int without = 0; without < dim; ++without)
      {
        Ridge ridge;
        for (unsigned int k = 0, r = 0; k < dim; ++k)
          if (k != without)
            ridge[r++] = facets[f].facet.id[k];
        ridges.emplace_back(ridge, f);
      }
  std::sort(ridges.begin(), ridges.end());
  for (std::size_t i = 1; i < ridges.size(); ++i)
    if (ridges[i].first == ridges[i - 1].first)
      parent[std::max(find(ridges[i].second), find(ridges[i - 1].second))] =
        std::min(find(ridges[i].second), find(ridges[i - 1].second));
  for (unsigned int f = 0; f < facets.size(); ++f)
    parent[f] = find(f);
  return parent;
}

template <int dim>
VolumeChange
measure(const std::vector<CountedFacet<dim>> &facets, const Period<dim> &period)
{
  const auto          surface = surfaces(facets);
  std::vector<double> volume(facets.size(), 0.);
  for (unsigned int f = 0; f < facets.size(); ++f)
    volume[surface[f]] +=
      facets[f].count * cone(facets[f].facet, facets[surface[f]].facet.position[0], period);
  VolumeChange result;
  for (const double v : volume)
    (v > 0. ? result.appeared : result.disappeared) += std::abs(v);
  return result;
}
} // namespace

template <int dim>
std::vector<BoundaryFacet<dim>>
boundary_of(const PointCloud<dim> &points, const Tessellation<dim> &tessellation)
{
  std::vector<BoundaryFacet<dim>> result(tessellation.boundary_facet.size());
  for (std::size_t f = 0; f < result.size(); ++f)
    for (unsigned int i = 0; i < dim; ++i)
      {
        result[f].id[i]       = points.id[tessellation.boundary_facet[f][i]];
        result[f].position[i] = points.position[tessellation.boundary_facet[f][i]];
      }
  return result;
}

template <int dim>
VolumeChange
volume_change(const std::vector<BoundaryFacet<dim>> &before,
              const std::vector<BoundaryFacet<dim>> &after,
              const MPI_Comm                         comm,
              const Period<dim>                     &period)
{
  // What has not changed here has not changed.
  std::vector<CountedFacet<dim>> changed;
  for (const auto &facet : before)
    changed.push_back(sorted(facet, -1));
  for (const auto &facet : after)
    changed.push_back(sorted(facet, 1));
  cancel(changed);

  // Of the rest the other half may be on another rank.
  std::map<unsigned int, std::vector<CountedFacet<dim>>> sent;
  for (const auto &facet : changed)
    sent[facet.facet.id[0] % mpi::n_ranks(comm)].push_back(facet);
  changed = gather(sent, comm);
  sent.clear();
  if (!changed.empty())
    sent[0] = changed;
  const VolumeChange sum = measure(gather(sent, comm), period);
  return {mpi::sum(sum.appeared, comm), mpi::sum(sum.disappeared, comm)};
}

#define INSTANTIATE(dim)                                                                          \
  template std::vector<BoundaryFacet<dim>> boundary_of(const PointCloud<dim> &,                   \
                                                       const Tessellation<dim> &);                \
  template VolumeChange                    volume_change(const std::vector<BoundaryFacet<dim>> &, \
                                                         const std::vector<BoundaryFacet<dim>> &, \
                                                         const MPI_Comm,                          \
                                                         const Period<dim> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace coracle::meshless
