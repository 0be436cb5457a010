// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/rotation_columns.h>

namespace coracle
{
namespace
{
/// The inertia's smallest moment over its largest below which it cannot be inverted.
constexpr double flat = 1e-12;

template <int dim>
dealii::Tensor<1, 3>
in_space(const std::array<double, dim> &value)
{
  dealii::Tensor<1, 3> result;
  for (int d = 0; d < dim; ++d)
    result[d] = value[d];
  return result;
}
} // namespace

template <int dim>
Rotation
rotation_of(const MaterialPoints<dim>    &points,
            const dealii::Point<dim>     &centre,
            const dealii::Tensor<1, dim> &velocity,
            const MPI_Comm                comm)
{
  using Layout = ParticleLayout<dim>;
  // Angular momentum, then the inertia row by row; holes have no mass.
  RankSums rank_sums(12, points.reproducible);
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    {
      const double            m = points.column(Layout::mass)[row];
      std::array<double, dim> arm, speed;
      for (int d = 0; d < dim; ++d)
        {
          arm[d]   = points.column(Layout::position + d)[row] - centre[d];
          speed[d] = points.column(Layout::velocity + d)[row] - velocity[d];
        }
      const auto r = in_space<dim>(arm), l = cross_product_3d(r, in_space<dim>(speed));
      for (int i = 0; i < 3; ++i)
        {
          rank_sums.add(i, m * l[i]);
          for (int j = 0; j < 3; ++j)
            rank_sums.add(3 + 3 * i + j, m * ((i == j ? r.norm_square() : 0.) - r[i] * r[j]));
        }
    }
  const auto           sums = rank_sums.total(comm);
  Rotation             result;
  dealii::Tensor<2, 3> inertia;
  for (int i = 0; i < 3; ++i)
    {
      result.angular_momentum[i] = sums[i];
      for (int j = 0; j < 3; ++j)
        inertia[i][j] = sums[3 + 3 * i + j];
    }
  if constexpr (dim == 2)
    {
      if (inertia[2][2] > 0)
        result.angular_velocity[2] = result.angular_momentum[2] / inertia[2][2];
    }
  else if (determinant(inertia) > flat * std::pow(trace(inertia), 3))
    result.angular_velocity = invert(inertia) * result.angular_momentum;
  return result;
}

template <int dim>
void
add_rotation_columns(Statistics &statistics, const std::string &body)
{
  const auto add = [&statistics](const std::string &name, const std::string &unit) {
    if (dim == 2)
      statistics.add_column(name + ".z", unit);
    else
      statistics.add_vector(name, unit, 3);
  };
  add(body + ".angular_momentum", "kg m^2/s");
  add(body + ".angular_velocity", "rad/s");
}

template <int dim>
void
set_rotation_columns(Statistics &statistics, const std::string &body, const Rotation &rotation)
{
  const auto set = [&statistics](const std::string &name, const dealii::Tensor<1, 3> &value) {
    if (dim == 2)
      statistics.set(name + ".z", value[2]);
    else
      statistics.set_vector(name, value, 3);
  };
  set(body + ".angular_momentum", rotation.angular_momentum);
  set(body + ".angular_velocity", rotation.angular_velocity);
}

template Rotation rotation_of(const MaterialPoints<2> &,
                              const dealii::Point<2> &,
                              const dealii::Tensor<1, 2> &,
                              const MPI_Comm);
template Rotation rotation_of(const MaterialPoints<3> &,
                              const dealii::Point<3> &,
                              const dealii::Tensor<1, 3> &,
                              const MPI_Comm);
template void     add_rotation_columns<2>(Statistics &, const std::string &);
template void     add_rotation_columns<3>(Statistics &, const std::string &);
template void     set_rotation_columns<2>(Statistics &, const std::string &, const Rotation &);
template void     set_rotation_columns<3>(Statistics &, const std::string &, const Rotation &);
} // namespace coracle
