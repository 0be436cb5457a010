// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/block_rows.h>

#include <algorithm>

namespace coracle::contact
{
template <int dim>
BlockRows<dim>::BlockRows(MPI_Comm communicator) : copies(communicator)
{}

template <int dim>
std::vector<std::uint64_t>
BlockRows<dim>::find_blocks(const std::vector<Contact<dim>>  &contacts,
                            const std::vector<PointSet<dim>> &points)
{
  std::vector<std::uint64_t> result;
  result.reserve(contacts.size());
  unsigned int set = -1, end = 0;
  for (const auto &contact : contacts)
    {
      const auto &now = points[contact.set];
      if (contact.set != set || contact.point >= end)
        {
          const auto &groups = now.group_begin;
          const auto  next   = std::upper_bound(groups.begin(), groups.end(), contact.point);
          set                = contact.set;
          end = next == groups.begin() || next == groups.end() ? contact.point + 1 : *next;
          result.push_back(now.id(contact.point) ^ (std::uint64_t(set) << 54));
        }
      else
        result.push_back(result.back());
    }
  return result;
}

template <int dim>
void
BlockRows<dim>::reinit(const std::vector<std::uint64_t>     &block,
                       const Rows                           &rows,
                       const std::vector<Unknown<dim>>      &unknowns,
                       const std::vector<RigidUnknown<dim>> &rigid)
{
  number_of_bodies = rigid.size();
  list             = rows;
  copies_of_unknowns.clear();
  copies_of_bodies.clear();
  original.clear();
  body_of_copy.clear();
  block_of_copy.clear();
  // Of the present block; copies below its first ones are other blocks'.
  std::vector<unsigned int> copy_of_unknown(unknowns.size(), 0), copy_of_body(rigid.size(), 0);
  unsigned int              first = 0, first_body = 0;
  for (std::size_t c = 0; c < rows.n_contacts(); ++c)
    {
      if (c > 0 && block[c] != block[c - 1])
        {
          first      = original.size();
          first_body = body_of_copy.size();
        }
      for (std::size_t e = rows.begin[2 * c]; e < rows.begin[2 * c + 2]; ++e)
        {
          const unsigned int u    = rows.entries[e].unknown;
          unsigned int      &copy = copy_of_unknown[u];
          if (copy < first || copy >= original.size() || original[copy] != u)
            {
              copy = original.size();
              original.push_back(u);
              copies_of_unknowns.push_back(unknowns[u]);
              block_of_copy.push_back(block[c]);
            }
          list.entries[e].unknown = copy;
        }
      for (int &side : list.rigid_body[c])
        if (side >= 0)
          {
            const unsigned int b    = side;
            unsigned int      &copy = copy_of_body[b];
            if (copy < first_body || copy >= body_of_copy.size() || body_of_copy[copy] != b)
              {
                copy = body_of_copy.size();
                body_of_copy.push_back(b);
                copies_of_bodies.push_back(rigid[b]);
              }
            side = copy;
          }
    }
  copies.reinit(copies_of_unknowns, block_of_copy);
}

template class BlockRows<2>;
template class BlockRows<3>;
} // namespace coracle::contact
