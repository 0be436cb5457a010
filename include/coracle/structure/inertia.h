// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <coracle/mesh/structure_mesh.h>

namespace coracle
{
/// Volume integrals of a mesh, for a sheet of one metre of its thickness; of one metre of depth in
/// 2-D, with what lies out of the plane zero.
template <int dim>
struct VolumeIntegrals
{
  /// [m^3]
  double volume = 0;
  /// [m]
  dealii::Point<dim> centre;
  /// Integral of x_i x_j about the centre [m^5].
  dealii::Tensor<2, 3> second_moment;

  /// Of unit density: tr(S) I - S [m^5]. In 2-D only entry (2, 2) has a meaning.
  dealii::Tensor<2, 3> inertia() const;
};

/// Exact for elements as they are, also warped ones. Collective.
template <int dim>
VolumeIntegrals<dim> volume_integrals(const StructureMesh<dim> &mesh);

/// Over the facets of a sheet; exact for flat ones. Collective.
template <int dim>
VolumeIntegrals<dim> sheet_integrals(const BodyMesh<dim> &mesh);
} // namespace coracle
