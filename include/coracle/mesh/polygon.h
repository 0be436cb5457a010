// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <vector>

namespace coracle
{
/**
 * Quadrilaterals that fill a simple polygon. The boundary id of an edge is the
 * number of the vertex it starts from.
 *
 * A polygon whose corners all see its centroid is cut into one quadrilateral a
 * corner (corner, middles of the two edges, centroid), another one first into
 * triangles; each quadrilateral is then subdivided.
 *
 * @param corners      at least three, in either sense of rotation [m]
 * @param subdivisions one number n: every quadrilateral is cut n x n. For a
 *        triangle also three numbers a, b, c: the corners' quadrilaterals get
 *        a x b, a x c and c x b elements, ab + bc + ca together.
 * @param triangulation empty; becomes the mesh, unrefined
 *
 * Throws std::invalid_argument with a readable reason for a polygon that
 * crosses itself or has no area.
 */
void polygon_mesh(std::vector<dealii::Point<2>>    corners,
                  const std::vector<unsigned int> &subdivisions,
                  dealii::Triangulation<2>        &triangulation);
} // namespace coracle
