// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <coracle/structure/inertia.h>

#include <vector>

namespace coracle
{
template <int dim>
dealii::Tensor<2, 3>
VolumeIntegrals<dim>::inertia() const
{
  dealii::Tensor<2, 3> result;
  for (int i = 0; i < 3; ++i)
    result[i][i] = dealii::trace(second_moment);
  return result - second_moment;
}

template <int dim>
VolumeIntegrals<dim>
volume_integrals(const StructureMesh<dim> &mesh)
{
  // x_i x_j det(dx/dxi) is of degree 4 in each coordinate.
  dealii::FEValues<dim> values(mesh.fe,
                               dealii::QGauss<dim>(3),
                               dealii::update_quadrature_points | dealii::update_JxW_values);
  // Volume, first moments, second moments about the origin.
  std::vector<double> sums(1 + dim + dim * dim);
  for (const auto &cell : mesh.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const dealii::Point<dim> &x  = values.quadrature_point(q);
            const double              dv = values.JxW(q);
            sums[0] += dv;
            for (int i = 0; i < dim; ++i)
              {
                sums[1 + i] += x[i] * dv;
                for (int j = 0; j < dim; ++j)
                  sums[1 + dim + i * dim + j] += x[i] * x[j] * dv;
              }
          }
      }
  dealii::Utilities::MPI::sum(sums, mesh.communicator(), sums);

  VolumeIntegrals<dim> result;
  result.volume = sums[0];
  for (int i = 0; i < dim; ++i)
    result.centre[i] = sums[1 + i] / sums[0];
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      result.second_moment[i][j] =
        sums[1 + dim + i * dim + j] - sums[0] * result.centre[i] * result.centre[j];
  return result;
}

template struct VolumeIntegrals<2>;
template struct VolumeIntegrals<3>;
template VolumeIntegrals<2> volume_integrals(const StructureMesh<2> &);
template VolumeIntegrals<3> volume_integrals(const StructureMesh<3> &);
} // namespace coracle
