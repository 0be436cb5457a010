// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/field.h>
#include <coracle/io/output_directory.h>
#include <coracle/io/vtu_series.h>

#include <string>
#include <vector>

namespace coracle
{
/// A mesh as plain data, viewed where it lies: a structure body, a surface, the octree.
struct MeshView
{
  CellShape shape = CellShape::quadrilateral;
  /// Where nodes are drawn [m]: for a structure the current configuration. Entries are local nodes.
  Field position;
  /// The cells this rank writes (its own, no ghosts): local nodes of each, x fastest as in deal.II.
  const unsigned int *cells   = nullptr;
  std::size_t         n_cells = 0;
};

/// 2^dim vertices per cell.
template <int dim>
constexpr CellShape cell_shape = (dim == 1   ? CellShape::line
                                  : dim == 2 ? CellShape::quadrilateral
                                             : CellShape::hexahedron);

/**
 * A mesh over time as VTU, PVTU and PVD (see VtuSeries). Only nodes of the
 * given cells are written, so that node arrays may hold ghosts and anything
 * else behind.
 */
class MeshOutput
{
public:
  /// Claims `name` in the folder. Collective.
  MeshOutput(OutputDirectory   &directory,
             const std::string &name,
             const bool         single_precision = true);

  /**
   * Write this moment. Collective; the same fields in the same order on all ranks.
   *
   * @param time [s]
   * @param node_fields indexed by local nodes, as MeshView::position is
   * @param cell_fields indexed as MeshView::cells is
   */
  void write(const double              time,
             const MeshView           &mesh,
             const std::vector<Field> &node_fields,
             const std::vector<Field> &cell_fields);

  void serialize(Archive &archive) { series.serialize(archive); }

private:
  VtuSeries series;
};
} // namespace coracle
