// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <coracle/base/text_scanner.h>

#include <array>
#include <string>
#include <vector>

namespace coracle
{
/// Points and elements of any kind, as a file has them.
struct MeshFile
{
  enum class Kind
  {
    line,
    triangle,
    quadrilateral,
    tetrahedron,
    hexahedron,
    other
  };

  struct Element
  {
    Kind kind;
    /// Around an element; of a hexahedron around the bottom, then around the top.
    std::array<unsigned int, 8> points;
    /// Boundary id, if it is a face.
    unsigned int id;
    /// Where it is in the file.
    std::size_t line;
  };

  std::string                   name;
  std::vector<dealii::Point<3>> points;
  std::vector<Element>          elements;

  /// Of a kind that is not `other`.
  static unsigned int n_points(const Kind kind);
  static unsigned int dimension(const Kind kind);

  /// "FILE, line N: reason"
  [[noreturn]] void fail(const Element &element, const std::string &reason) const;
};

/**
 * Read what the end of the file's name says: gmsh (.msh, versions 1, 2 and 4,
 * text), legacy VTK (.vtk, unstructured grid, text), Abaqus or UCD (.inp, .ucd).
 *
 * Ids of faces are physical groups (gmsh), the cell data `MaterialID` (VTK), the
 * digits in the name of a surface (Abaqus), the material (UCD); 0 where there are none.
 * deal.II has readers of all of these, but they trust what they read: a file
 * that is cut off or damaged makes them wait for ever, ask for all memory, or
 * read where nothing is. Here all indices that come back are those of points,
 * all coordinates are finite, and an element's points are not the same.
 *
 * Throws FileError.
 */
MeshFile read_mesh_file(const std::string &file_name);
} // namespace coracle
