// SPDX-License-Identifier: GPL-3.0-or-later
// The three global searches give identical candidates, whatever the sizes and places of facets and
// points, and contacts depend neither on the search nor on the order of facets nor on ranks.

#include <algorithm>
#include <numeric>

#include "scene.h"

using namespace scene;

constexpr std::array<Search, 3> all_searches{
  {Search::aabb_tree, Search::bucket, Search::all_pairs}};

class Random
{
public:
  double operator()(const double lower, const double upper)
  {
    return lower + (upper - lower) * (generator() / 4294967296.);
  }
  template <int dim>
  dealii::Point<dim> point(const double lower, const double upper)
  {
    dealii::Point<dim> x;
    for (int d = 0; d < dim; ++d)
      x[d] = (*this)(lower, upper);
    return x;
  }

private:
  std::mt19937 generator{20};
};

/// Loose facets of sizes from `smallest` to `largest`, evenly in the logarithm.
template <int dim>
Surface<dim>
loose_facets(Random &random, const unsigned int n, const double smallest, const double largest)
{
  auto surface = one_body<dim>(SurfaceKind::closed, 0.001);
  for (unsigned int f = 0; f < n; ++f)
    {
      const double size   = smallest * std::pow(largest / smallest, random(0, 1));
      const auto   centre = random.point<dim>(0, 1);
      std::array<unsigned int, vertices_per_facet<dim>> nodes;
      for (auto &node : nodes)
        node = add_node<dim>(surface, centre + size * random.point<dim>(-0.5, 0.5));
      add_facet<dim>(surface, nodes);
    }
  return surface;
}

template <int dim>
Points<dim>
loose_points(Random &random, const unsigned int n, const double lower, const double upper)
{
  Points<dim> points;
  for (unsigned int i = 0; i < n; ++i)
    points.add(random.point<dim>(lower, upper), dealii::Tensor<1, dim>(), i % 11 == 3 ? 0. : 1.);
  return points;
}

/// Facets along the faces of a lattice of `n` cells, and points at its nodes: with a reach of
/// nothing everything lies on faces of buckets.
template <int dim>
void
make_lattice(const unsigned int n, Surface<dim> &surface, Points<dim> &points)
{
  surface = one_body<dim>(SurfaceKind::closed);
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j <= n; ++j)
      {
        const double x = i / double(n), y = j / double(n), next = (i + 1) / double(n);
        std::array<unsigned int, vertices_per_facet<dim>> nodes;
        if constexpr (dim == 2)
          nodes = {{add_node<2>(surface, {x, y}), add_node<2>(surface, {next, y})}};
        else
          nodes = {{add_node<3>(surface, {x, y, 0}),
                    add_node<3>(surface, {next, y, 0}),
                    add_node<3>(surface, {next, y, 1}),
                    add_node<3>(surface, {x, y, 1})}};
        add_facet<dim>(surface, nodes);
        dealii::Point<dim> place;
        place[0]       = x;
        place[1]       = y;
        place[dim - 1] = y;
        points.add(place, {});
      }
  dealii::Point<dim> corner;
  for (int d = 0; d < dim; ++d)
    corner[d] = 1;
  points.add(corner, {});
}

/// Are the candidates the same, and how many are there?
template <int dim>
std::pair<bool, std::size_t>
compare(const Surface<dim> &surface, std::vector<PointSet<dim>> &sets, const double reach)
{
  bool              same = true;
  std::size_t       n    = 0;
  GlobalSearch<dim> oracle(Search::all_pairs);
  oracle.rebuild(surface, sets, reach);
  for (const Search method : all_searches)
    {
      GlobalSearch<dim> search(method);
      // Twice: nothing of an earlier search may stay.
      search.rebuild(surface, {sets.back()}, 2 * reach + 0.1);
      search.rebuild(surface, sets, reach);
      n = 0;
      for (unsigned int s = 0; s < sets.size(); ++s)
        {
          const Candidates &a = oracle.candidates(s), &b = search.candidates(s);
          same = same && a.point == b.point && a.begin == b.begin && a.facet == b.facet;
          n += b.facet.size();
        }
    }
  return {same, n};
}

template <int dim>
void
test_candidates()
{
  Random             random;
  bool               same  = true;
  const unsigned int n     = (dim == 2 ? 150 : 100);
  std::size_t        pairs = 0;
  // Facets alike; of very different sizes; far larger, far smaller than all distances.
  const std::array<std::array<double, 2>, 4> sizes{
    {{{0.05, 0.1}}, {{1e-6, 2}}, {{3, 5}}, {{1e-9, 1e-8}}}};
  for (const auto &[smallest, largest] : sizes)
    for (unsigned int trial = 0; trial < 6; ++trial)
      {
        const auto surface = loose_facets<dim>(random, n, smallest, largest);
        auto       near    = loose_points<dim>(random, 300, -0.2, 1.2),
             far           = loose_points<dim>(random, 50, 5, 6);
        Points<dim>         none;
        std::vector<double> radii(near.size());
        for (auto &r : radii)
          r = 1e-4 * std::pow(1e3, random(0, 1));
        std::vector<PointSet<dim>> sets = {near.set(), none.set(), far.set()};
        sets[0].mass                    = near.mass.data();
        sets[0].radius_column           = radii.data();
        if (trial % 2)
          sets[0].group_begin = {4, 20, 20, 150, 280};
        const auto result = compare(surface, sets, trial % 3 * 0.02);
        same              = same && result.first;
        pairs += result.second;
      }
  deallog << "random scenes: identical " << same << ", more than 1000 pairs " << (pairs > 1000)
          << std::endl;

  // Eighths are exact in binary: there the number of pairs is known; sevenths are rounded.
  bool same_on_faces = true;
  for (const unsigned int n_cells : {7, 8})
    for (const double reach : {0., 0.0625, 1. / n_cells})
      {
        Surface<dim> surface;
        Points<dim>  points;
        make_lattice(n_cells, surface, points);
        std::vector<PointSet<dim>> sets   = {points.set()};
        const auto                 result = compare(surface, sets, reach);
        same_on_faces                     = same_on_faces && result.first;
        if (n_cells == 8)
          deallog << "points on faces of buckets: pairs " << result.second << std::endl;
      }
  deallog << "identical " << same_on_faces << std::endl;
  Points<dim> one;
  one.add({}, {});
  std::vector<PointSet<dim>> sets      = {one.set()};
  const auto                 no_facets = one_body<dim>(SurfaceKind::closed);
  deallog << "no facets: identical " << compare(no_facets, sets, 1.).first << ", pairs "
          << compare(no_facets, sets, 1.).second << std::endl;
}

/// A contact by what stays the same however facets are numbered.
template <int dim>
struct Found
{
  std::uint64_t          id, facet;
  double                 gap;
  dealii::Tensor<1, dim> normal;

  bool operator<(const Found &other) const
  {
    return std::make_tuple(id, facet, gap) < std::make_tuple(other.id, other.facet, other.gap);
  }
  bool operator==(const Found &other) const
  {
    return id == other.id && facet == other.facet && gap == other.gap && normal == other.normal;
  }
};

/// A wavy sheet in space, a zigzag in the plane.
template <int dim>
Surface<dim>
wavy_sheet()
{
  auto sheet = one_body<dim>(SurfaceKind::sheet, 0.01);
  if constexpr (dim == 2)
    {
      std::vector<dealii::Point<2>> places;
      for (unsigned int i = 0; i <= 40; ++i)
        places.emplace_back(0.025 * i, 0.02 * std::sin(2. * i));
      add_polyline(sheet, places, false);
    }
  else
    add_sheet(sheet, 10, 10, [](const unsigned int i, const unsigned int j) {
      return dealii::Point<3>(0.1 * i, 0.1 * j, 0.02 * std::sin(2. * i + 3. * j));
    });
  return sheet;
}

/// The contacts of all ranks where rank r has every n-th facet, numbered in a random order, and
/// every n-th point of a cloud around the sheet and on its nodes.
template <int dim>
std::vector<Found<dim>>
contacts(const Search search, const unsigned int seed, MPI_Comm comm)
{
  const unsigned int rank         = dealii::Utilities::MPI::this_mpi_process(comm),
                     n            = dealii::Utilities::MPI::n_mpi_processes(comm);
  const auto                whole = wavy_sheet<dim>();
  std::vector<unsigned int> order(whole.nodes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937 shuffle(seed);
  if (seed > 0)
    std::shuffle(order.begin(), order.end(), shuffle);
  Surface<dim> part = whole;
  part.facets.clear();
  for (unsigned int i = 0; i < order.size(); ++i)
    {
      part.nodes[order[i]]       = whole.nodes[i];
      part.nodes[order[i]].owner = i % n;
    }
  for (const auto &facet : whole.facets)
    if (facet.key % n == rank)
      {
        part.facets.push_back(facet);
        for (auto &node : part.facets.back().nodes)
          node = order[node];
      }
  if (seed > 0)
    std::shuffle(part.facets.begin(), part.facets.end(), shuffle);

  Random                     random;
  Points<dim>                points;
  std::vector<std::uint64_t> ids;
  points.radius = 0.02;
  for (unsigned int i = 0; i < 400; ++i)
    {
      auto x     = random.point<dim>(0, 1);
      x[dim - 1] = random(-0.08, 0.08);
      if (i % 8 == 0)
        {
          x = whole.nodes[i % whole.nodes.size()].position;
          x[dim - 1] += 0.015;
        }
      if (i / 5 % n == rank)
        {
          points.add(x, {});
          ids.push_back(i);
        }
    }
  ContactOptions options;
  options.search = search;
  ContactSystem<dim>         system(options, comm);
  std::vector<PointSet<dim>> sets = {points.set()};
  sets[0].ids                     = ids.data();
  system.find(part, sets, 1e-3);
  std::vector<Found<dim>> result;
  for (const auto &c : system.contacts())
    result.push_back({ids[c.point], system.surface().facets[c.facet].key, c.gap, c.normal});
  std::vector<Found<dim>> all;
  const int               bytes = result.size() * sizeof(Found<dim>);
  std::vector<int>        counts(n), begins(n + 1);
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::partial_sum(counts.begin(), counts.end(), begins.begin() + 1);
  all.resize(begins.back() / sizeof(Found<dim>));
  MPI_Allgatherv(
    result.data(), bytes, MPI_BYTE, all.data(), counts.data(), begins.data(), MPI_BYTE, comm);
  std::sort(all.begin(), all.end());
  return all;
}

template <int dim>
void
test_contacts()
{
  const auto reference = contacts<dim>(Search::all_pairs, 0, MPI_COMM_SELF);
  bool       same      = true;
  for (const Search search : all_searches)
    for (unsigned int seed = 0; seed < 4; ++seed)
      same = same && contacts<dim>(search, seed, MPI_COMM_WORLD) == reference;
  deallog << "contacts of a wavy sheet: more than 100 " << (reference.size() > 100)
          << ", independent of search, order of facets and ranks " << same << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test_candidates<2>();
  test_contacts<2>();
  deallog.pop();
  deallog.push("3d");
  test_candidates<3>();
  test_contacts<3>();
  deallog.pop();
}
