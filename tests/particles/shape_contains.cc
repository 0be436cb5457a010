// SPDX-License-Identifier: GPL-3.0-or-later
// Box, ball, polygon, indicator and closed surfaces agree on what is inside: exact counts of
// lattice points, volumes, and lines that run exactly through vertices and edges.
#include <coracle/particles/generate.h>
#include <coracle/particles/shape_ball.h>
#include <coracle/particles/shape_box.h>
#include <coracle/particles/shape_indicator.h>
#include <coracle/particles/shape_polygon.h>
#include <coracle/particles/shape_surface.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_out.h>
#include <deal.II/grid/tria.h>

#include "../tests.h"

using namespace coracle;
using dealii::Point;

/// Lattice points over the box that are inside, n in each direction, moved by `shift` cells.
template <int dim>
unsigned int
count(const Shape<dim>               &shape,
      const dealii::BoundingBox<dim> &box,
      const unsigned int              n,
      const double                    shift = 0)
{
  unsigned int inside = 0;
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int k = 0; k < (dim == 3 ? n : 1); ++k)
        {
          const unsigned int index[] = {i, j, k};
          Point<dim>         p       = box.get_boundary_points().first;
          for (int d = 0; d < dim; ++d)
            p[d] += box.side_length(d) * (index[d] + 0.5 + shift) / n;
          inside += shape.contains(p);
        }
  return inside;
}

void
polygons()
{
  const dealii::BoundingBox<2> box({Point<2>(0, 0), Point<2>(4, 4)});
  // A U, of 4 x 4 less 2 x 3; its corners lie on lattice lines when the lattice is shifted by half
  // a cell.
  const std::vector<Point<2>> u = {{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}};
  const PolygonShape<2>       shape(u);
  deallog << "U: area " << *shape.volume() << ", of 16 x 16 points " << count(shape, box, 16)
          << ", with points on corners and edges " << count(shape, box, 16, 0.5) << std::endl;

  // The diagonal through lattice points: two triangles share out the square without gap or overlap.
  const PolygonShape<2> below({{0, 0}, {4, 0}, {4, 4}}), above({{0, 0}, {4, 4}, {0, 4}});
  deallog << "two halves of a square: " << count(below, box, 16) + count(above, box, 16) << ' '
          << count(below, box, 16, 0.5) + count(above, box, 16, 0.5) << std::endl;

  const PolygonShape<3> prism(u, {1., 3.});
  deallog << "extruded U: volume " << *prism.volume() << ", points of 16^3 over its box "
          << count(prism, prism.bounding_box(), 16) << std::endl;
}

template <int dim>
void
balls()
{
  const Point<dim> centre = (dim == 2 ? Point<dim>(1, 2) : Point<dim>() + dealii::Tensor<1, dim>());
  const BallShape<dim>      ball(centre, 0.5);
  const auto                box     = ball.bounding_box();
  const unsigned int        n       = 40;
  const double              counted = count<dim>(ball, box, n) * std::pow(1. / n, dim);
  const IndicatorShape<dim> same(std::make_unique<dealii::ScalarFunctionFromFunctionObject<dim>>(
                                   [centre](const Point<dim> &p) {
                                     return 0.25 - p.distance_square(centre);
                                   }),
                                 box);
  deallog << dim << "d ball: volume counted within 0.5 % of " << *ball.volume() << ' '
          << (std::abs(counted / *ball.volume() - 1) < 5e-3) << ", indicator agrees "
          << (count<dim>(same, box, n) == count<dim>(ball, box, n)) << ", volume known "
          << bool(same.volume()) << std::endl;
}

/// A cube of 12 triangles as STL text: each face is cut along a diagonal.
void
write_cube(const std::string &name)
{
  std::ofstream out(name);
  const int     faces[6][4] = {
        {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  out << "solid cube\n";
  for (const auto &f : faces)
    for (const auto &t :
         {std::array<int, 3>{{f[0], f[1], f[2]}}, std::array<int, 3>{{f[0], f[2], f[3]}}})
      {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int v : t)
          out << "vertex " << (v & 1) << ' ' << (v >> 1 & 1) << ' ' << (v >> 2) << '\n';
        out << "endloop\nendfacet\n";
      }
  out << "endsolid\n";
}

void
write_binary(const std::string &name, const FacetSoup<3> &facets)
{
  std::ofstream       out(name, std::ios::binary);
  const std::uint32_t n = facets.size();
  out << std::string("solid, but binary").append(63, ' ');
  out.write(reinterpret_cast<const char *>(&n), 4);
  for (const auto &facet : facets)
    {
      float numbers[12] = {};
      for (int i = 0; i < 9; ++i)
        numbers[3 + i] = facet[i / 3][i % 3];
      out.write(reinterpret_cast<const char *>(numbers), 48);
      out.write("\0\0", 2);
    }
}

void
surfaces()
{
  write_cube("cube.stl");
  auto                  cube = read_facets<3>("cube.stl");
  const SurfaceShape<3> shape(cube);
  // Every line of the 8^3 lattice over the cube with x = y runs through a diagonal of its lid.
  deallog << "cube: " << cube.size() << " triangles, volume " << *shape.volume()
          << ", of 8^3 points " << count(shape, shape.bounding_box(), 8) << std::endl;

  write_binary("binary.stl", cube);
  deallog << "binary file equals text: " << (read_facets<3>("binary.stl") == cube) << std::endl;

  std::swap(cube[3][0], cube[3][1]);
  const SurfaceShape<3> flipped(cube);
  deallog << "one facet turned round: points " << count(flipped, flipped.bounding_box(), 8)
          << ", volume known " << bool(flipped.volume()) << std::endl;
  cube.pop_back();
  deallog << "a facet less: open edges " << SurfaceShape<3>::open_edges(cube).size() << std::endl;

  // An octahedron |x|+|y|+|z| <= 8 whose vertices, edges and facets lie on lattice lines. Its inner
  // lattice points |i|+|j|+|k| <= 7 are 575 in number; points on the surface may go either way.
  FacetSoup<3> octahedron;
  for (const int x : {-8, 8})
    for (const int y : {-8, 8})
      for (const int z : {-8, 8})
        octahedron.push_back({{Point<3>(x, 0, 0), Point<3>(0, y, 0), Point<3>(0, 0, z)}});
  const SurfaceShape<3> eight(octahedron);
  unsigned int          inner = 0, wrong = 0;
  for (int i = -9; i <= 9; ++i)
    for (int j = -9; j <= 9; ++j)
      for (int k = -9; k <= 9; ++k)
        {
          const int  sum    = std::abs(i) + std::abs(j) + std::abs(k);
          const bool inside = eight.contains(Point<3>(i, j, k));
          inner += (sum < 8 && inside);
          wrong += (sum > 8 && inside);
        }
  deallog << "octahedron on the lattice: inside " << inner << ", wrongly inside " << wrong
          << std::endl;
}

/// Triangles as a mesh, and a cube of quadrilaterals in Abaqus' format.
void
triangles_and_abaqus()
{
  dealii::Triangulation<2, 3> sphere, coarse, triangles;
  dealii::GridGenerator::hyper_sphere(sphere);
  coarse.copy_triangulation(sphere);
  dealii::GridGenerator::convert_hypercube_to_simplex_mesh(coarse, triangles);
  std::ofstream vtk("triangles.vtk");
  dealii::GridOut().write_vtk(triangles, vtk);
  vtk.close();
  const SurfaceShape<3> ball(read_facets<3>("triangles.vtk"));

  std::ofstream inp("cube.inp");
  inp << "*HEADING\n cube\n*NODE\n";
  for (int v = 0; v < 8; ++v)
    inp << v + 1 << ", " << (v & 1) << ", " << (v >> 1 & 1) << ", " << (v >> 2) << '\n';
  inp << "*ELEMENT, TYPE=S4R, ELSET=EB1\n1, 1, 3, 4, 2\n2, 5, 6, 8, 7\n3, 1, 2, 6, 5\n"
         "4, 3, 7, 8, 4\n5, 1, 5, 7, 3\n6, 2, 4, 8, 6\n";
  inp.close();
  const SurfaceShape<3> cube(read_facets<3>("cube.inp"));
  deallog << "triangles in .vtk: polyhedron with points inside "
          << (count(ball, ball.bounding_box(), 9) > 0) << ", its centre inside "
          << ball.contains(Point<3>()) << "; Abaqus cube: volume " << cube.volume().value_or(-1)
          << ", of 8^3 points " << count(cube, cube.bounding_box(), 8) << std::endl;
}

/// A sphere (3-D: quadrilaterals, 2-D: lines) written as a file by deal.II and read back.
template <int dim>
void
mesh_files()
{
  dealii::Triangulation<dim - 1, dim> sphere;
  dealii::GridGenerator::hyper_sphere(sphere, Point<dim>(), 1.);
  sphere.refine_global(dim == 2 ? 4 : 3);
  for (const std::string suffix : {"vtk", "msh", "ucd"})
    {
      {
        std::ofstream   file("sphere." + suffix);
        dealii::GridOut out;
        if (suffix == "vtk")
          out.write_vtk(sphere, file);
        else if (suffix == "msh")
          out.write_msh(sphere, file);
        else
          out.write_ucd(sphere, file);
      }
      const SurfaceShape<dim> shape(read_facets<dim>("sphere." + suffix));
      const BallShape<dim>    ball(Point<dim>(), 1.);
      const auto              box     = ball.bounding_box();
      const double            counted = count<dim>(shape, box, 50) * std::pow(2. / 50, dim);
      deallog << dim << "d ." << suffix << ": volume known and within 2 % of the ball's "
              << (std::abs(shape.volume().value_or(0) / *ball.volume() - 1) < 0.02)
              << ", counted within 0.5 % " << (std::abs(counted / *shape.volume() - 1) < 5e-3)
              << std::endl;
    }
}

int
main()
{
  initlog();
  polygons();
  balls<2>();
  balls<3>();
  surfaces();
  mesh_files<2>();
  mesh_files<3>();
  triangles_and_abaqus();
}
