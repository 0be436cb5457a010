// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/structure/selection.h>

#include <algorithm>
#include <sstream>

namespace coracle
{
template <int dim>
void
Selection<dim>::declare(Declaration &section)
{
  section.integer("Boundary id",
                  -1,
                  "number of the part of the boundary, see Mesh/Type; -1 for any",
                  -1,
                  1000000);
  section.list(
    "Region",
    "",
    "m",
    "",
    "box in the unloaded configuration: lower corner, upper corner; empty for everywhere");
}

template <int dim>
Selection<dim>::Selection(const Parameters &section, const bool everything_allowed)
  : section(section), boundary_id(section.integer("Boundary id")), box(section.list("Region"))
{
  if (!box.empty() && box.size() != 2 * dim)
    throw section.error("Region",
                        "wrong number of coordinates",
                        std::to_string(box.size()) + " of them",
                        "give lower and upper corner, " + std::to_string(2 * dim) + " numbers");
  if (box.empty() && boundary_id < 0 && !everything_allowed)
    throw section.error("",
                        "condition without a place",
                        "neither Boundary id nor Region",
                        "set Boundary id, Region, or both");
  double size = 0;
  for (const double x : box)
    size = std::max(size, std::fabs(x));
  for (std::size_t i = 0; i < box.size(); ++i)
    box[i] += (i < dim ? -1e-9 : 1e-9) * size;
}

template <int dim>
bool
Selection<dim>::is_inside(const dealii::Point<dim> &p) const
{
  if (!box.empty())
    for (int d = 0; d < dim; ++d)
      if (p[d] < box[d] || p[d] > box[dim + d])
        return false;
  return true;
}

template <int dim>
std::vector<unsigned int>
Selection<dim>::facets(const StructureMesh<dim> &mesh) const
{
  std::vector<unsigned int> result;
  for (unsigned int f = 0; f < mesh.facets.size(); ++f)
    {
      const auto &facet = mesh.facets[f];
      if ((boundary_id < 0 || facet.boundary_id == static_cast<unsigned int>(boundary_id)) &&
          std::all_of(facet.nodes.begin(), facet.nodes.end(), [&](const unsigned int n) {
            return is_inside(mesh.nodes[n]);
          }))
        result.push_back(f);
    }
  if (!mpi::any(!result.empty(), mesh.communicator()))
    throw section.error("",
                        "condition that acts on nothing",
                        "no face of the boundary is selected",
                        "check Boundary id and Region against the mesh");
  return result;
}

template <int dim>
std::vector<unsigned int>
Selection<dim>::nodes(const StructureMesh<dim> &mesh) const
{
  Columns selected(1);
  selected.resize(mesh.n_nodes());
  if (boundary_id < 0)
    std::fill_n(selected[0], mesh.n_nodes(), 1.);
  for (const auto &facet : mesh.facets)
    if (facet.boundary_id == static_cast<unsigned int>(boundary_id))
      for (const unsigned int n : facet.nodes)
        selected[0][n] = 1;
  mesh.exchange.sum_to_owners(selected, 0, 1);
  mesh.exchange.update_ghosts(selected, 0, 1);

  std::vector<unsigned int> result;
  for (unsigned int n = 0; n < mesh.n_nodes(); ++n)
    if (selected[0][n] > 0 && is_inside(mesh.nodes[n]))
      result.push_back(n);
  if (!mpi::any(!result.empty(), mesh.communicator()))
    throw section.error("",
                        "condition that acts on nothing",
                        "no node is selected",
                        "check Boundary id and Region against the mesh");
  return result;
}

std::set<std::string>
read_words(const Parameters               &section,
           const std::string              &entry,
           const std::vector<std::string> &allowed)
{
  std::string text = section.text(entry);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream    stream(text);
  std::set<std::string> words;
  for (std::string word; stream >> word;)
    {
      if (std::find(allowed.begin(), allowed.end(), word) == allowed.end())
        {
          std::string list;
          for (const std::string &a : allowed)
            list += (list.empty() ? "" : ", ") + a;
          throw section.error(entry, "unknown word", "'" + word + "'", "use some of " + list);
        }
      words.insert(word);
    }
  return words;
}

template class Selection<2>;
template class Selection<3>;
} // namespace coracle
