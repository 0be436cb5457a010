// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact.h>
#include <coracle/contact/rows.h>

namespace coracle::contact
{
/**
 * Rows of contacts: numbers the unknowns that contacts act on, those of the
 * caller (grid nodes) and the surface's nodes, in the order in which they are
 * met. The keys of the two kinds must differ. Points that are surface nodes need
 * nothing of the caller: a node is the same unknown on either side.
 */
template <int dim>
class RowBuilder
{
public:
  /// Where an unknown comes from: the caller's number, or the surface's node.
  struct Origin
  {
    bool         is_surface;
    unsigned int number;
  };

  /// See ContactSystem::build_rows.
  template <typename PointRow, typename UnknownOf>
  void build(const std::vector<Contact<dim>> &contacts,
             const Surface<dim>              &surface,
             const PointRow                  &point_row,
             const UnknownOf                 &unknown)
  {
    clear();
    for (const auto &contact : contacts)
      {
        entries.clear();
        if (contact.point_body < 0)
          point_row(contact.set, contact.point, entries);
        else if (surface.bodies[contact.point_body].rigid_body < 0)
          add_node(surface, contact.point_node, 1.);
        for (const auto &entry : entries)
          {
            unsigned int &number = local_number(place, entry.unknown);
            if (number == none)
              {
                number = all.size();
                sources.push_back({false, entry.unknown});
                all.push_back(unknown(entry.unknown));
              }
            add(number, entry.weight);
          }
        list.begin.push_back(list.entries.size());
        add_facet_side(contact, surface);
      }
  }

  const Rows                      &rows() const { return list; }
  const std::vector<Unknown<dim>> &unknowns() const { return all; }
  const std::vector<Origin>       &origins() const { return sources; }

private:
  void clear();

  static unsigned int &local_number(std::vector<unsigned int> &places, const unsigned int number)
  {
    if (number >= places.size())
      places.resize(number + 1 + number / 2, none);
    return places[number];
  }

  /// One more entry of the present side, or more weight on one that it has.
  void add(const unsigned int unknown, const double weight);
  /// The same for a node of the surface; those that it hangs on, if it does.
  void add_node(const Surface<dim> &surface, const unsigned int index, const double weight);
  void add_facet_side(const Contact<dim> &contact, const Surface<dim> &surface);

  static constexpr unsigned int none = -1;

  Rows                      list;
  std::vector<Unknown<dim>> all;
  std::vector<Origin>       sources;
  std::vector<Rows::Entry>  entries;
  /// Local numbers by the caller's number and by the surface's node.
  std::vector<unsigned int> place, node_place;
};
} // namespace coracle::contact
