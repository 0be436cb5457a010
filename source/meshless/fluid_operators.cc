// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/fluid_operators.h>

namespace coracle::meshless
{
template <int dim>
void
FluidOperators<dim>::lumped_volume(std::vector<double>       &result,
                                   const std::vector<double> &factor) const
{
  result.assign(halo.n_own() + halo.n_copies(), 0.);
  rules.for_each(tessellation,
                 factor,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double       *value,
                     const Vector *) {
                   for (unsigned int i = 0; i < n; ++i)
                     result[nodes[i]] += weight * value[i];
                 });
  halo.sum_to_owners(result);
}

template <int dim>
void
FluidOperators<dim>::gradient(const std::vector<double> &p, std::vector<Vector> &result) const
{
  result.assign(halo.n_own() + halo.n_copies(), Vector());
  rules.for_each(tessellation,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double       *value,
                     const Vector       *gradient) {
                   Vector slope;
                   for (unsigned int i = 0; i < n; ++i)
                     slope += p[nodes[i]] * gradient[i];
                   for (unsigned int i = 0; i < n; ++i)
                     result[nodes[i]] += (weight * value[i]) * slope;
                 });
  halo.sum_to_owners(result);
}

template <int dim>
void
FluidOperators<dim>::divergence(const std::vector<Vector> &u, std::vector<double> &result) const
{
  result.assign(halo.n_own() + halo.n_copies(), 0.);
  rules.for_each(tessellation,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double       *value,
                     const Vector       *gradient) {
                   Vector flow;
                   for (unsigned int i = 0; i < n; ++i)
                     flow += value[i] * u[nodes[i]];
                   for (unsigned int i = 0; i < n; ++i)
                     result[nodes[i]] += weight * (gradient[i] * flow);
                 });
  halo.sum_to_owners(result);
}

template <int dim>
void
FluidOperators<dim>::laplacian(const std::vector<Vector> &u, std::vector<Vector> &result) const
{
  result.assign(halo.n_own() + halo.n_copies(), Vector());
  rules.for_each(tessellation,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double *,
                     const Vector *gradient) {
                   dealii::Tensor<2, dim> slope;
                   for (unsigned int i = 0; i < n; ++i)
                     slope += outer_product(u[nodes[i]], gradient[i]);
                   for (unsigned int i = 0; i < n; ++i)
                     result[nodes[i]] += weight * (slope * gradient[i]);
                 });
  halo.sum_to_owners(result);
}

template <int dim>
void
FluidOperators<dim>::laplacian_diagonal(std::vector<double> &result) const
{
  result.assign(halo.n_own() + halo.n_copies(), 0.);
  rules.for_each(tessellation,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double *,
                     const Vector *gradient) {
                   for (unsigned int i = 0; i < n; ++i)
                     result[nodes[i]] += weight * gradient[i].norm_square();
                 });
  halo.sum_to_owners(result);
}

template <int dim>
void
FluidOperators<dim>::viscous_force(const std::vector<Vector> &u,
                                   const std::vector<double> &viscosity,
                                   std::vector<Vector>       &result) const
{
  result.assign(halo.n_own() + halo.n_copies(), Vector());
  rules.for_each(tessellation,
                 viscosity,
                 [&](const unsigned int *nodes,
                     const unsigned int  n,
                     const double        weight,
                     const double *,
                     const Vector *gradient) {
                   if (weight == 0)
                     return;
                   dealii::Tensor<2, dim> slope;
                   for (unsigned int i = 0; i < n; ++i)
                     slope += outer_product(u[nodes[i]], gradient[i]);
                   slope += transpose(slope);
                   for (unsigned int i = 0; i < n; ++i)
                     result[nodes[i]] += weight * (slope * gradient[i]);
                 });
  halo.sum_to_owners(result);
}

template class FluidOperators<2>;
template class FluidOperators<3>;
} // namespace coracle::meshless
