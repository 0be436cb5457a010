// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/delassus.h>

namespace coracle::contact
{
/**
 * The contacts that an iteration of GaussSeidel visits. The last few that converge
 * slowly need not make all others pay: between two iterations of all contacts
 * there are some of those only whose impulses still changed in the first.
 */
template <int dim>
class ActiveContacts
{
public:
  /// All contacts that can change something.
  void take_all(const Delassus<dim> &delassus);

  /// Leaves out those of which `moves` is false.
  template <typename Moves>
  void leave_out(const Delassus<dim> &delassus, const Moves &moves)
  {
    resting_contacts.clear();
    std::size_t n = 0;
    for (const unsigned int c : active_contacts)
      if (moves(c))
        active_contacts[n++] = c;
      else
        resting_contacts.push_back(c);
    active_contacts.resize(n);
    find_nodes(delassus);
    is_complete = false;
  }

  /// In ascending order.
  const std::vector<unsigned int> &contacts() const { return active_contacts; }
  /// Nodes that they act on, and all that others share.
  const std::vector<unsigned int> &nodes() const { return active_nodes; }
  /// Contacts that were left out.
  const std::vector<unsigned int> &resting() const { return resting_contacts; }
  bool                             complete() const { return is_complete; }

private:
  void find_nodes(const Delassus<dim> &delassus);

  bool                      is_complete = true;
  std::vector<unsigned int> active_contacts, active_nodes, resting_contacts;
  std::vector<char>         marked;
};
} // namespace coracle::contact
