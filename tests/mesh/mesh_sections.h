// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/mesh/structure_mesh.h>

#include "tests.h"

/// A mesh from the lines of a section `Mesh`.
template <int dim>
std::unique_ptr<coracle::StructureMesh<dim>>
mesh_from(const std::string &lines)
{
  coracle::Declaration declaration;
  coracle::StructureMesh<dim>::declare(declaration.section("Mesh", "a mesh"));
  coracle::ParameterFile file(declaration);
  file.read_text("subsection Mesh\n" + lines + "\nend\n");
  return std::make_unique<coracle::StructureMesh<dim>>(file.parameters().section("Mesh"),
                                                       MPI_COMM_WORLD);
}

/// Of a facet's corners: the area vector, and a third (half) of its flux of x.
template <int dim>
struct FacetSums
{
  dealii::Tensor<1, dim> area;
  double                 volume = 0;
};

/// Sums over the facets of all ranks: zero area and the enclosed volume, if all point outwards.
template <int dim>
FacetSums<dim>
facet_sums(const coracle::StructureMesh<dim> &mesh)
{
  FacetSums<dim> sums;
  const auto     add = [&](const dealii::Tensor<1, dim> &area, const dealii::Tensor<1, dim> &x) {
    sums.area += area;
    sums.volume += area * x / dim;
  };
  for (const auto &facet : mesh.facets)
    {
      const auto node = [&](const int n) {
        return dealii::Tensor<1, dim>(mesh.nodes[facet.nodes[n]]);
      };
      if constexpr (dim == 2)
        {
          const auto             edge = node(1) - node(0);
          dealii::Tensor<1, dim> area;
          area[0] = edge[1];
          area[1] = -edge[0];
          add(area, 0.5 * (node(0) + node(1)));
        }
      else
        // Four triangles about the middle: the enclosed volume of a bilinear facet, exactly.
        {
          const auto middle = 0.25 * (node(0) + node(1) + node(2) + node(3));
          for (int n = 0; n < 4; ++n)
            {
              const auto a = node(n), b = node((n + 1) % 4);
              add(0.5 * dealii::cross_product_3d(a - middle, b - middle), (a + b + middle) / 3.);
            }
        }
    }
  sums.area   = dealii::Utilities::MPI::sum(sums.area, mesh.communicator());
  sums.volume = dealii::Utilities::MPI::sum(sums.volume, mesh.communicator());
  return sums;
}
