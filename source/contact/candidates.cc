// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/candidates.h>

namespace coracle::contact
{
void
Candidates::clear()
{
  point.clear();
  begin.assign(1, 0);
  facet.clear();
}

void
Candidates::close(const unsigned int i)
{
  if (facet.size() > begin.back())
    {
      point.push_back(i);
      begin.push_back(facet.size());
    }
}

template <int dim>
Box
facet_box(const Surface<dim> &surface, const Facet<dim> &facet, const double margin)
{
  Box box = empty_box(dim);
  for (const unsigned int node : facet.nodes)
    for (int d = 0; d < dim; ++d)
      {
        const double x = surface.nodes[node].position[d];
        box.lower[d]   = std::min(box.lower[d], x - margin);
        box.upper[d]   = std::max(box.upper[d], x + margin);
      }
  return box;
}

template Box facet_box(const Surface<2> &, const Facet<2> &, const double);
template Box facet_box(const Surface<3> &, const Facet<3> &, const double);
} // namespace coracle::contact
