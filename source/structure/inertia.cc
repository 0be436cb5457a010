// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/quadrature_lib.h>

#include <coracle/base/exact_sum.h>
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

namespace
{
/// To volume, first moments, second moments about the origin.
template <int dim>
void
add_point(const dealii::Point<dim> &x, const double dv, std::vector<ExactSum> &sums)
{
  sums[0].add(dv);
  for (int i = 0; i < dim; ++i)
    {
      sums[1 + i].add(x[i] * dv);
      for (int j = 0; j < dim; ++j)
        sums[1 + dim + i * dim + j].add(x[i] * x[j] * dv);
    }
}

template <int dim>
VolumeIntegrals<dim>
total(std::vector<ExactSum> &exact, MPI_Comm comm)
{
  // The same on any number of ranks, because all of them keep the body's motion.
  ExactSum::sum(exact, comm);
  std::vector<double> sums;
  for (const ExactSum &sum : exact)
    sums.push_back(sum.value());
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
} // namespace

template <int dim>
VolumeIntegrals<dim>
volume_integrals(const StructureMesh<dim> &mesh)
{
  // x_i x_j det(dx/dxi) is of degree 4 in each coordinate. FEValues would take over what it knows
  // from the cell before where that is alike, and so depend on ranks in the last digit.
  const dealii::QGauss<dim> quadrature(3);
  std::vector<ExactSum>     sums(1 + dim + dim * dim);
  for (const auto &cell : mesh.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        {
          dealii::Point<dim>     x;
          dealii::Tensor<2, dim> jacobian;
          for (const unsigned int v : cell->vertex_indices())
            {
              x += mesh.fe.shape_value(v, quadrature.point(q)) * cell->vertex(v);
              jacobian += outer_product(static_cast<dealii::Tensor<1, dim>>(cell->vertex(v)),
                                        mesh.fe.shape_grad(v, quadrature.point(q)));
            }
          add_point(x, determinant(jacobian) * quadrature.weight(q), sums);
        }
  return total<dim>(sums, mesh.communicator());
}

template <int dim>
VolumeIntegrals<dim>
sheet_integrals(const BodyMesh<dim> &mesh)
{
  const dealii::QGauss<dim - 1> quadrature(3);
  std::vector<ExactSum>         sums(1 + dim + dim * dim);
  for (const auto &facet : mesh.facets)
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        const auto             p = quadrature.point(q);
        const auto             x = [&](const int k) { return mesh.nodes[facet.nodes[k]]; };
        dealii::Tensor<1, dim> place;
        double                 area;
        if constexpr (dim == 2)
          {
            place = (1 - p[0]) * x(0) + p[0] * x(1);
            area  = x(0).distance(x(1));
          }
        else
          {
            const auto bottom = (1 - p[0]) * x(0) + p[0] * x(1),
                       top    = (1 - p[0]) * x(3) + p[0] * x(2);
            place             = (1 - p[1]) * bottom + p[1] * top;
            const auto t_xi   = (1 - p[1]) * (x(1) - x(0)) + p[1] * (x(2) - x(3));
            area              = dealii::cross_product_3d(t_xi, top - bottom).norm();
          }
        add_point(dealii::Point<dim>(place), area * quadrature.weight(q), sums);
      }
  return total<dim>(sums, mesh.communicator());
}

template struct VolumeIntegrals<2>;
template struct VolumeIntegrals<3>;
template VolumeIntegrals<2> volume_integrals(const StructureMesh<2> &);
template VolumeIntegrals<3> volume_integrals(const StructureMesh<3> &);
template VolumeIntegrals<2> sheet_integrals(const BodyMesh<2> &);
template VolumeIntegrals<3> sheet_integrals(const BodyMesh<3> &);
} // namespace coracle
