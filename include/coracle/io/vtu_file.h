// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/io/field.h>

#include <string>
#include <utility>
#include <vector>

namespace coracle
{
/// What the points of a VTU file are joined to; vertices of each in deal.II's order (x fastest).
enum class CellShape
{
  vertex,
  line,
  triangle,
  quadrilateral,
  tetrahedron,
  hexahedron
};

/// One rank's share of an unstructured grid; viewed, not owned. Everything may be empty.
struct VtuPiece
{
  CellShape shape = CellShape::vertex;
  /// Points to write: `position` has n_points entries, or is indexed by `points` if that is set.
  std::size_t                      n_points = 0;
  const std::vector<unsigned int> *points   = nullptr;
  Field                            position;
  std::vector<Field>               point_fields;
  /// Cells as numbers of written points. Not needed for vertices: one per point.
  std::vector<unsigned int> connectivity;
  std::size_t               n_cells = 0;
  std::vector<Field>        cell_fields;
};

/**
 * The content of a .vtu file: VTK XML, version 1.0, one appended raw data
 * section with 64-bit headers, blocks compressed by zlib. An empty piece is a
 * valid file with no points and no cells.
 */
std::string vtu_text(const VtuPiece &piece, const bool single_precision);

/// The content of the .pvtu that joins these files; `piece` tells the names of the fields.
std::string pvtu_text(const VtuPiece                 &piece,
                      const std::vector<std::string> &files,
                      const bool                      single_precision);

/// The content of the .pvd that lists (time [s], file).
std::string pvd_text(const std::vector<std::pair<double, std::string>> &entries);
} // namespace coracle
