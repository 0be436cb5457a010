// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/cells.h>

namespace coracle::meshless
{
/**
 * Elements that merging has made but that have not all their facets in sight of
 * all their quadrature points fall apart into their cells again. (Circumcentres
 * of flat cells are less exact than the tolerance, so that of cells on one sphere
 * some may be merged and others not; what is left over may have a dent.)
 *
 * @param element as from merge_cells; whether an element falls apart depends on
 * its own cells alone.
 */
template <int dim>
void split_dented(const Cells<dim>          &cells,
                  const PointCloud<dim>     &points,
                  const TessellationOptions &options,
                  std::vector<unsigned int> &element);
} // namespace coracle::meshless
