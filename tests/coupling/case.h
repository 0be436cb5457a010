// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/exceptions.h>
#include <coracle/base/mpi.h>
#include <coracle/coupling/coupling.h>

#include <cstring>

#include "tests.h"

/// What the tests of the coupling share: a case from its text, and sums over its particles.
namespace coracle
{
template <int dim>
std::unique_ptr<Coupling<dim>>
make_coupling(const std::string &text, MPI_Comm comm = MPI_COMM_WORLD)
{
  Declaration declaration;
  Coupling<dim>::declare(declaration);
  ParameterFile file(declaration);
  file.read_text(text);
  return std::make_unique<Coupling<dim>>(file.parameters(), comm);
}

/// Of two states, as bits.
inline bool
same(const double a, const double b)
{
  return std::memcmp(&a, &b, sizeof(double)) == 0;
}

/// Mass, mass times position, momentum of the first body of material points, on all ranks.
template <int dim>
struct Totals
{
  explicit Totals(const MaterialPoints<dim> &points)
  {
    using Layout = ParticleLayout<dim>;
    for (std::size_t row = 0; row < points.n_rows(); ++row)
      if (!points.is_hole(row))
        {
          const double m = points.column(Layout::mass)[row];
          mass += m;
          for (int d = 0; d < dim; ++d)
            {
              centre[d] += m * points.column(Layout::position + d)[row];
              momentum[d] += m * points.column(Layout::velocity + d)[row];
            }
        }
    mass     = mpi::sum(mass, MPI_COMM_WORLD);
    centre   = mpi::sum(centre, MPI_COMM_WORLD) / mass;
    momentum = mpi::sum(momentum, MPI_COMM_WORLD);
  }

  double                 mass = 0;
  dealii::Tensor<1, dim> centre, momentum;
};

/// Kinetic + internal + what was lost - what was brought [J]: constant but for the error of the
/// step.
template <int dim>
double
energy_balance(const Coupling<dim> &coupling)
{
  const auto &e = coupling.points.books();
  return mpi::sum(e.kinetic + e.internal + e.damping + e.transfer + e.boundary - e.contact -
                    e.external_work,
                  MPI_COMM_WORLD);
}
} // namespace coracle
