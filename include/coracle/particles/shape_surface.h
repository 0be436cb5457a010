// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/shape.h>

#include <array>
#include <string>
#include <vector>

namespace coracle
{
/// A surface as loose facets: segments in 2-D, triangles in 3-D.
template <int dim>
using FacetSoup = std::vector<std::array<dealii::Point<dim>, dim>>;

/**
 * Inside of a closed surface of segments (2-D) or triangles (3-D).
 *
 * A point is inside if the line from it towards larger y (2-D) or z (3-D)
 * crosses the surface an odd number of times; the facets' orientation does not
 * matter. The line passes a facet if an odd number of the facet's projected
 * edges (2-D: vertices) lie to one side of it, decided once per edge for all
 * facets that share it: on a closed surface no line slips through between two
 * facets or is counted twice, however it hits edges and vertices.
 */
template <int dim>
class SurfaceShape : public Shape<dim>
{
public:
  static void declare(Declaration &entries);
  explicit SurfaceShape(const Parameters &body);
  explicit SurfaceShape(const FacetSoup<dim> &facets);

  bool                     contains(const dealii::Point<dim> &point) const override;
  dealii::BoundingBox<dim> bounding_box() const override;
  /// Known if all facets agree on which side is outside.
  std::optional<double> volume() const override;

  /// Edges (2-D: vertices) where the surface is open; empty for a closed one.
  static std::vector<dealii::Point<dim>> open_edges(const FacetSoup<dim> &facets);

private:
  /// Column of facets, over a raster of the plane below, that a line in this place may cross.
  unsigned int raster_column(const dealii::Point<dim> &point) const;
  void         fill_raster();

  FacetSoup<dim>                         facets;
  dealii::BoundingBox<dim>               box;
  std::array<unsigned int, dim - 1>      n_columns;
  std::vector<std::vector<unsigned int>> raster;
};

/**
 * Read the facets of a surface file: STL (text or binary; 3-D), or a mesh of lines in 2-D and of
 * quadrilaterals or triangles in 3-D (see base/mesh_file.h). Throws FileError.
 */
template <int dim>
FacetSoup<dim> read_facets(const std::string &file_name);
} // namespace coracle
