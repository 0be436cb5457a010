// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts are the local minima of the distance to the whole surface: one on a
// flat plate, two in a valley, one at an edge or vertex however many facets share
// it; the side is right in folds, inside bodies and round a sheet's rim; a point
// slides over 1000 coplanar facets without losing speed, and none passes a folded sheet.

#include "scene.h"

using namespace scene;
using P2 = dealii::Point<2>;
using P3 = dealii::Point<3>;

/// Contacts of one point at rest.
template <int dim>
std::vector<Contact<dim>>
contacts_at(const Surface<dim>       &surface,
            const dealii::Point<dim> &x,
            const double              radius,
            double                   *side = nullptr)
{
  Points<dim> points;
  points.radius = radius;
  points.add(x, dealii::Tensor<1, dim>());
  if (side != nullptr)
    points.side[0] = *side;
  ContactSystem<dim> contacts(ContactOptions(), MPI_COMM_WORLD);
  contacts.find(surface, {points.set()}, 1.);
  if (side != nullptr)
    *side = points.side[0];
  return contacts.contacts();
}

void
plates()
{
  // 10 x 10 facets; points above the inside, an edge and a vertex, and a hair beside them.
  auto plate = one_body<3>(SurfaceKind::closed);
  add_sheet(plate, 10, 10, [](const unsigned int i, const unsigned int j) {
    return P3(0.1 * i, 0.1 * j, 0);
  });
  unsigned int wrong = 0, lowest_key = 0;
  for (const double offset :
       {0., 1e-16, 1e-15, 1e-13, 1e-12, 3e-12, 1e-11, 3e-11, 1e-10, 1e-9, 1e-6})
    for (const double sign : {-1., 1.})
      for (const double z : {0., 1e-13, 1e-6, 0.03})
        for (const auto &x : {P3(.34, .57, z),
                              P3(.3 + sign * offset, .57, z),
                              P3(.3 + sign * offset, .5 - offset, z)})
          {
            const auto found = contacts_at<3>(plate, x, 0.15);
            wrong += (found.size() != 1 || std::abs(found[0].gap - z) > 1e-12 ||
                      found[0].normal[2] < 1 - 1e-6);
          }
  const auto vertex = contacts_at<3>(plate, P3(.3, .5, .1), 0.15);
  lowest_key        = plate.facets[vertex[0].facet].key;
  deallog << "flat plate: wrong " << wrong << ", vertex reported by facet " << lowest_key
          << std::endl;

  // A valley and a ridge with slope 1 along y = 0.
  for (const double slope : {1., -1.})
    {
      auto fold = one_body<3>(SurfaceKind::closed);
      add_sheet(fold, 4, 4, [slope](const unsigned int i, const unsigned int j) {
        const double y = 0.25 * (int(j) - 2);
        return P3(0.25 * i, y, slope * std::abs(y));
      });
      const auto found = contacts_at<3>(fold, P3(.6, 0.01, .1), 0.15);
      deallog << (slope > 0 ? "valley: " : "ridge: ") << found.size() << " contacts, region "
              << int(found[0].region) << ", gap " << found[0].gap << std::endl;
      const auto deep = contacts_at<3>(fold, P3(.6, 0.01, slope > 0 ? -.05 : -.1), 0.15);
      deallog << "  from inside: " << deep.size() << " contacts, gap " << deep[0].gap << ", normal "
              << deep[0].normal << std::endl;
    }
}

void
bodies()
{
  // A square block in 2-D, sides 1, counter-clockwise.
  auto block = one_body<2>(SurfaceKind::closed);
  add_polyline(block, {P2(0, 0), P2(1, 0), P2(1, 1), P2(0, 1)}, true);
  const auto corner = contacts_at<2>(block, P2(1.03, 1.04), 0.1);
  deallog << "corner from outside: " << corner.size() << ", gap " << corner[0].gap << ", normal "
          << corner[0].normal << std::endl;
  const auto inside = contacts_at<2>(block, P2(0.98, 0.97), 0.1);
  deallog << "corner from inside: " << inside.size() << ", gap " << inside[0].gap << ", normal "
          << inside[0].normal << std::endl;
  // A thin plate: the far face is hidden by the near one.
  auto thin = one_body<2>(SurfaceKind::closed);
  add_polyline(thin, {P2(0, 0), P2(1, 0), P2(1, 0.01), P2(0, 0.01)}, true);
  const auto above = contacts_at<2>(thin, P2(0.5, 0.06), 0.1);
  deallog << "thin plate from above: " << above.size() << ", gap " << above[0].gap << std::endl;
}

void
sheets()
{
  // A folded sheet, both sides, and its rim.
  auto sheet = one_body<2>(SurfaceKind::sheet, 0.02);
  add_polyline(sheet, {P2(-1, 0), P2(0, 1), P2(1, 0)}, false);
  for (const double y : {0.95, 1.05})
    {
      double     side  = 0;
      const auto found = contacts_at<2>(sheet, P2(0.001, y), 0.1, &side);
      deallog << "fold from " << (y < 1 ? "below" : "above") << ": " << found.size()
              << " contacts, side " << side << ", gap " << found[0].gap << std::endl;
      // A point that has passed belongs where it came from.
      side            = -2 * side;
      const auto back = contacts_at<2>(sheet, P2(0.001, y), 0.1, &side);
      deallog << "  passed: " << back.size() << ", side " << 0.5 * side << ", gap " << back[0].gap
              << ", normal y " << back[0].normal[1] << std::endl;
    }
  double     side = 1;
  const auto rim  = contacts_at<2>(sheet, P2(-1.03, -0.03), 0.1, &side);
  deallog << "beyond the rim: " << rim.size() << ", gap " << rim[0].gap << ", side " << side
          << std::endl;
  side = 1;
  contacts_at<2>(sheet, P2(0, 1.5), 0.1, &side);
  deallog << "out of the band: side " << side << std::endl;
}

void
slide()
{
  for (const double height : {1., 0.5})
    {
      auto            plate = one_body<2>(SurfaceKind::closed);
      std::vector<P2> places;
      for (unsigned int i = 0; i <= 1000; ++i)
        places.push_back(P2(10 - 0.01 * i, 0));
      add_polyline(plate, places, false);
      Points<2> points;
      points.radius = 0.01;
      points.add(P2(0.0317, height * 0.01), dealii::Tensor<1, 2>({10., 0.}));
      ContactSystem<2>             contacts(ContactOptions(), MPI_COMM_WORLD);
      std::vector<RigidUnknown<2>> rigid;
      for (unsigned int k = 0; k < 990; ++k)
        {
          points.velocity[1][0] -= 0.00981;
          step(contacts, plate, points, rigid, 0.001);
        }
      deallog << "slid " << points.position[0][0] << " from height " << height
              << " R, relative loss below 1e-12: "
              << (std::abs(points.velocity[0][0] / 10 - 1) < 1e-12) << ", height "
              << points.position[1][0] << ", penetrations " << contacts.report().n_penetrations
              << std::endl;
    }
}

void
folded_sheet()
{
  // Points rain on a zigzag sheet with R = 1.5 mm; steps of up to 2 mm.
  auto            sheet = one_body<2>(SurfaceKind::sheet, 0.001);
  std::vector<P2> places;
  for (int i = 0; i <= 40; ++i)
    places.push_back(P2(0.005 * (20 - i), i % 2 ? 0.012 : 0.));
  add_polyline(sheet, places, false);
  Points<2> points;
  points.radius = 0.001;
  std::mt19937                     generator(5);
  std::uniform_real_distribution<> uniform(-1, 1);
  for (unsigned int i = 0; i < 500; ++i)
    points.add(P2(0.085 * uniform(generator),
                  (i % 2 ? 1 : -1) * (0.025 + 0.01 * uniform(generator))),
               dealii::Tensor<1, 2>({2 * uniform(generator), (i % 2 ? -10. : 10.)}));
  ContactSystem<2>             contacts(ContactOptions(), MPI_COMM_WORLD);
  std::vector<RigidUnknown<2>> rigid;
  unsigned int                 wrong_side = 0;
  for (unsigned int k = 0; k < 300; ++k)
    {
      for (unsigned int i = 0; i < points.size(); ++i)
        points.velocity[1][i] += (i % 2 ? -0.05 : 0.05);
      step(contacts, sheet, points, rigid, 0.0002);
    }
  for (unsigned int i = 0; i < points.size(); ++i)
    {
      const double x = std::abs(points.position[0][i]), period = x / 0.01 - std::floor(x / 0.01);
      const double height = 0.024 * std::min(period, 1 - period);
      wrong_side += (x < 0.1 && (points.position[1][i] > height) != (i % 2 == 1));
    }
  deallog << "folded sheet: on the wrong side " << wrong_side << ", penetrations "
          << contacts.report().n_penetrations << ", all converged "
          << contacts.report().solver.velocity.converged << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  plates();
  bodies();
  sheets();
  slide();
  folded_sheet();
}
