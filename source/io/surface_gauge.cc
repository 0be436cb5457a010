// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/surface_gauge.h>

#include <cmath>
#include <limits>
#include <optional>

namespace coracle
{
namespace
{
using dealii::Point;

/// Places of a facet's nodes in the directions across the line, and along it.
template <int dim>
struct Projection
{
  std::array<std::array<double, dim - 1>, dim> across;
  std::array<double, dim>                      along;
};

/// Where an edge crosses the line; nodes on it count.
std::optional<double>
crossing(const Projection<2> &edge)
{
  const double a = edge.across[0][0], b = edge.across[1][0];
  if (a * b > 0)
    return {};
  return a == b ? std::max(edge.along[0], edge.along[1])
                : (edge.along[0] * b - edge.along[1] * a) / (b - a);
}

/// Where a triangle does; one that stands upright has no place of its own, its neighbours do.
std::optional<double>
crossing(const Projection<3> &triangle)
{
  std::array<double, 3> part;
  double                whole = 0, along = 0;
  for (unsigned int i = 0; i < 3; ++i)
    {
      const auto &a = triangle.across[(i + 1) % 3], &b = triangle.across[(i + 2) % 3];
      whole += part[i] = a[0] * b[1] - a[1] * b[0];
    }
  if (whole == 0)
    return {};
  for (unsigned int i = 0; i < 3; ++i)
    if (part[i] / whole < 0)
      return {};
    else
      along += part[i] / whole * triangle.along[i];
  return along;
}
} // namespace

template <int dim>
SurfaceGauge<dim>::SurfaceGauge(const ProbeDescription<dim> &description, MPI_Comm communicator)
  : description(description), comm(communicator)
{}

template <int dim>
void
SurfaceGauge<dim>::add_columns(const ProbeDescription<dim> &description, Statistics &statistics)
{
  statistics.add_column(description.prefix() + ".height", "m");
  statistics.add_column(description.prefix() + ".wet", "");
}

template <int dim>
void
SurfaceGauge<dim>::set_columns(const meshless::Fluid<dim> &fluid, Statistics &statistics) const
{
  unsigned int up   = dim - 1;
  const auto  &pull = fluid.options.gravity;
  for (unsigned int d = 0; d < dim; ++d)
    if (std::fabs(pull[d]) > std::fabs(pull[up]))
      up = d;
  // Gravity that acts upwards makes the lowest place the highest.
  const double sign    = pull[up] > 0 ? -1. : 1.;
  double       highest = -std::numeric_limits<double>::infinity();
  for (const auto &facet : fluid.mesh.boundary_facet)
    {
      // Beside a periodic face the facet may be there by its image.
      const Point<dim> &first = fluid.points.position[facet[0]];
      const auto        shift =
        fluid.period.nearest(first - description.position) - (first - description.position);
      Projection<dim> projection;
      for (unsigned int i = 0; i < dim; ++i)
        {
          const Point<dim> x  = fluid.points.position[facet[i]] + shift;
          projection.along[i] = sign * x[up];
          for (unsigned int d = 0, k = 0; d < dim; ++d)
            if (d != up)
              projection.across[i][k++] = x[d] - description.position[d];
        }
      if (const auto height = crossing(projection))
        highest = std::max(highest, *height);
    }
  highest          = mpi::max(highest, comm);
  const bool wet   = std::isfinite(highest);
  const auto ends  = fluid.options.box.get_boundary_points();
  const auto floor = sign > 0 ? ends.first[up] : ends.second[up];
  statistics.set(description.prefix() + ".height", wet ? sign * highest : floor);
  statistics.set(description.prefix() + ".wet", wet);
}

template class SurfaceGauge<2>;
template class SurfaceGauge<3>;
} // namespace coracle
