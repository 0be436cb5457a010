// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/physics/transformations.h>

#include <coracle/mesh/mesh_from_file.h>
#include <coracle/mesh/sheet_generation.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace coracle
{
const std::vector<std::string> sheet_types = {"polyline", "surface file"};

namespace
{
/// Points nearer to each other than this, in sizes of the whole surface, are one.
constexpr double same_point = 1e-9;

void
declare_line(Declaration &section)
{
  section.list("Points", "0, 0, 1, 0", "m", "", "x1, y1, x2, y2, ... of the line");
  section.list("Subdivisions",
               "1",
               "1",
               "",
               "facets of each piece between two points, or one number for all pieces");
}

/// One line of a polyline section: its pieces are subdivided evenly.
void
add_line(const Parameters &section, FacetList<2> &lines)
{
  const std::vector<double> x = section.list("Points");
  std::vector<double>       n = section.list("Subdivisions");
  if (x.size() < 4 || x.size() % 2 == 1)
    throw section.error("Points",
                        "line without two points",
                        std::to_string(x.size()) + " coordinates",
                        "give x and y of each point, and two points or more");
  const std::size_t n_pieces = x.size() / 2 - 1;
  if (n.size() == 1)
    n.resize(n_pieces, n[0]);
  for (const double count : n)
    if (n.size() != n_pieces || count < 1 || count != std::floor(count))
      throw section.error("Subdivisions",
                          "wrong number of facets",
                          std::to_string(n.size()) + " numbers for " + std::to_string(n_pieces) +
                            " pieces of a line",
                          "give one whole number from 1, or one for each piece");
  const auto point = [&x](const std::size_t i) { return dealii::Point<2>(x[2 * i], x[2 * i + 1]); };
  lines.points.push_back(point(0));
  for (std::size_t piece = 0; piece < n_pieces; ++piece)
    for (unsigned int k = 1; k <= n[piece]; ++k)
      {
        const unsigned int last = lines.points.size() - 1;
        const double       s    = k / n[piece];
        lines.points.emplace_back((1 - s) * point(piece) + s * point(piece + 1));
        lines.facets.push_back({{last, last + 1}});
      }
}

/// Divide the facet that a point lies on, so that a line which ends there is joined to it.
void
divide_at(const unsigned int p, const double tolerance, FacetList<2> &lines)
{
  for (std::size_t f = 0; f < lines.facets.size(); ++f)
    {
      const auto [a, b]   = lines.facets[f];
      const auto   along  = lines.points[b] - lines.points[a];
      const auto   from_a = lines.points[p] - lines.points[a];
      const double length = along.norm();
      const double place  = from_a * along / length;
      const bool   is_near =
        std::fabs(from_a[0] * along[1] - from_a[1] * along[0]) <= tolerance * length;
      if (is_near && place > tolerance && place < length - tolerance)
        {
          lines.facets[f] = {{a, p}};
          lines.facets.insert(lines.facets.begin() + f + 1, {{p, b}});
        }
    }
}

FacetList<2>
polylines(const Parameters &section)
{
  FacetList<2>              lines;
  std::vector<unsigned int> ends;
  const auto                add = [&](const Parameters &line) {
    ends.push_back(lines.points.size());
    add_line(line, lines);
    ends.push_back(lines.points.size() - 1);
  };
  add(section);
  const Parameters further = section.section("Further lines");
  for (const std::string &name : further.section_names())
    add(further.section(name));
  double size = 0;
  for (const auto &p : lines.points)
    size = std::max(size, p.distance(lines.points[0]));
  for (const unsigned int end : ends)
    divide_at(end, same_point * size, lines);
  return lines;
}

FacetList<3>
extrude(const FacetList<2> &lines, const double length, const unsigned int n_layers)
{
  FacetList<3>       surface;
  const unsigned int n_points = lines.points.size();
  for (unsigned int layer = 0; layer <= n_layers; ++layer)
    for (const auto &p : lines.points)
      surface.points.emplace_back(p[0], p[1], length * layer / n_layers);
  for (unsigned int layer = 0; layer < n_layers; ++layer)
    for (const auto &line : lines.facets)
      {
        // The outward normal of the line in the plane stays the outward normal.
        const unsigned int a = line[0] + layer * n_points, b = line[1] + layer * n_points;
        surface.facets.push_back({{a, b, b + n_points, a + n_points}});
      }
  return surface;
}

template <int dim>
FacetList<dim>
read_file(const Parameters &section)
{
  try
    {
      return make_facets<dim>(read_mesh_file(section.file("File")));
    }
  catch (const FileError &error)
    {
      throw section.error(
        "File",
        "surface file that cannot be used",
        error.what(),
        "give a gmsh (.msh), Abaqus (.inp) or legacy VTK (.vtk) file, as text, with "
        "quadrilaterals and triangles (in 2-D: lines) of first order, and no "
        "volumes");
    }
}

template <int dim>
void
place(const Parameters &section, std::vector<dealii::Point<dim>> &points)
{
  const double scale = section.quantity("Scale"), angle = section.quantity("Rotation angle");
  dealii::Tensor<2, dim> turn;
  if constexpr (dim == 2)
    turn = dealii::Physics::Transformations::Rotations::rotation_matrix_2d(angle);
  else
    {
      const dealii::Tensor<1, 3> axis = section.template point<3>("Rotation axis");
      if (axis.norm() == 0)
        throw section.error("Rotation axis", "no axis", "0, 0, 0", "give a direction");
      turn = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
        dealii::Point<3>(axis / axis.norm()), angle);
    }
  const dealii::Tensor<1, dim> position = section.template point<dim>("Position");
  for (auto &p : points)
    p = dealii::Point<dim>(turn * (scale * p) + position);
}

/// For each point the first one at the same place.
template <int dim>
std::vector<unsigned int>
weld(const std::vector<dealii::Point<dim>> &points)
{
  dealii::Point<dim> lower = points[0], upper = points[0];
  for (const auto &p : points)
    for (int d = 0; d < dim; ++d)
      {
        lower[d] = std::min(lower[d], p[d]);
        upper[d] = std::max(upper[d], p[d]);
      }
  const double tolerance = same_point * std::max(lower.distance(upper), 1e-300),
               bin       = 100 * tolerance;
  using Bin              = std::array<std::int64_t, dim>;
  std::map<Bin, std::vector<unsigned int>> bins;
  std::vector<unsigned int>                first(points.size());
  for (unsigned int i = 0; i < points.size(); ++i)
    {
      first[i] = i;
      // The bins that the tolerance reaches into.
      for (unsigned int corner = 0; corner < (1u << dim); ++corner)
        {
          Bin at;
          for (int d = 0; d < dim; ++d)
            at[d] = std::floor(
              (points[i][d] - lower[d] + ((corner >> d & 1u) != 0 ? tolerance : -tolerance)) / bin);
          const auto found = bins.find(at);
          if (found != bins.end())
            for (const unsigned int other : found->second)
              if (points[other].distance(points[i]) <= tolerance)
                first[i] = std::min(first[i], other);
        }
      if (first[i] == i)
        {
          Bin at;
          for (int d = 0; d < dim; ++d)
            at[d] = std::floor((points[i][d] - lower[d]) / bin);
          bins[at].push_back(i);
        }
    }
  return first;
}

template <int dim>
void
check_facets(const Parameters &section, const FacetList<dim> &surface)
{
  std::set<typename FacetList<dim>::Corners> known;
  for (auto corners : surface.facets)
    {
      const auto middle = surface.points[corners[0]];
      std::sort(corners.begin(), corners.end());
      const std::size_t n = std::unique(corners.begin(), corners.end()) - corners.begin();
      std::fill(corners.begin() + n, corners.end(), corners[n - 1]);
      const bool repeated = !known.insert(corners).second;
      if (n >= dim && !repeated)
        continue;
      std::ostringstream found;
      found << "a facet at (" << middle << ") m "
            << (repeated ? "that is there already" : "whose corners are at the same place");
      throw section.error("Type", "facet that cannot be used", found.str(), "leave it out");
    }
}
} // namespace

void
declare_sheets(Declaration &section)
{
  Declaration &line = section.when("Type", "polyline");
  declare_line(line);
  declare_line(line.named_sections("Further lines",
                                   "line",
                                   "More lines of the same body; they are joined where points are "
                                   "at the same place, and where one ends on another"));
  line.quantity("Length", "1", "m", "", "along z, from 0, 3-D only", 0.);
  line.integer("Subdivisions along z", 1, "facets along z, 3-D only", 1);
  section.when("Type", "surface file")
    .file("File",
          "quadrilaterals and triangles (in 2-D: lines): gmsh (.msh), Abaqus (.inp) or legacy "
          "VTK (.vtk)");
}

template <int dim>
FacetList<dim>
generate_sheets(const Parameters &section)
{
  FacetList<dim> surface;
  if (section.choice("Type") == "surface file")
    surface = read_file<dim>(section);
  else if constexpr (dim == 2)
    surface = polylines(section);
  else
    surface = extrude(polylines(section),
                      section.quantity("Length"),
                      section.integer("Subdivisions along z"));
  if (section.integer("Refinements") > 0 || !section.list("Refined region").empty())
    throw section.error("Refinements",
                        "surface that cannot be refined",
                        "Type = " + section.choice("Type"),
                        "use Subdivisions, or a finer file");
  place<dim>(section, surface.points);
  const std::vector<unsigned int> first = weld(surface.points);
  for (auto &corners : surface.facets)
    for (unsigned int &corner : corners)
      corner = first[corner];
  check_facets(section, surface);
  // A quadrilateral with two corners at one place is a triangle.
  if constexpr (dim == 3)
    for (auto &corners : surface.facets)
      for (unsigned int k = 0; k < 4; ++k)
        if (corners[k] == corners[(k + 1) % 4])
          {
            std::rotate(corners.begin(), corners.begin() + (k + 2) % 4, corners.end());
            break;
          }
  return surface;
}

template FacetList<2> generate_sheets(const Parameters &);
template FacetList<3> generate_sheets(const Parameters &);
} // namespace coracle
