// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/structure_surface.h>

#include <functional>

namespace coracle::meshless
{
/// A place for a point on the surface of a structure, and the outward normal there.
template <int dim>
struct SurfaceSeed
{
  dealii::Point<dim>     position;
  dealii::Tensor<1, dim> normal;
};

/**
 * Places about one spacing apart on the wet part of surfaces, none near an edge or corner, whose
 * nodes are points themselves. First those of the waterline, then those of lattices in the facets,
 * which are their nodes where facets are as large as the spacing. The same on all ranks.
 * @param is_wet the same on all ranks
 */
template <int dim>
std::vector<SurfaceSeed<dim>> seed(const StructureSurface<dim>                         &surface,
                                   const double                                         spacing,
                                   const std::function<bool(const SurfaceSeed<dim> &)> &is_wet);
} // namespace coracle::meshless
