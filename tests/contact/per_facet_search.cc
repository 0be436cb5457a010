// SPDX-License-Identifier: GPL-3.0-or-later
// The local searches of the papers, which are there to compare with, are what the papers define:
// steepest descent ends in the nearest point of flat facets, the perpendicular foot in the point
// whose offset is normal to both tangents; one leaves no crack at a ridge, the other does; both
// work with triangles, collapsed facets, points on the surface, sheets and closed bodies, and do
// not depend on the numbering of facets.

#include <coracle/contact/perpendicular_foot.h>
#include <coracle/contact/steepest_descent.h>

#include "quintic_oracle.h"
#include "scene.h"

using namespace scene;
using quintic_oracle::Shape;
using P2 = dealii::Point<2>;
using P3 = dealii::Point<3>;

constexpr LocalMethod per_facet = LocalMethod::nearest_per_facet,
                      foot      = LocalMethod::perpendicular_foot;

template <int dim>
std::vector<Contact<dim>>
contacts_at(const Surface<dim>           &surface,
            const dealii::Point<dim>     &x,
            const double                  radius,
            const LocalMethod             method,
            const dealii::Tensor<1, dim> &velocity = dealii::Tensor<1, dim>())
{
  Points<dim> points;
  points.radius = radius;
  points.add(x, velocity);
  ContactOptions options;
  options.local_search = method;
  ContactSystem<dim> contacts(options, MPI_COMM_WORLD);
  contacts.find(surface, {points.set()}, 1e-6);
  return contacts.contacts();
}

quintic_oracle::Corners
random_pair(quintic_oracle::Random &random, const Shape shape)
{
  auto       x = random.facet(shape);
  const auto p = random.point();
  for (auto &corner : x)
    for (int d = 0; d < 3; ++d)
      corner[d] -= p[d];
  return x;
}

/// A pair with a rectangle anywhere in space. Its sides differ by less than the factor of sqrt(2)
/// beyond which steepest descent may go to and fro along an edge.
quintic_oracle::Corners
random_rectangle(quintic_oracle::Random &random)
{
  const auto   u = random.point(), v = random.point(), p = random.point();
  const double along = quintic_oracle::dot(u, v) / quintic_oracle::dot(u, u);
  auto         w     = v;
  for (int d = 0; d < 3; ++d)
    w[d] -= along * u[d];
  const double a = (1.2 + 0.18 * random()) / std::sqrt(quintic_oracle::dot(u, u)),
               b = (1.2 + 0.18 * random()) / std::sqrt(quintic_oracle::dot(w, w));
  quintic_oracle::Corners x;
  for (unsigned int k = 0; k < 4; ++k)
    for (int d = 0; d < 3; ++d)
      x[k][d] =
        (k == 1 || k == 2 ? 0.5 : -0.5) * a * u[d] + (k >= 2 ? 0.5 : -0.5) * b * w[d] - p[d];
  return x;
}

void
definitions()
{
  quintic_oracle::Random random(3);
  double                 flat = 0, warped = 1e300, foot_error = 0;
  unsigned int           feet = 0, disagree = 0;
  for (unsigned int i = 0; i < 20000; ++i)
    {
      const auto distance = [](const quintic_oracle::Corners &x, const NaturalPoint<double> &at) {
        const auto place = evaluate(make_bilinear(x), at).place;
        return std::sqrt(dot(place, place));
      };
      const auto right   = random_rectangle(random);
      const auto bent    = random_pair(random, Shape::warped);
      const auto on_flat = steepest_descent(make_bilinear(right), {});
      flat   = std::max(flat, distance(right, on_flat) - quintic_oracle::distance(right));
      warped = std::min(warped,
                        distance(bent, steepest_descent(make_bilinear(bent), {})) -
                          quintic_oracle::distance(bent));

      const auto found = perpendicular_foot(make_bilinear(bent));
      if (found.found > 0)
        {
          ++feet;
          const auto at = evaluate(make_bilinear(bent), found.place);
          foot_error    = std::max(
            {foot_error, std::abs(dot(at.place, at.t_xi)), std::abs(dot(at.place, at.t_eta))});
        }
      // On a rectangle, a foot inside and a nearest point inside are the same.
      const auto level = perpendicular_foot(make_bilinear(right));
      if (std::abs(on_flat.xi) < 1 && std::abs(on_flat.eta) < 1)
        disagree += !(std::abs(level.place.xi - on_flat.xi) < 1e-4 &&
                      std::abs(level.place.eta - on_flat.eta) < 1e-4);
    }
  deallog << "steepest descent on rectangles: within 1e-6 of the nearest: " << (flat < 1e-6)
          << "; on warped facets never nearer than the nearest: " << (warped > -1e-12) << std::endl;
  deallog << "feet of warped facets found in more than half: " << (feet > 10000)
          << ", normal to tangents to 1e-9: " << (foot_error < 1e-9)
          << "; disagree on rectangles: " << disagree << std::endl;
}

/// A ridge or a valley of facets (triangles on one side of it) along y = 0.
Surface<3>
fold(const double slope, const SurfaceKind kind, const bool turned)
{
  auto surface = one_body<3>(kind, 0.02);
  add_sheet(surface, 4, 4, [slope](const unsigned int i, const unsigned int j) {
    const double y = 0.25 * (int(j) - 2);
    return P3(0.25 * i, y, slope * std::abs(y));
  });
  const auto quadrilaterals = surface.facets;
  for (unsigned int f = 0; f < 8; ++f)
    {
      const auto &n           = quadrilaterals[f].nodes;
      surface.facets[f].nodes = {{n[0], n[1], n[2], n[2]}};
      add_facet<3>(surface, {{n[0], n[2], n[3], n[3]}});
    }
  if (turned)
    std::reverse(surface.facets.begin(), surface.facets.end());
  return surface;
}

void
cracks()
{
  for (const double slope : {0., 1., -1.})
    for (const auto method : {LocalMethod::nearest_on_surface, per_facet, foot})
      {
        // Above the fold, within reach of it; and away from it.
        const auto at_fold =
          contacts_at<3>(fold(slope, SurfaceKind::closed, false), P3(.4, 0, .05), 0.1, method);
        const auto beside = contacts_at<3>(fold(slope, SurfaceKind::closed, false),
                                           P3(.4, .1, slope * 0.1 + .02),
                                           0.03,
                                           method);
        deallog << (slope == 0 ? "plate" : (slope > 0 ? "valley" : "ridge")) << ", method "
                << int(method) << ": " << at_fold.size() << " contacts at the fold, "
                << beside.size() << " beside it, gap " << beside[0].gap << std::endl;
      }
}

void
sides()
{
  // A plate in 2-D from both sides and from within its middle; a point that moves down.
  for (const auto kind : {SurfaceKind::closed, SurfaceKind::sheet})
    {
      auto plate = one_body<2>(kind, 0.02);
      add_polyline(plate, {P2(1, 0), P2(0, 0)}, false);
      for (const auto method : {per_facet, foot})
        for (const double y : {0.05, 0., -0.05})
          {
            const auto found =
              contacts_at<2>(plate, P2(0.3, y), 0.1, method, dealii::Tensor<1, 2>({0., -1.}));
            deallog << (kind == SurfaceKind::sheet ? "sheet" : "body") << ", method " << int(method)
                    << ", y " << y << ": " << found.size() << " contact, gap " << found[0].gap
                    << ", normal y " << found[0].normal[1] << std::endl;
          }
    }
}

bool
same(const std::vector<Contact<3>> &a, const std::vector<Contact<3>> &b)
{
  bool result = (a.size() == b.size());
  for (std::size_t i = 0; result && i < a.size(); ++i)
    result = a[i].place == b[i].place && a[i].normal == b[i].normal && a[i].gap == b[i].gap;
  return result;
}

void
order_and_collapse()
{
  std::mt19937                     generator(9);
  std::uniform_real_distribution<> uniform(0, 1);
  unsigned int                     differ = 0, bad = 0;
  for (const auto method : {LocalMethod::nearest_on_surface, per_facet, foot})
    for (unsigned int i = 0; i < 200; ++i)
      {
        const P3 x(uniform(generator), uniform(generator) - 0.5, 0.6 * uniform(generator) - 0.1);
        differ += !same(contacts_at<3>(fold(1, SurfaceKind::sheet, false), x, 0.1, method),
                        contacts_at<3>(fold(1, SurfaceKind::sheet, true), x, 0.1, method));
        // Four corners of which some or all coincide.
        auto surface = one_body<3>(SurfaceKind::sheet, 0.02);
        for (unsigned int k = 0; k < 4; ++k)
          add_node<3>(surface, k > i % 4 ? P3(.5, 0, 0) : P3(0.1 * k, 0.3 * (k % 2), 0));
        add_facet<3>(surface, {{0, 1, 2, 3}});
        for (const auto &contact : contacts_at<3>(surface, i < 100 ? x : P3(.5, 0, 0), 0.5, method))
          bad += !(std::abs(contact.normal.norm() - 1) < 1e-12 && std::isfinite(contact.gap));
      }
  deallog << "depend on the numbering of facets: " << differ << ", normals that are none: " << bad
          << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  definitions();
  cracks();
  sides();
  order_and_collapse();
}
