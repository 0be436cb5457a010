// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/mesh/sheet_mesh.h>
#include <coracle/mesh/sheet_patches.h>

#include <algorithm>
#include <stdexcept>

namespace coracle
{
namespace
{
constexpr unsigned int none = -1;
}

template <int dim>
SheetMesh<dim>::SheetMesh(const Parameters &section, MPI_Comm comm)
{
  FacetList<dim> surface = generate_sheets<dim>(section);
  try
    {
      patch_of_facet = join_sheets(surface);
    }
  catch (const std::invalid_argument &reason)
    {
      throw section.error("Type",
                          "sheet whose faces cannot be told apart",
                          reason.what(),
                          "cut the surface there, or make two bodies of it");
    }
  for (const unsigned int patch : patch_of_facet)
    n_patches = std::max(n_patches, patch + 1);
  n_global_facets = surface.facets.size();
  renumber(surface);
  distribute(surface, comm);
}

template <int dim>
void
SheetMesh<dim>::renumber(FacetList<dim> &surface)
{
  std::vector<unsigned int>       number(surface.points.size(), none);
  std::vector<dealii::Point<dim>> points;
  for (auto &corners : surface.facets)
    for (unsigned int &corner : corners)
      {
        if (number[corner] == none)
          {
            number[corner] = points.size();
            points.push_back(surface.points[corner]);
          }
        corner = number[corner];
      }
  surface.points.swap(points);
}

template <int dim>
void
SheetMesh<dim>::distribute(const FacetList<dim> &surface, MPI_Comm comm)
{
  const std::uint64_t n_facets = surface.facets.size(), n_ranks = mpi::n_ranks(comm),
                      me    = mpi::rank(comm);
  const std::uint64_t begin = n_facets * me / n_ranks, end = n_facets * (me + 1) / n_ranks;

  // Numbers count first meetings, so that what a rank meets first is a range.
  const auto points_before = [&](const std::uint64_t facet) {
    unsigned int n = 0;
    for (std::uint64_t f = 0; f < facet; ++f)
      for (const unsigned int corner : surface.facets[f])
        n = std::max(n, corner + 1);
    return n;
  };
  const unsigned int first = points_before(begin), last = points_before(end);
  dealii::IndexSet   owned(surface.points.size()), ghosts(surface.points.size());
  owned.add_range(first, last);
  for (std::uint64_t f = begin; f < end; ++f)
    for (const unsigned int corner : surface.facets[f])
      if (corner < first)
        ghosts.add_index(corner);
  this->exchange = ColumnExchange(owned, ghosts, comm);

  const auto &indices = *this->exchange.indices();
  this->nodes.resize(this->n_nodes());
  for (unsigned int n = 0; n < this->n_nodes(); ++n)
    this->nodes[n] = surface.points[indices.local_to_global(n)];
  for (std::uint64_t f = begin; f < end; ++f)
    {
      BoundaryFacet<dim> facet{{}, static_cast<unsigned int>(f - begin), 0, f, patch_of_facet[f]};
      for (unsigned int k = 0; k < nodes_per_facet; ++k)
        facet.nodes[k] = indices.global_to_local(surface.facets[f][k]);
      this->facets.push_back(facet);
      Corners cell = facet.nodes;
      if constexpr (dim == 3)
        std::swap(cell[2], cell[3]);
      output_cells.push_back(cell);
    }
}

template class SheetMesh<2>;
template class SheetMesh<3>;
} // namespace coracle
