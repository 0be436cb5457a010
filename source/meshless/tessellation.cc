// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/base/mpi.h>
#include <coracle/meshless/merging.h>
#include <coracle/meshless/simplex.h>
#include <coracle/meshless/splitting.h>
#include <coracle/meshless/tessellation.h>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace coracle::meshless
{
namespace
{
template <int dim>
void
refuse_coincident(const DelaunayCells<dim> &cells, const PointCloud<dim> &points)
{
  if (cells.n_coincident == 0)
    return;
  const auto [a, b] = cells.coincident;
  std::ostringstream details;
  details << cells.n_coincident << " points of the meshless fluid are at the place of another; ids "
          << std::min(points.id[a], points.id[b]) << " and " << std::max(points.id[a], points.id[b])
          << " at (" << points.position[a] << ") m";
  throw RunFailure("points of the meshless fluid coincide",
                   details.str(),
                   "generate no point twice, also not on walls that meet, or take smaller steps");
}

/// From cells and the elements they belong to, to the tessellation.
template <int dim>
class Builder
{
public:
  Builder(const Cells<dim>           &cells,
          std::vector<unsigned int> &&element_of_cell,
          const PointCloud<dim>      &points,
          const TessellationOptions  &options)
    : cells(cells), element(std::move(element_of_cell)), points(points), options(options)
  {}

  Tessellation<dim> build()
  {
    list_members();
    select();
    sort_assembled();
    result.on_free_surface.assign(points.size(), 0);
    result.has_element.assign(points.size(), 0);
    mark_points();
    reserve();
    for (const unsigned int name : assembled)
      append(name);
    return std::move(result);
  }

private:
  using Nodes                        = std::array<unsigned int, dim + 1>;
  static constexpr unsigned int none = Cells<dim>::none;

  bool lower(const unsigned int a, const unsigned int b) const
  {
    return points.id[a] < points.id[b];
  }

  /// Cells by element: those of the element named c are member[first[c]] to member[first[c + 1]].
  void list_members()
  {
    first.assign(cells.size() + 1, 0);
    for (const unsigned int e : element)
      if (e != none)
        ++first[e + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    member.resize(first.back());
    std::vector<unsigned int> next(first.begin(), first.end() - 1);
    for (unsigned int c = 0; c < cells.size(); ++c)
      if (element[c] != none)
        member[next[element[c]]++] = c;
  }

  /// The nodes of an element by rising id.
  void collect_nodes(const unsigned int name)
  {
    if (first[name + 1] == first[name] + 1)
      {
        // By far the most, and sorted but for the last two.
        const Nodes &cell = cells.node[member[first[name]]];
        nodes.assign(cell.begin(), cell.end());
        if (lower(nodes[dim], nodes[dim - 1]))
          std::swap(nodes[dim], nodes[dim - 1]);
        return;
      }
    nodes.clear();
    for (unsigned int m = first[name]; m < first[name + 1]; ++m)
      nodes.insert(nodes.end(), cells.node[member[m]].begin(), cells.node[member[m]].end());
    std::sort(nodes.begin(), nodes.end(), [&](const auto a, const auto b) { return lower(a, b); });
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }

  bool is_kept(const unsigned int name) const
  {
    // The largest sphere: which cell gives the element its name depends on the order of points.
    // Slivers count only where they are alone.
    double     radius = 0., spacing = 0.;
    const bool alone = first[name + 1] - first[name] == 1;
    for (unsigned int m = first[name]; m < first[name + 1]; ++m)
      if (alone || !cells.is_sliver[member[m]])
        radius = std::max(radius, cells.radius[member[m]]);
    if (alone && cells.is_sliver[name])
      radius = 0.; // decided in merge_cells
    bool has_fluid = false;
    for (const unsigned int node : nodes)
      {
        spacing += points.spacing[node];
        has_fluid = has_fluid || points.kind[node] == PointKind::fluid;
      }
    return has_fluid && radius <= options.alpha * spacing / nodes.size();
  }

  /// Drop elements that are too large or all wall, and find those that this rank assembles.
  void select()
  {
    kept.assign(cells.size(), false);
    for (unsigned int c = 0; c < cells.size(); ++c)
      if (first[c + 1] > first[c])
        {
          collect_nodes(c);
          kept[c] = is_kept(c);
          if (kept[c] && nodes[0] < points.n_own)
            assembled.push_back(c);
        }
  }

  bool before(const unsigned int a, const unsigned int b) const
  {
    for (unsigned int i = 0; i < dim; ++i)
      if (cells.node[a][i] != cells.node[b][i])
        return lower(cells.node[a][i], cells.node[b][i]);
    return lower(cells.node[a][dim], cells.node[b][dim]);
  }

  /// By the ids of their cells' nodes; first by the lowest, of which there are few each.
  void sort_assembled()
  {
    const auto by_cells = [&](const auto a, const auto b) { return before(a, b); };
    for (const unsigned int name : assembled)
      if (first[name + 1] > first[name] + 1)
        std::sort(member.begin() + first[name], member.begin() + first[name + 1], by_cells);

    std::vector<unsigned int> row(points.n_own), place(points.n_own);
    std::iota(row.begin(), row.end(), 0u);
    const auto by_id = [&](const auto a, const auto b) { return lower(a, b); };
    if (!std::is_sorted(row.begin(), row.end(), by_id))
      std::sort(row.begin(), row.end(), by_id);
    for (unsigned int i = 0; i < row.size(); ++i)
      place[row[i]] = i;

    const auto place_of = [&](const unsigned int name) {
      return place[cells.node[member[first[name]]][0]];
    };
    std::vector<unsigned int> end(points.n_own + 1, 0), sorted(assembled.size());
    for (const unsigned int name : assembled)
      ++end[place_of(name) + 1];
    std::partial_sum(end.begin(), end.end(), end.begin());
    const std::vector<unsigned int> begin = end;
    for (const unsigned int name : assembled)
      sorted[end[place_of(name)]++] = name;
    for (unsigned int i = 0; i < points.n_own; ++i)
      std::sort(sorted.begin() + begin[i],
                sorted.begin() + end[i],
                [&](const unsigned int a, const unsigned int b) {
                  return before(member[first[a]], member[first[b]]);
                });
    assembled = std::move(sorted);
  }

  bool is_kept_cell(const unsigned int c) const
  {
    return c != none && element[c] != none && kept[element[c]];
  }

  void mark_points()
  {
    for (unsigned int c = 0; c < cells.size(); ++c)
      if (is_kept_cell(c))
        for (unsigned int i = 0; i <= dim; ++i)
          {
            result.has_element[cells.node[c][i]] = 1;
            if (!is_kept_cell(cells.neighbor[c][i]))
              for (const unsigned int node : facet_of<dim>(cells.node[c], i))
                result.on_free_surface[node] = 1;
          }
    for (unsigned int i = 0; i < points.size(); ++i)
      if (points.kind[i] == PointKind::wall)
        result.on_free_surface[i] = 0;
      else if (!result.has_element[i])
        result.on_free_surface[i] = 1;
  }

  void reserve()
  {
    std::size_t n_cells = 0, n_merged = 0;
    for (const unsigned int name : assembled)
      {
        const unsigned int n = first[name + 1] - first[name];
        n_cells += n;
        n_merged += n > 1 ? n : 0;
      }
    result.node.reserve(assembled.size() * (dim + 1) + n_merged);
    result.simplex.reserve(n_cells);
    result.facet.reserve(n_merged * (dim + 1));
    result.volume.reserve(assembled.size());
    for (auto *offsets : {&result.first_node, &result.first_simplex, &result.first_facet})
      offsets->reserve(assembled.size() + 1);
  }

  void append(const unsigned int name)
  {
    collect_nodes(name);
    result.node.insert(result.node.end(), nodes.begin(), nodes.end());
    double volume = 0.;
    beyond_facet.clear();
    for (unsigned int m = first[name]; m < first[name + 1]; ++m)
      {
        const unsigned int c = member[m];
        volume += cells.volume[c];
        // A sliver has hardly an inside, and shape functions change across it from those of one
        // facet to those of two.
        if (!cells.is_sliver[c] || first[name + 1] == first[name] + 1)
          result.simplex.push_back(cells.node[c]);
        for (unsigned int i = 0; i <= dim; ++i)
          append_facet(name, c, i);
      }
    append_faces();
    result.volume.push_back(volume);
    result.first_node.push_back(result.node.size());
    result.first_simplex.push_back(result.simplex.size());
    result.first_facet.push_back(result.facet.size());
  }

  void append_facet(const unsigned int name, const unsigned int c, const unsigned int i)
  {
    const unsigned int beyond = cells.neighbor[c][i];
    if (beyond != none && element[beyond] == name)
      return;
    const auto facet = facet_of<dim>(cells.node[c], i);
    if (nodes.size() > dim + 1)
      {
        result.facet.push_back(facet);
        beyond_facet.push_back(!is_kept_cell(beyond) ? none : element[beyond]);
      }
    if (!is_kept_cell(beyond))
      {
        result.boundary_facet.push_back(facet);
        result.boundary_element.push_back(result.volume.size());
      }
  }

  bool is_simplex(const unsigned int name) const
  {
    return name != none && first[name + 1] == first[name] + 1;
  }

  /// Which of the facets just appended are one face? Not those towards a sliver, linear on each.
  void append_faces()
  {
    const unsigned int begin = result.face.size(), n = result.facet.size() - begin;
    for (unsigned int f = 0; f < n; ++f)
      result.face.push_back(f);
    if (dim == 2)
      return; // nothing to look for
    const auto face = result.face.begin() + begin;
    for (bool changed = true; changed;)
      {
        changed = false;
        for (unsigned int f = 0; f < n; ++f)
          for (unsigned int g = 0; g < n; ++g)
            if (face[f] < face[g] && beyond_facet[f] == beyond_facet[g] &&
                !is_simplex(beyond_facet[f]) &&
                in_one_plane(result.facet[begin + f], result.facet[begin + g]))
              {
                face[g] = face[f];
                changed = true;
              }
      }
  }

  /// Do two triangles share an edge, and are they so flat that between them there is but a sliver?
  bool in_one_plane(const std::array<unsigned int, dim> &a,
                    const std::array<unsigned int, dim> &b) const
  {
    std::array<dealii::Point<dim>, dim>     x, y;
    std::array<dealii::Point<dim>, dim + 1> all;
    unsigned int                            n_shared = 0;
    double                                  spacing  = 0.;
    for (unsigned int i = 0; i < dim; ++i)
      {
        all[i] = x[i] = points.position[a[i]];
        y[i]          = points.position[b[i]];
        spacing += points.spacing[a[i]] / dim;
        if (std::find(a.begin(), a.end(), b[i]) != a.end())
          ++n_shared;
        else
          all[dim] = y[i];
      }
    return n_shared == dim - 1 && normal_of(x) * normal_of(y) > 0. &&
           least_height<dim>(all) <= options.merge_tolerance * spacing;
  }

  const Cells<dim>               &cells;
  const std::vector<unsigned int> element;
  const PointCloud<dim>          &points;
  const TessellationOptions      &options;

  std::vector<unsigned int> first, member, assembled, nodes, beyond_facet;
  std::vector<bool>         kept;
  Tessellation<dim>         result;
};
} // namespace

template <int dim>
Tessellation<dim>
tessellate(const PointCloud<dim> &points, const TessellationOptions &options, const MPI_Comm comm)
{
  auto delaunay_cells = delaunay(points.position);
  mpi::agree([&] { refuse_coincident(delaunay_cells, points); }, comm);

  const Cells<dim> cells = arrange(std::move(delaunay_cells), points, options);
  const double     spacing =
    points.size() == 0 ? 0. : *std::max_element(points.spacing.begin(), points.spacing.end());
  const double largest_radius = (options.alpha + options.merge_tolerance) * spacing;
  auto         element        = merge_cells(cells, points, options, largest_radius);
  split_dented(cells, points, options, element);
  return Builder<dim>(cells, std::move(element), points, options).build();
}

template Tessellation<2>
tessellate(const PointCloud<2> &, const TessellationOptions &, const MPI_Comm);
template Tessellation<3>
tessellate(const PointCloud<3> &, const TessellationOptions &, const MPI_Comm);
} // namespace coracle::meshless
