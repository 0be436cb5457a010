// SPDX-License-Identifier: GPL-3.0-or-later
// Which points touch a facet, by each local search: the case prm/local_search (Song, Liu & Zhang
// 2020, section 5.1). Prints the share of random points that touch a flat square against the exact
// volumes, counts what differs from the quintic oracle on random facets, and writes the contacts
// with one and with two facets for the pictures.
//   local_search_contacts [folder]
#include <deal.II/base/mpi.h>

#include <coracle/contact/contact_system.h>

#include <cstdio>
#include <string>

#include "../tests/contact/quintic_oracle.h"

namespace
{
using namespace coracle::contact;
using quintic_oracle::Corners;
using quintic_oracle::Shape;
using Point = dealii::Point<3>;

constexpr double thickness = 0.24, radius = 0.2, distance = 0.5 * thickness + radius;

struct Method
{
  LocalMethod method;
  const char *name;
};
constexpr std::array<Method, 3> methods = {
  {{LocalMethod::nearest_on_surface, "nearest on surface"},
   {LocalMethod::nearest_per_facet, "nearest per facet"},
   {LocalMethod::perpendicular_foot, "perpendicular foot"}}};

Point
to_point(const quintic_oracle::Vector3 &x)
{
  return Point(x[0], x[1], x[2]);
}

/// A sheet of facets that share the nodes they name.
Surface<3>
sheet(const std::vector<Point> &nodes, const std::vector<std::array<unsigned int, 4>> &facets)
{
  Surface<3> surface;
  surface.bodies.resize(1);
  surface.bodies[0].kind      = SurfaceKind::sheet;
  surface.bodies[0].thickness = thickness;
  surface.bodies[0].sheet     = 0;
  for (const auto &x : nodes)
    {
      SurfaceNode<3> node;
      node.position = x;
      node.key      = surface.nodes.size();
      surface.nodes.push_back(node);
    }
  for (const auto &facet : facets)
    surface.facets.push_back({facet, 0, surface.facets.size()});
  return surface;
}

Surface<3>
one_facet(const Corners &x)
{
  return sheet({to_point(x[0]), to_point(x[1]), to_point(x[2]), to_point(x[3])}, {{{0, 1, 2, 3}}});
}

/// Points at rest in [-1,1]^3.
struct Points
{
  std::array<std::vector<double>, 3> x;
  std::vector<double>                side;

  Points(const unsigned int n, quintic_oracle::Random &random) : side(n, 0.)
  {
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int d = 0; d < 3; ++d)
        x[d].push_back(random());
  }

  PointSet<3> set()
  {
    PointSet<3> result;
    result.n_points        = side.size();
    result.constant_radius = radius;
    result.side            = {side.data()};
    for (unsigned int d = 0; d < 3; ++d)
      result.position[d] = x[d].data();
    return result;
  }

  quintic_oracle::Vector3 point(const unsigned int i) const
  {
    return {{x[0][i], x[1][i], x[2][i]}};
  }
};

/// Per point how it touches: 0 not at all, 1 inside a facet, 2 at an edge or vertex only.
std::vector<int>
touching(const Surface<3> &surface, Points &points, const LocalMethod method)
{
  ContactOptions options;
  options.local_search = method;
  std::fill(points.side.begin(), points.side.end(), 0.);
  ContactSystem<3> system(options, MPI_COMM_SELF);
  system.find(surface, {points.set()}, 1e-6);
  std::vector<int> result(points.side.size(), 0);
  for (const auto &contact : system.contacts())
    {
      int &status = result[contact.point];
      status      = (contact.region == Region::interior || status == 1 ? 1 : 2);
    }
  return result;
}

void
flat_square(const unsigned int n)
{
  quintic_oracle::Random random(1);
  Points                 points(n, random);
  const auto             square =
    one_facet({{{{-0.5, -0.5, 0}}, {{0.5, -0.5, 0}}, {{0.5, 0.5, 0}}, {{-0.5, 0.5, 0}}}});
  // Slab, four half cylinders, four quarters of a ball; the slab alone. The cube's volume is 8.
  const double r = distance, slab = 2 * r / 8,
               rounded = slab + (2 * M_PI * r * r + 4. / 3. * M_PI * r * r * r) / 8;
  std::printf("Flat square, half-size 0.5, in [-1,1]^3; contact distance %g; %u points\n\n", r, n);
  std::printf("%-20s %12s %12s %22s\n", "", "share", "exact", "difference in sigma");
  for (const auto &method : methods)
    {
      const auto   status = touching(square, points, method.method);
      const double share  = double(n - std::count(status.begin(), status.end(), 0)) / n;
      const double exact  = (method.method == LocalMethod::perpendicular_foot ? slab : rounded);
      std::printf("%-20s %12.5f %12.5f %22.2f\n",
                  method.name,
                  share,
                  exact,
                  (share - exact) / std::sqrt(exact * (1 - exact) / n));
    }
}

void
random_facets(const unsigned int n_facets, const unsigned int n_points)
{
  quintic_oracle::Random                  random(2);
  std::array<std::size_t, methods.size()> missed{}, false_ones{};
  std::size_t                             touch = 0;
  for (unsigned int f = 0; f < n_facets; ++f)
    {
      const auto                                   corners = random.facet(Shape::quadrants);
      Points                                       points(n_points, random);
      const auto                                   surface = one_facet(corners);
      std::array<std::vector<int>, methods.size()> status;
      for (unsigned int m = 0; m < methods.size(); ++m)
        status[m] = touching(surface, points, methods[m].method);
      for (unsigned int i = 0; i < n_points; ++i)
        {
          auto       relative = corners;
          const auto p        = points.point(i);
          for (auto &corner : relative)
            for (int d = 0; d < 3; ++d)
              corner[d] -= p[d];
          const bool near = quintic_oracle::distance(relative) < distance;
          touch += near;
          for (unsigned int m = 0; m < methods.size(); ++m)
            {
              missed[m] += near && status[m][i] == 0;
              false_ones[m] += !near && status[m][i] != 0;
            }
        }
    }
  std::printf("\n%u random facets, a corner in each quadrant, %u points each: %zu of %zu touch by "
              "the quintic\n\n",
              n_facets,
              n_points,
              touch,
              std::size_t(n_facets) * n_points);
  std::printf("%-20s %12s %12s\n", "", "missed", "too many");
  for (unsigned int m = 0; m < methods.size(); ++m)
    std::printf("%-20s %12zu %12zu\n", methods[m].name, missed[m], false_ones[m]);
}

void
write(const std::string &name, const Surface<3> &surface, const unsigned int n)
{
  quintic_oracle::Random random(3);
  Points                 points(n, random);
  std::FILE             *file = std::fopen((name + "_facets.csv").c_str(), "w");
  if (file == nullptr)
    return std::perror(name.c_str());
  std::fprintf(file, "facet,x [m],y [m],z [m]\n");
  for (const auto &facet : surface.facets)
    for (const unsigned int node : facet.nodes)
      {
        const auto &x = surface.nodes[node].position;
        std::fprintf(file, "%lu,%.9g,%.9g,%.9g\n", facet.key, x[0], x[1], x[2]);
      }
  std::fclose(file);

  std::array<std::vector<int>, methods.size()> status;
  for (unsigned int m = 0; m < methods.size(); ++m)
    status[m] = touching(surface, points, methods[m].method);
  file = std::fopen((name + "_points.csv").c_str(), "w");
  std::fprintf(
    file, "x [m],y [m],z [m],%s,%s,%s\n", methods[0].name, methods[1].name, methods[2].name);
  std::array<std::array<std::size_t, 3>, methods.size()> count{};
  for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int m = 0; m < methods.size(); ++m)
        ++count[m][status[m][i]];
      if (status[0][i] != 0)
        std::fprintf(file,
                     "%.5f,%.5f,%.5f,%d,%d,%d\n",
                     points.x[0][i],
                     points.x[1][i],
                     points.x[2][i],
                     status[0][i],
                     status[1][i],
                     status[2][i]);
    }
  std::fclose(file);
  std::printf("\n%s: %u points\n\n%-20s %12s %12s\n", name.c_str(), n, "", "inside", "at edges");
  for (unsigned int m = 0; m < methods.size(); ++m)
    std::printf("%-20s %12zu %12zu\n", methods[m].name, count[m][1], count[m][2]);
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const std::string                        folder = (argc > 1 ? argv[1] : ".");
  flat_square(4000000);
  random_facets(200, 20000);
  quintic_oracle::Random random(12);
  write(folder + "/one_facet", one_facet(random.facet(Shape::quadrants)), 200000);
  // A ridge along y: two facets that share its nodes 1 and 2.
  write(folder + "/two_facets",
        sheet({Point(-.55, -.5, -.35),
               Point(.02, -.55, .2),
               Point(-.04, .5, .35),
               Point(-.6, .45, -.25),
               Point(.6, -.45, -.3),
               Point(.5, .55, -.4)},
              {{{0, 1, 2, 3}}, {{1, 4, 5, 2}}}),
        200000);
}
