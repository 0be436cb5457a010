// SPDX-License-Identifier: GPL-3.0-or-later
// Where a large facet meets smaller ones at an edge with a hanging node, the surface is whole: one
// contact on a plate and on a ridge, two in a valley, none that leans, wherever the point is, also
// from inside; and an impulse at the hanging node moves the nodes that it hangs on, so that the
// point and its contact part as the law says.

#include "scene.h"

using namespace scene;
using P3 = dealii::Point<3>;

/// A facet from x = 0 to 1 and y = 0 to 1, beyond x = 1 quarters of such; more large ones around;
/// z is a function of x. With knowledge of who hangs, or without.
Surface<3>
plate(const double slope_beyond, const bool knows, const double inverse_mass = 0)
{
  auto       s = one_body<3>(SurfaceKind::closed);
  const auto z = [&](const double x) { return x > 1 ? slope_beyond * (x - 1) : 0.; };
  std::map<std::pair<int, int>, unsigned int> known;
  // In halves of the large facets.
  const auto node = [&](const int i, const int j) {
    const auto found = known.find({i, j});
    if (found != known.end())
      return found->second;
    return known[{i, j}] = add_node<3>(s, P3(0.5 * i, 0.5 * j, z(0.5 * i)), inverse_mass);
  };
  for (int j = -2; j <= 2; j += 2)
    for (int i = -2; i <= 0; i += 2)
      add_facet<3>(s, {{node(i, j), node(i + 2, j), node(i + 2, j + 2), node(i, j + 2)}});
  for (int j = -2; j <= 3; ++j)
    for (int i = 2; i <= 3; ++i)
      add_facet<3>(s, {{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}});
  for (int j = -1; j <= 3 && knows; j += 2)
    {
      auto &hanging   = s.nodes[node(2, j)];
      hanging.parents = {{int(node(2, j - 1)), int(node(2, j + 1))}};
      for (int d = 0; d < 3; ++d)
        hanging.inverse_mass[d] = 0.5 * inverse_mass;
    }
  return s;
}

std::vector<Contact<3>>
contacts_at(const Surface<3> &surface, const P3 &x)
{
  Points<3> points;
  points.radius = 0.15;
  points.add(x, dealii::Tensor<1, 3>());
  ContactSystem<3> contacts(ContactOptions(), MPI_COMM_WORLD);
  contacts.find(surface, {points.set()}, 1e-3);
  return contacts.contacts();
}

const std::vector<double> beside = {-0.12, -0.03, -1e-9, 0., 1e-9, 0.03, 0.12},
                          along  = {0.03, 0.25, 0.4999, 0.5, 0.5001, 0.7, 0.97, 1., 1.5};

void
search()
{
  unsigned int on_plate = 0, leaning = 0, unknowing = 0, on_ridge = 0, in_valley = 0, inside = 0;
  for (const double dx : beside)
    for (const double y : along)
      {
        const auto flat = contacts_at(plate(0, true), P3(1 + dx, y, 0.1));
        on_plate += (flat.size() != 1);
        for (const auto &contact : flat)
          leaning += (contact.normal[2] < 1 - 1e-12 || std::fabs(contact.gap - 0.1) > 1e-12);
        unknowing += (contacts_at(plate(0, false), P3(1 + dx, y, 0.1)).size() != 1);
        const auto ridge = contacts_at(plate(-1, true), P3(1 + dx, y, 0.1));
        on_ridge += (ridge.size() != 1 || ridge[0].gap < 0.05);
        in_valley += (contacts_at(plate(1, true), P3(0.96, y, 0.1)).size() != 2);
        // A point that has come in is a contact of the side that it left.
        const auto deep = contacts_at(plate(-1, true), P3(1 + dx, y, -0.05 - std::max(0., dx)));
        inside += (deep.size() != 1 || deep[0].gap > 0 || deep[0].normal[2] < 0.5);
      }
  deallog << "wrong on the plate " << on_plate << ", leaning " << leaning << ", on the ridge "
          << on_ridge << ", in the valley " << in_valley << ", inside " << inside
          << "; without knowing who hangs some are: " << (unknowing > 0) << std::endl;
}

/// A point strikes next to the hanging node; velocities of nodes follow from impulses as a body's
/// do.
void
impulse()
{
  unsigned int wrong_velocity = 0, on_hanging = 0;
  for (const auto &x : {P3(1, 0.5, 0.1), P3(1.1, 0.4, 0.1), P3(1.25, 0.25, 0.1)})
    {
      auto      surface = plate(0, true, 1.);
      Points<3> points;
      points.radius = 0.1;
      points.add(x, dealii::Tensor<1, 3>({0, 0, -1}));
      ContactOptions options;
      options.tolerance = 1e-12;
      ContactSystem<3> contacts(options, MPI_COMM_WORLD);
      contacts.find(surface, {points.set()}, 1e-3);
      contacts.build_rows(
        [](const unsigned int, const unsigned int point, auto &entries) {
          entries.push_back({point, 1.});
        },
        [&](const unsigned int) {
          Unknown<3> unknown;
          unknown.velocity     = points.v(0);
          unknown.inverse_mass = dealii::Tensor<1, 3>({1, 1, 1});
          unknown.key          = 0;
          return unknown;
        });
      contacts.solve({}, 1e-3);
      std::vector<dealii::Tensor<1, 3>> impulse(surface.nodes.size()),
        correction(surface.nodes.size());
      contacts.surface_impulses(impulse, correction);
      double point_velocity = -1;
      contacts.point_impulses(
        [&](const unsigned int, const auto &p, const auto &) { point_velocity += p[2]; });
      std::vector<double> v(surface.nodes.size());
      for (unsigned int i = 0; i < v.size(); ++i)
        {
          on_hanging += surface.nodes[i].hangs() && impulse[i].norm() > 0;
          v[i] = impulse[i][2];
        }
      for (unsigned int i = 0; i < v.size(); ++i)
        if (surface.nodes[i].hangs())
          v[i] = 0.5 * (v[surface.nodes[i].parents[0]] + v[surface.nodes[i].parents[1]]);
      double      facet_velocity = 0;
      const auto &contact        = contacts.contacts()[0];
      for (unsigned int k = 0; k < 4; ++k)
        {
          const auto key =
            contacts.surface().nodes[contacts.surface().facets[contact.facet].nodes[k]].key;
          for (unsigned int i = 0; i < v.size(); ++i)
            if (surface.nodes[i].key == key)
              facet_velocity += contact.weights[k] * v[i];
        }
      wrong_velocity += std::fabs(point_velocity - facet_velocity) > 1e-10;
    }
  deallog << "hanging nodes with impulses " << on_hanging << ", contacts with another velocity "
          << wrong_velocity << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  search();
  impulse();
}
