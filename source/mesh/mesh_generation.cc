// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <coracle/mesh/mesh_from_file.h>
#include <coracle/mesh/mesh_generation.h>
#include <coracle/mesh/polygon.h>

#include <cmath>

namespace coracle
{
namespace
{
std::vector<unsigned int>
counts(const Parameters &section, const std::string &entry)
{
  std::vector<unsigned int> result;
  for (const double x : section.list(entry))
    {
      if (x < 1 || x != std::floor(x))
        throw section.error(entry,
                            "wrong number of elements",
                            std::to_string(x),
                            "give whole numbers from 1");
      result.push_back(x);
    }
  if (result.empty())
    throw section.error(entry, "no number of elements", "an empty list", "give one number or more");
  return result;
}

template <int dim>
dealii::Point<dim>
corner(const Parameters &section, const std::string &entry)
{
  const std::vector<double> x = section.list(entry);
  // The defaults have three entries, for both dimensions.
  if (x.size() != dim && (x.size() != 3 || section.is_set(entry)))
    throw section.error(entry,
                        "wrong number of coordinates",
                        std::to_string(x.size()) + " of them",
                        "give " + std::to_string(dim));
  dealii::Point<dim> result;
  std::copy_n(x.begin(), dim, result.begin_raw());
  return result;
}

template <int dim>
void
box(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  std::vector<unsigned int> n = counts(section, "Subdivisions");
  if (n.size() == 1)
    n.resize(dim, n[0]);
  if (n.size() != dim)
    throw section.error("Subdivisions",
                        "wrong number of subdivisions",
                        std::to_string(n.size()) + " numbers",
                        "give one, or " + std::to_string(dim));
  const auto lower = corner<dim>(section, "Lower corner"),
             upper = corner<dim>(section, "Upper corner");
  for (int d = 0; d < dim; ++d)
    if (upper[d] <= lower[d])
      throw section.error("Upper corner",
                          "empty box",
                          "an upper corner that is not above the lower one",
                          "make every coordinate of the upper corner the larger one");
  dealii::GridGenerator::subdivided_hyper_rectangle(triangulation, n, lower, upper, true);
}

template <int dim>
void
extruded_polygon(const Parameters                    &section,
                 const std::vector<dealii::Point<2>> &corners,
                 dealii::Triangulation<dim>          &triangulation)
{
  dealii::Triangulation<2> plane;
  try
    {
      polygon_mesh(corners, counts(section, "Subdivisions"), plane);
    }
  catch (const std::invalid_argument &reason)
    {
      throw section.error("Subdivisions",
                          "polygon that cannot be meshed",
                          reason.what(),
                          "change the polygon");
    }
  if constexpr (dim == 2)
    triangulation.copy_triangulation(plane);
  else
    dealii::GridGenerator::extrude_triangulation(plane,
                                                 section.integer("Subdivisions along z") + 1,
                                                 section.quantity("Length"),
                                                 triangulation);
}

template <int dim>
void
wedge(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  const double half = section.quantity("Breadth") / 2, angle = section.quantity("Deadrise angle");
  if (!(angle > 0 && angle < dealii::numbers::PI_2))
    throw section.error("Deadrise angle",
                        "no wedge",
                        std::to_string(angle) + " rad",
                        "give an angle between 0 and 90 deg");
  const double height = half * std::tan(angle);
  extruded_polygon<dim>(section, {{0, 0}, {half, height}, {-half, height}}, triangulation);
}

template <int dim>
void
polygon(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  const std::vector<double> x = section.list("Corners");
  if (x.size() % 2 == 1)
    throw section.error("Corners",
                        "odd number of coordinates",
                        std::to_string(x.size()) + " numbers",
                        "give x and y of each corner");
  std::vector<dealii::Point<2>> corners;
  for (std::size_t i = 0; i < x.size(); i += 2)
    corners.emplace_back(x[i], x[i + 1]);
  extruded_polygon<dim>(section, corners, triangulation);
}

template <int dim>
void
plate_with_hole(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  const double hole = section.quantity("Hole radius"), half = section.quantity("Half width");
  if (!(0 < hole && hole < half))
    throw section.error("Hole radius",
                        "hole that does not fit the plate",
                        std::to_string(hole) + " m",
                        "give a radius between 0 and the half width");
  dealii::GridGenerator::plate_with_a_hole(triangulation,
                                           hole,
                                           half,
                                           0.,
                                           0.,
                                           0.,
                                           0.,
                                           dealii::Point<dim>(),
                                           0,
                                           1,
                                           section.quantity("Thickness"),
                                           section.integer("Subdivisions along z") + 1,
                                           true);

  // Only the hole is kept round: deal.II's transfinite interpolation cannot follow a copied mesh.
  const dealii::types::boundary_id hole_id = 4;
  triangulation.reset_all_manifolds();
  triangulation.set_all_manifold_ids(dealii::numbers::flat_manifold_id);
  for (const auto &face : triangulation.active_face_iterators())
    if (face->at_boundary() && face->boundary_id() == hole_id)
      face->set_all_manifold_ids(0);
  if constexpr (dim == 2)
    triangulation.set_manifold(0, dealii::SphericalManifold<2>());
  else
    triangulation.set_manifold(0, dealii::CylindricalManifold<3>(2));
}

template <int dim>
void
cylinder(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  if constexpr (dim == 3)
    dealii::GridGenerator::subdivided_cylinder(triangulation,
                                               section.integer("Subdivisions along axis"),
                                               section.quantity("Radius"),
                                               section.quantity("Length") / 2);
  else
    throw section.error("Type",
                        "no such mesh in 2-D",
                        "a cylinder",
                        "use `ball` for a disc, or `box` for a section along the axis");
}

template <int dim>
void
read_file(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  try
    {
      make_triangulation(read_mesh_file(section.file("File")), triangulation);
    }
  catch (const FileError &error)
    {
      throw section.error(
        "File",
        "mesh file that cannot be used",
        error.what(),
        "give a gmsh (.msh), Abaqus (.inp) or legacy VTK (.vtk) file, as text, with "
        "a mesh of quadrilaterals (2-D) or hexahedra (3-D) of first order and "
        "nothing else of that dimension");
    }
}
} // namespace

template <int dim>
void
generate_mesh(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  const std::string type = section.choice("Type");
  if (type == "box")
    box(section, triangulation);
  else if (type == "ball")
    dealii::GridGenerator::hyper_ball(triangulation,
                                      dealii::Point<dim>(),
                                      section.quantity("Radius"));
  else if (type == "cylinder")
    cylinder(section, triangulation);
  else if (type == "plate with hole")
    plate_with_hole(section, triangulation);
  else if (type == "wedge")
    wedge(section, triangulation);
  else if (type == "polygon")
    polygon(section, triangulation);
  else
    read_file(section, triangulation);
}

template <int dim>
void
place_mesh(const Parameters &section, dealii::Triangulation<dim> &triangulation)
{
  dealii::GridTools::scale(section.quantity("Scale"), triangulation);
  const double angle = section.quantity("Rotation angle");
  if (angle != 0)
    {
      if constexpr (dim == 2)
        dealii::GridTools::rotate(angle, triangulation);
      else
        {
          const dealii::Tensor<1, 3> axis = section.template point<3>("Rotation axis");
          if (axis.norm() == 0)
            throw section.error("Rotation axis", "no axis", "0, 0, 0", "give a direction");
          dealii::GridTools::rotate(axis / axis.norm(), angle, triangulation);
        }
    }
  dealii::GridTools::shift(section.template point<dim>("Position"), triangulation);
}

template void generate_mesh(const Parameters &, dealii::Triangulation<2> &);
template void generate_mesh(const Parameters &, dealii::Triangulation<3> &);
template void place_mesh(const Parameters &, dealii::Triangulation<2> &);
template void place_mesh(const Parameters &, dealii::Triangulation<3> &);
} // namespace coracle
