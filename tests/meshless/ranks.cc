// SPDX-License-Identifier: GPL-3.0-or-later
// On any number of ranks the elements, boundary facets and surface points are those of all points
// together, to the last bit, and the pressure's matrix to round-off: points shared out in slabs, at
// random, all to one rank, and by Zoltan, which balances weights and moves columns.
#include <coracle/meshless/halo.h>
#include <coracle/meshless/partition.h>
#include <coracle/meshless/scalar_system.h>

#include "clouds.h"

using namespace clouds;
using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

/// A drop of random points beside a block of rows on a wall, all a bit apart from round numbers.
template <int dim>
PointCloud<dim>
scene()
{
  const unsigned int n     = dim == 2 ? 16 : 8;
  PointCloud<dim>    cloud = grid<dim>(n, 0.1);
  for (unsigned int i = 0; i < cloud.size(); ++i)
    if (cloud.position[i][dim - 1] < 0.05)
      cloud.kind[i] = PointKind::wall;
  perturb(cloud, 1e-13, 1);
  // Half of the block flows.
  std::mt19937_64 engine(2);
  for (auto &p : cloud.position)
    if (p[0] > 0.35)
      for (unsigned int d = 0; d < dim; ++d)
        p[d] += std::uniform_real_distribution<>(-0.04, 0.04)(engine);
  for (const auto &p : random<dim>(dim == 2 ? 150 : 400, 3).position)
    add(cloud, dealii::Point<dim>(p + 1.3 * dealii::Point<dim>::unit_vector(dim - 1)), 0.1);
  return cloud;
}

/// This rank's part of the whole.
template <int dim, typename Owner>
PointCloud<dim>
part(const PointCloud<dim> &whole, const Owner &owner)
{
  PointCloud<dim> result;
  for (unsigned int i = 0; i < whole.size(); ++i)
    if (owner(i) == mpi::rank(comm))
      {
        add(result, whole.position[i], whole.spacing[i], whole.kind[i]);
        result.id.back() = whole.id[i];
      }
  return result;
}

/// Everything about elements as ids, on all ranks; rank 0's order is that of the ids.
template <int dim>
std::vector<Element>
of_all_ranks(const PointCloud<dim> &cloud, const Tessellation<dim> &t)
{
  std::vector<Element>                    result;
  std::vector<std::vector<std::uint64_t>> nodes, simplices, facets;
  std::vector<double>                     volume;
  for (const auto &e : elements(cloud, t))
    {
      nodes.push_back(e.nodes);
      simplices.push_back(e.simplices);
      facets.push_back(e.facets);
      volume.push_back(e.volume);
    }
  const auto all = dealii::Utilities::MPI::all_gather(
    comm, std::make_pair(std::make_pair(nodes, simplices), std::make_pair(facets, volume)));
  for (const auto &[ns, fv] : all)
    for (unsigned int e = 0; e < fv.second.size(); ++e)
      result.push_back({ns.first[e], ns.second[e], fv.first[e], fv.second[e]});
  std::sort(result.begin(), result.end());
  return result;
}

/// Boundary facets by ids, and own surface points.
template <int dim>
std::multiset<std::vector<std::uint64_t>>
boundary_of_all_ranks(const PointCloud<dim> &cloud, const Tessellation<dim> &t)
{
  std::vector<std::vector<std::uint64_t>> facets;
  for (const auto &f : t.boundary_facet)
    {
      facets.emplace_back();
      for (const unsigned int node : f)
        facets.back().push_back(cloud.id[node]);
    }
  for (unsigned int i = 0; i < cloud.n_own; ++i)
    if (t.on_free_surface[i])
      facets.push_back({cloud.id[i], t.has_element[i]});
  std::multiset<std::vector<std::uint64_t>> result;
  for (const auto &list : dealii::Utilities::MPI::all_gather(comm, facets))
    result.insert(list.begin(), list.end());
  return result;
}

/// Entries of the pressure's matrix by the ids of their points, on all ranks of a communicator.
template <int dim>
std::map<std::pair<std::uint64_t, std::uint64_t>, double>
matrix_entries(const PointCloud<dim>   &cloud,
               const Tessellation<dim> &t,
               const Halo              &halo,
               const MPI_Comm           ranks)
{
  ElementRules<dim> rules;
  rules.reinit(cloud, t);
  ScalarSystem<dim> system(ranks);
  system.reinit(t, halo);
  system.assemble(t, rules, {}, 1., std::vector<unsigned char>(cloud.size(), 0));
  // Unknowns are numbered by ranks, own points in their order.
  const std::vector<std::uint64_t> mine(cloud.id.begin(), cloud.id.begin() + cloud.n_own);
  std::vector<std::uint64_t>       id;
  for (const auto &some : dealii::Utilities::MPI::all_gather(ranks, mine))
    id.insert(id.end(), some.begin(), some.end());
  std::vector<std::array<double, 3>> entries;
  const auto                        &matrix = system.get_matrix();
  for (auto row = matrix.local_range().first; row < matrix.local_range().second; ++row)
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
      entries.push_back({double(id[row]), double(id[entry->column()]), entry->value()});
  std::map<std::pair<std::uint64_t, std::uint64_t>, double> result;
  for (const auto &some : dealii::Utilities::MPI::all_gather(ranks, entries))
    for (const auto &[row, column, value] : some)
      result[{row, column}] = value;
  return result;
}

/// The same places, and the same values to 1e-12 of the largest.
template <typename Entries>
bool
are_equal(const Entries &a, const Entries &b)
{
  double largest = 0;
  for (const auto &entry : a)
    largest = std::max(largest, std::fabs(entry.second));
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [&](auto &x, auto &y) {
           return x.first == y.first && std::fabs(x.second - y.second) < 1e-12 * largest;
         });
}

template <int dim>
void
compare(const std::string         &name,
        const PointCloud<dim>     &whole,
        PointCloud<dim>            mine,
        const TessellationOptions &options)
{
  const auto together = tessellate(whole, options, MPI_COMM_SELF);
  auto       oracle   = elements(whole, together);
  std::sort(oracle.begin(), oracle.end());

  Halo halo(comm);
  halo.rebuild(mine, options.halo_width(0.1));
  const auto apart = tessellate(mine, options, comm);

  std::multiset<std::vector<std::uint64_t>> boundary;
  for (const auto &f : together.boundary_facet)
    {
      std::vector<std::uint64_t> ids;
      for (const unsigned int node : f)
        ids.push_back(whole.id[node]);
      boundary.insert(ids);
    }
  for (unsigned int i = 0; i < whole.size(); ++i)
    if (together.on_free_surface[i])
      boundary.insert({whole.id[i], together.has_element[i]});

  // Copies learn from their owners, and give back.
  std::vector<double> column(mine.n_own);
  for (unsigned int i = 0; i < mine.n_own; ++i)
    column[i] = mine.id[i] + 0.5;
  halo.update(column);
  bool known = true;
  for (unsigned int i = 0; i < mine.size(); ++i)
    known = known && column[i] == mine.id[i] + 0.5;
  std::fill(column.begin(), column.end(), 1.);
  halo.sum_to_owners(column);
  const double copies = mpi::sum(double(halo.n_copies()), comm);
  const double sums   = mpi::sum(std::accumulate(column.begin(), column.end(), 0.), comm);

  const bool   all_known = !mpi::any(!known, comm);
  const bool   same      = of_all_ranks(mine, apart) == oracle;
  const bool   same_rim  = boundary_of_all_ranks(mine, apart) == boundary;
  unsigned int polytopes = 0;
  for (unsigned int e = 0; e < together.n_elements(); ++e)
    polytopes += !together.is_simplex(e);
  Halo alone(MPI_COMM_SELF);
  auto all = whole;
  alone.rebuild(all, options.halo_width(0.1));
  const bool same_matrix = are_equal(matrix_entries(all, together, alone, MPI_COMM_SELF),
                                     matrix_entries(mine, apart, halo, comm));
  deallog << name << ' ' << dim << "-D: elements " << same << ", boundary " << same_rim
          << ", matrix " << same_matrix << ", columns "
          << (all_known && sums == whole.size() + copies) << ", merged some "
          << (polytopes > 0 && polytopes < together.n_elements()) << std::endl;
}

template <int dim>
void
balance(const PointCloud<dim> &whole)
{
  // All on the last rank to begin with, a third of the points three times as heavy.
  auto    mine = part(whole, [&](const unsigned int) { return mpi::n_ranks(comm) - 1; });
  Columns columns(2);
  columns.resize(mine.n_own);
  const auto weights = [&] {
    std::vector<double> result;
    for (unsigned int i = 0; i < mine.n_own; ++i)
      result.push_back(mine.position[i][0] < 0.5 ? 3. : 1.);
    return result;
  };
  for (unsigned int i = 0; i < mine.n_own; ++i)
    {
      columns[0][i] = mine.id[i];
      columns[1][i] = mine.position[i][0];
    }
  migrate(mine, columns, partition(mine, weights(), comm), comm);
  bool kept = mine.n_own == columns.size() && mine.size() == mine.n_own;
  for (unsigned int i = 0; i < mine.n_own; ++i)
    kept = kept && columns[0][i] == mine.id[i] && columns[1][i] == mine.position[i][0] &&
           mine.position[i] == whole.position[mine.id[i]] && mine.kind[i] == whole.kind[mine.id[i]];
  const bool   all_kept   = !mpi::any(!kept, comm);
  const double unbalanced = imbalance(weights(), comm);
  const auto   n          = mpi::sum(mine.n_own, comm);
  deallog << "Zoltan " << dim << "-D: balanced " << (unbalanced < 1.05) << ", rows kept "
          << all_kept << ", none lost " << (n == whole.size()) << std::endl;
  compare("Zoltan", whole, mine, {1.3, 1e-6});
}

template <int dim>
void
test()
{
  const auto         whole = scene<dim>();
  const unsigned int n     = mpi::n_ranks(comm);
  const auto         slabs = [&](const unsigned int i) {
    return std::min<unsigned int>(n * whole.position[i][0] / 1.5, n - 1);
  };
  for (const TessellationOptions &options : {TessellationOptions{1.3, 1e-6},
                                             TessellationOptions{1.1, 0.03},
                                             TessellationOptions{0.7, 0.1}})
    {
      compare("slabs", whole, part(whole, slabs), options);
      // Ids may be in any order against places.
      auto renumbered = shuffled(whole, 5);
      std::iota(renumbered.id.begin(), renumbered.id.end(), std::uint64_t(1) << 40);
      compare("scattered",
              renumbered,
              part(renumbered, [&](auto i) { return i * i % 7 % n; }),
              options);
      compare("one has all", whole, part(whole, [&](auto) { return n - 1; }), options);
    }
  balance(whole);
  // Rows that have moved as far as the tolerance: some merge, some do not.
  for (const double tolerance : {1e-6, 1e-3, 0.1})
    {
      auto rows = grid<dim>(dim == 2 ? 14 : 7, 0.1);
      perturb(rows, 0.1 * tolerance, 4);
      compare("near the tolerance", rows, part(rows, slabs), {1.3, tolerance});
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>();
  test<3>();
}
