// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/mesh/mesh_generation.h>
#include <coracle/mesh/sheet_generation.h>

namespace coracle
{
namespace
{
void
declare_simple_shapes(Declaration &section)
{
  Declaration &box = section.when("Type", "box");
  box.list("Lower corner", "0, 0, 0", "m", "", "smallest coordinates");
  box.list("Upper corner", "1, 1, 1", "m", "", "largest coordinates");
  box.list("Subdivisions",
           "1",
           "1",
           "",
           "elements along each axis, or one number for all. Boundary ids: 0 and 1 at the ends "
           "in x, 2 and 3 in y, 4 and 5 in z");

  Declaration &ball = section.when("Type", "ball");
  ball.quantity("Radius", "1", "m", "", "of the ball, or of the disc in 2-D, about the origin", 0.);

  Declaration &cylinder = section.when("Type", "cylinder");
  cylinder.quantity("Radius", "1", "m", "", "of the cylinder along x, in 3-D only", 0.);
  cylinder.quantity("Length", "1", "m", "", "from x = -Length/2 to Length/2", 0.);
  cylinder.integer("Subdivisions along axis",
                   1,
                   "elements along x before refinement. Boundary ids: 0 round, 1 and 2 the ends",
                   1);
}

void
declare_plate_and_wedge(Declaration &section)
{
  Declaration &plate = section.when("Type", "plate with hole");
  plate.quantity("Hole radius", "0.25", "m", "", "about the origin", 0.);
  plate.quantity("Half width", "1", "m", "", "half the side of the square plate", 0.);
  plate.quantity("Thickness", "0.1", "m", "", "in z, 3-D only", 0.);
  plate.integer("Subdivisions along z",
                1,
                "elements through the thickness before refinement, 3-D only. Boundary ids: 0 to 3 "
                "the outer sides, 4 the hole, 5 and 6 the faces in z",
                1);

  Declaration &wedge = section.when("Type", "wedge");
  wedge.quantity(
    "Breadth", "0.5", "m", "B", "width of the top; the tip points down, at the origin", 0.);
  wedge.quantity(
    "Deadrise angle", "30 deg", "rad", "beta", "between the sides and the horizontal", 0.);
  wedge.list("Subdivisions",
             "5, 9, 9",
             "1",
             "",
             "n gives 3 n^2 elements in the section; a, b, c give ab + bc + ca (5, 9, 9: 171). "
             "Boundary ids: 0 right side, 1 top, 2 left side, in 3-D 3 and 4 the ends in z");
  wedge.quantity("Length", "1", "m", "", "along z, from 0, 3-D only", 0.);
  wedge.integer("Subdivisions along z", 1, "elements along z, 3-D only", 1);
}

void
declare_polygon_and_file(Declaration &section)
{
  Declaration &polygon = section.when("Type", "polygon");
  polygon.list("Corners", "0, 0, 1, 0, 0, 1", "m", "", "x1, y1, x2, y2, ... of the section");
  polygon.list("Subdivisions",
               "1",
               "1",
               "",
               "each corner's quadrilateral becomes n x n elements; a triangle may have three "
               "numbers. Boundary ids: number of the corner an edge starts from; in 3-D the ends "
               "in z follow");
  polygon.quantity("Length", "1", "m", "", "along z, from 0, 3-D only", 0.);
  polygon.integer("Subdivisions along z", 1, "elements along z, 3-D only", 1);

  section.when("Type", "file")
    .file("File",
          "mesh of quadrilaterals or hexahedra: gmsh (.msh), Abaqus "
          "(.inp) or legacy VTK (.vtk); boundary ids as the file has them");
}
} // namespace

void
declare_mesh(Declaration &section, const bool with_sheets)
{
  std::vector<std::string> types = {
    "box", "ball", "cylinder", "plate with hole", "wedge", "polygon", "file"};
  if (with_sheets)
    types.insert(types.end(), sheet_types.begin(), sheet_types.end());
  section.choice("Type",
                 "box",
                 types,
                 std::string("shape that is meshed, or `file`; polygons and wedges are extruded in "
                             "3-D") +
                   (with_sheets ? "; a polyline (extruded in 3-D) and a surface file are thin "
                                  "sheets without volume, with particles on both sides"
                                : ""));
  declare_simple_shapes(section);
  declare_plate_and_wedge(section);
  declare_polygon_and_file(section);
  if (with_sheets)
    declare_sheets(section);
  section.integer("Refinements", 0, "every element is halved this many times", 0, 10);
  section.list("Refined region",
               "",
               "m",
               "",
               "elements whose centre is in this box (lower corner, upper corner) as placed are "
               "halved once more, with hanging nodes around it");
  section.quantity("Scale", "1", "1", "", "the mesh is multiplied by this first", 1e-300);
  section.quantity("Rotation angle", "0 deg", "rad", "", "then turned about the origin");
  section.list("Rotation axis", "0, 0, 1", "1", "", "of the turn, 3-D only");
  section.list("Position", "", "m", "", "then moved by this");
}
} // namespace coracle
