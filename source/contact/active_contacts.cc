// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/active_contacts.h>

#include <numeric>

namespace coracle::contact
{
template <int dim>
void
ActiveContacts<dim>::take_all(const Delassus<dim> &delassus)
{
  const auto &rows = delassus.rows();
  active_contacts.clear();
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (!rows[c].fixed)
      active_contacts.push_back(c);
  active_nodes.resize(delassus.predicted.nodes.size());
  std::iota(active_nodes.begin(), active_nodes.end(), 0u);
  is_complete = true;
}

template <int dim>
void
ActiveContacts<dim>::find_nodes(const Delassus<dim> &delassus)
{
  marked.resize(delassus.predicted.nodes.size());
  active_nodes = delassus.shared_nodes();
  for (const unsigned int i : active_nodes)
    marked[i] = 1;
  for (const unsigned int c : active_contacts)
    {
      const auto &row = delassus.rows()[c];
      for (auto i = delassus.first_node(row); i != delassus.last_node(row); ++i)
        if (!marked[*i])
          {
            marked[*i] = 1;
            active_nodes.push_back(*i);
          }
    }
  for (const unsigned int i : active_nodes)
    marked[i] = 0;
}

template class ActiveContacts<2>;
template class ActiveContacts<3>;
} // namespace coracle::contact
