// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/mesh/sheet_patches.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

namespace coracle
{
namespace
{
/// Where a facet ends: which of its corners the edge starts at.
struct FacetEdge
{
  unsigned int facet, corner;
};

template <int dim>
unsigned int
n_corners(const typename FacetList<dim>::Corners &corners)
{
  if constexpr (dim == 3)
    if (corners[3] == corners[2])
      return 3;
  return corners.size();
}

/// All facets at each edge, by the numbers of its points; in 2-D an edge is one point.
template <int dim>
std::map<std::array<unsigned int, 2>, std::vector<FacetEdge>>
find_edges(const FacetList<dim> &surface)
{
  std::map<std::array<unsigned int, 2>, std::vector<FacetEdge>> edges;
  for (unsigned int f = 0; f < surface.facets.size(); ++f)
    {
      const auto        &corners = surface.facets[f];
      const unsigned int n       = n_corners<dim>(corners);
      for (unsigned int k = 0; k < n; ++k)
        {
          const unsigned int a = corners[k], b = (dim == 2 ? a : corners[(k + 1) % n]);
          edges[{{std::min(a, b), std::max(a, b)}}].push_back({f, k});
        }
    }
  return edges;
}

/// Unit direction from an edge into a facet, across the edge.
template <int dim>
dealii::Tensor<1, dim>
inward(const FacetList<dim> &surface, const FacetEdge &edge)
{
  const auto        &corners = surface.facets[edge.facet];
  const unsigned int n       = n_corners<dim>(corners);
  const auto         point   = [&](const unsigned int k) { return surface.points[corners[k % n]]; };
  const auto         start = point(edge.corner), end = point(edge.corner + 1);
  if constexpr (dim == 2)
    return (end - start) / end.distance(start);
  else
    {
      const auto             along = (end - start) / end.distance(start);
      dealii::Tensor<1, dim> result;
      for (unsigned int k = 2; k < n; ++k)
        result += point(edge.corner + k) - start;
      result -= (result * along) * along;
      return result.norm() > 0 ? result / result.norm() : result;
    }
}

/// Do two facets pass their common edge in opposite directions, as neighbours of one orientation
/// do?
template <int dim>
bool
agree(const FacetList<dim> &surface, const FacetEdge &a, const FacetEdge &b)
{
  if (dim == 2)
    return a.corner != b.corner;
  return surface.facets[a.facet][a.corner] != surface.facets[b.facet][b.corner];
}

struct Neighbour
{
  unsigned int facet;
  bool         agrees;
};

/// At each edge the two facets that continue each other most straightly, then the next two.
template <int dim>
std::vector<std::vector<Neighbour>>
join(const FacetList<dim> &surface)
{
  std::vector<std::vector<Neighbour>> neighbours(surface.facets.size());
  for (auto &[points, edges] : find_edges(surface))
    while (edges.size() > 1)
      {
        std::pair<unsigned int, unsigned int> best(0, 1);
        double                                smallest = 2;
        for (unsigned int j = 1; j < edges.size() && edges.size() > 2; ++j)
          for (unsigned int i = 0; i < j; ++i)
            {
              const double cosine = inward(surface, edges[i]) * inward(surface, edges[j]);
              if (cosine < smallest - 1e-9)
                {
                  smallest = cosine;
                  best     = {i, j};
                }
            }
        const FacetEdge a = edges[best.first], b = edges[best.second];
        const bool      agrees = agree(surface, a, b);
        neighbours[a.facet].push_back({b.facet, agrees});
        neighbours[b.facet].push_back({a.facet, agrees});
        edges.erase(edges.begin() + best.second);
        edges.erase(edges.begin() + best.first);
      }
  return neighbours;
}

/// Other face in front; a triangle's repeated corner stays last.
template <int dim>
void
turn(typename FacetList<dim>::Corners &corners)
{
  if (dim == 2)
    std::swap(corners[0], corners[1]);
  else
    {
      const bool triangle = n_corners<dim>(corners) == 3;
      std::reverse(corners.begin(), corners.begin() + (triangle ? 3 : corners.size()));
      corners.back() = triangle ? corners[2] : corners.back();
    }
}
} // namespace

template <int dim>
std::vector<unsigned int>
join_sheets(FacetList<dim> &surface)
{
  const auto                neighbours = join(surface);
  constexpr unsigned int    none       = -1;
  std::vector<unsigned int> patch(surface.facets.size(), none);
  std::vector<char>         turned(surface.facets.size(), 0);
  unsigned int              n_patches = 0;
  for (unsigned int seed = 0; seed < patch.size(); ++seed)
    if (patch[seed] == none)
      {
        std::vector<unsigned int> stack = {seed};
        patch[seed]                     = n_patches++;
        while (!stack.empty())
          {
            const unsigned int f = stack.back();
            stack.pop_back();
            for (const Neighbour &neighbour : neighbours[f])
              {
                const bool turns = (turned[f] != 0) == neighbour.agrees;
                if (patch[neighbour.facet] == none)
                  {
                    patch[neighbour.facet]  = patch[f];
                    turned[neighbour.facet] = turns;
                    stack.push_back(neighbour.facet);
                  }
                else if ((turned[neighbour.facet] != 0) != turns)
                  {
                    std::ostringstream place;
                    place << "a path over the surface leads from one face to the other; it closes "
                             "at ("
                          << surface.points[surface.facets[f][0]] << ") m";
                    throw std::invalid_argument(place.str());
                  }
              }
          }
      }
  for (unsigned int f = 0; f < patch.size(); ++f)
    if (turned[f] != 0)
      turn<dim>(surface.facets[f]);
  return patch;
}

template std::vector<unsigned int> join_sheets(FacetList<2> &);
template std::vector<unsigned int> join_sheets(FacetList<3> &);
} // namespace coracle
