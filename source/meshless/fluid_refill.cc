// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/meshless/fluid.h>

#include <map>
#include <set>

namespace coracle::meshless
{
namespace
{
/// Calls action(i, j) for the pairs of nodes of each element.
template <int dim, typename Action>
void
for_each_pair(const Tessellation<dim> &mesh, const Action &action)
{
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    for (unsigned int i = mesh.first_node[e]; i < mesh.first_node[e + 1]; ++i)
      for (unsigned int j = mesh.first_node[e]; j < i; ++j)
        action(mesh.node[i], mesh.node[j], e);
}

unsigned int
n_faces(const unsigned int walls)
{
  unsigned int n = 0;
  for (unsigned int rest = walls; rest > 0; rest &= rest - 1)
    ++n;
  return n;
}

} // namespace

/// An edge of an element that is too long; ids as doubles, so that edges travel.
template <int dim>
struct Fluid<dim>::LongEdge
{
  double                      length_square = 0;
  std::array<double, 2>       ids{};
  std::array<unsigned int, 2> rows{};
  unsigned int                rank = 0;

  /// The longest first, ids decide ties, and so does the rank among edges found by several.
  std::array<double, 4> key() const { return {-length_square, ids[0], ids[1], double(rank)}; }
};

template <int dim>
void
Fluid<dim>::new_positions(std::vector<dealii::Point<dim>> &x) const
{
  x.resize(points.n_own);
  for (std::size_t i = 0; i < n_cloud; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      x[i][d] = columns[Layout::position + d][i];
  for (std::size_t i = n_cloud; i < points.n_own; ++i)
    x[i] = points.position[i] + last_dt * moving[i];
  halo.update_positions(x);
}

template <int dim>
void
Fluid<dim>::refill()
{
  const std::size_t          n_before = n_cloud;
  std::vector<unsigned char> taken_out(n_before, 0);
  stay_on_structures();
  find_strays(taken_out);
  find_corner_twins(taken_out);
  std::vector<dealii::Point<dim>> x;
  new_positions(x);
  find_slid_together(taken_out);
  find_inside(x, taken_out);
  if (options.refill.enabled)
    {
      find_crowded(x, taken_out);
      insert(x);
    }
  taken_out.resize(columns.size(), 0);
  std::vector<unsigned int> kept;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (!taken_out[i])
      kept.push_back(i);
  if (kept.size() < columns.size())
    {
      columns.reorder(kept);
      columns.resize(kept.size());
    }
}

// Points beyond open faces.
template <int dim>
void
Fluid<dim>::find_strays(std::vector<unsigned char> &taken_out)
{
  std::uint64_t n       = 0;
  const auto    corners = options.box.get_boundary_points();
  for (std::size_t i = 0; i < n_cloud; ++i)
    for (unsigned int d = 0; d < dim && !taken_out[i]; ++d)
      if (const double x = columns[Layout::position + d][i];
          !period.along(d) && (x < corners.first[d] || x > corners.second[d]))
        {
          taken_out[i] = 1;
          ++n;
        }
  counts.left += mpi::sum(n, comm);
}

// Two points that slid into the same corner are at the same place: the older one stays.
template <int dim>
void
Fluid<dim>::find_corner_twins(std::vector<unsigned char> &taken_out)
{
  std::vector<std::array<double, 2>> here;
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (n_faces(columns[Layout::walls][i]) == dim)
      here.push_back({columns[Layout::walls][i], columns[Layout::id][i]});
  std::map<double, double> first;
  std::uint64_t            n = 0;
  for (const auto &there : dealii::Utilities::MPI::all_gather(comm, here))
    for (const auto &[corner, id] : there)
      {
        const auto [place, is_new] = first.emplace(corner, id);
        n += !is_new;
        place->second = std::min(place->second, id);
      }
  counts.taken_out += n;
  if (n > 0)
    for (std::size_t i = 0; i < n_cloud; ++i)
      if (n_faces(columns[Layout::walls][i]) == dim)
        taken_out[i] |= columns[Layout::id][i] != first.at(columns[Layout::walls][i]);
}

/**
 * Of two points too near to each other, that outside of regions goes, then that on fewer faces of
 * the box, then that inside the fluid, then the younger one; the fluid's outline stays as it is, so
 * that no volume is lost. Nor may a point be so near to a wall that the flat elements between have
 * too large spheres.
 */
template <int dim>
void
Fluid<dim>::find_crowded(const std::vector<dealii::Point<dim>> &x,
                         std::vector<unsigned char>            &taken_out)
{
  std::vector<double> marks(points.size());
  const auto          rank_of = [this](const unsigned int i) {
    return std::array<double, 4>{double(region[i] > 0),
                                 is_structure(i) ? dim + 1.
                                                          : double(n_faces(walls[i]) + is_sliding(i)),
                                 double(free_surface[i]),
                                 -double(points.id[i])};
  };
  for_each_pair(mesh, [&](const unsigned int i, const unsigned int j, const unsigned int) {
    const double h     = 0.5 * (points.spacing[i] + points.spacing[j]),
                 share = free_surface[i] && free_surface[j] ? 0.9 : 1.;
    if (x[i].distance_square(x[j]) > std::pow(share * options.refill.nearest * h, 2))
      return;
    const unsigned int loser = rank_of(i) < rank_of(j) ? i : j;
    // A corner may be all that holds the fluid's outline there.
    if (!is_structure(loser) && (n_faces(walls[loser]) < dim || is_sliding(loser)) &&
        (!free_surface[loser] || share < 1))
      marks[loser] += 1;
  });
  find_flattened(x, marks);
  find_near_structures(x, marks);
  find_encroaching(x, marks);
  halo.sum_to_owners(marks);
  std::uint64_t n       = 0;
  const auto    corners = options.box.get_boundary_points();
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      bool goes = marks[i] > 0;
      if (!free_surface[i] && !isolated[i] && region[i] == 0)
        for (unsigned int face = 0; face < 2 * dim; ++face)
          {
            const double place = face % 2 == 0 ? corners.first[face / 2] : corners.second[face / 2];
            goes |= options.walls[face] != Wall::open &&
                    !(static_cast<unsigned int>(columns[Layout::walls][i]) >> face & 1) &&
                    std::fabs(x[i][face / 2] - place) <
                      options.refill.nearest_to_wall * points.spacing[i];
          }
      if (goes && !taken_out[i])
        {
          taken_out[i] = 1;
          ++n;
        }
    }
  counts.taken_out += mpi::sum(n, comm);
}

// The longest edge of each element here, where it is too long.
template <int dim>
typename Fluid<dim>::LongEdges
Fluid<dim>::find_long_edges(const std::vector<dealii::Point<dim>> &x) const
{
  // Nothing is put into strands and sheets of one element: they tear.
  std::vector<unsigned char> inside(mesh.n_elements(), 0);
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    for (unsigned int i = mesh.first_node[e]; i < mesh.first_node[e + 1]; ++i)
      inside[e] |= !free_surface[mesh.node[i]];
  const double shortest =
    std::min(options.refill.longest_boundary_edge, options.refill.longest_edge);
  std::map<unsigned int, LongEdge> by_element;
  for_each_pair(mesh, [&](const unsigned int i, const unsigned int j, const unsigned int e) {
    const double h             = 0.5 * (points.spacing[i] + points.spacing[j]);
    const double length_square = x[i].distance_square(x[j]);
    // By far the most: nothing is looked up for them.
    if (!inside[e] || length_square < std::pow(shortest * h, 2))
      return;
    const bool along = is_along_structure(i, j, x);
    if (is_on_structure(i) && is_on_structure(j) && !along)
      return;
    // Towards a corner above the water the surface would climb.
    if ((is_structure(i) && at_surface[i] && is_sliding(j)) ||
        (is_structure(j) && at_surface[j] && is_sliding(i)))
      return;
    // In space a diagonal of a region's cubes at the surface is no edge of the outline.
    const bool in_region = region[i] > 0 && region[i] == region[j];
    const bool on_boundary =
      (walls[i] & walls[j]) || (free_surface[i] && free_surface[j] && !in_region) || along;
    const double limit =
      on_boundary ? options.refill.longest_boundary_edge : options.refill.longest_edge;
    if (length_square < std::pow(limit * h, 2))
      return;
    // Across an edge of a body.
    if ((is_on_structure(i) || is_on_structure(j)) && !along &&
        structures.contains(x[i] + 0.5 * (x[j] - x[i])))
      return;
    const bool in_order = points.id[i] < points.id[j];
    LongEdge   edge{length_square,
                  {double(points.id[in_order ? i : j]), double(points.id[in_order ? j : i])},
                  {i, j},
                  mpi::rank(comm)};
    auto      &longest = by_element[e];
    if (longest.length_square == 0 || edge.key() < longest.key())
      longest = edge;
  });
  LongEdges result;
  for (const auto &[element, edge] : by_element)
    result.emplace(edge.key(), edge);
  return result;
}

/**
 * Each element's longest edge, where it is too long, gets a point in its middle with the mean of
 * its ends: what is interpolated linearly, momentum above all, does not change. The longest edges
 * first, none that shares a point with another one of this step, and none that ends a region there.
 */
template <int dim>
void
Fluid<dim>::insert(const std::vector<dealii::Point<dim>> &x)
{
  const LongEdges mine = find_long_edges(x);
  // Key, place and region of each.
  std::vector<std::array<double, 5 + dim>> here;
  for (const auto &[key, edge] : mine)
    {
      auto &entry        = here.emplace_back();
      const auto &[i, j] = edge.rows;
      std::copy(key.begin(), key.end(), entry.begin());
      for (unsigned int d = 0; d < dim; ++d)
        entry[4 + d] = 0.5 * (x[i][d] + x[j][d]);
      entry[4 + dim] = region_between(i, j);
    }
  std::set<std::array<double, 5 + dim>> all;
  for (const auto &there : dealii::Utilities::MPI::all_gather(comm, here))
    all.insert(there.begin(), there.end());
  std::vector<NewPoint> new_points;
  for (const auto &entry : all)
    {
      auto &point = new_points.emplace_back();
      for (unsigned int d = 0; d < dim; ++d)
        point.position[d] = entry[4 + d];
      point.region = entry[4 + dim];
    }
  const auto       intrudes = find_intruders(new_points, x);
  std::set<double> used;
  unsigned int     number = 0;
  for (const auto &entry : all)
    {
      if (intrudes[number++] || used.count(entry[1]) || used.count(entry[2]))
        continue;
      used.insert({entry[1], entry[2]});
      const std::uint64_t id = next_id++;
      ++counts.inserted;
      if (entry[3] == mpi::rank(comm))
        insert_between(mine.at({entry[0], entry[1], entry[2], entry[3]}).rows, x, id);
    }
}

template <int dim>
void
Fluid<dim>::insert_between(const std::array<unsigned int, 2>     &rows,
                           const std::vector<dealii::Point<dim>> &x,
                           const std::uint64_t                    id)
{
  const std::size_t row = columns.size();
  columns.resize(row + 1);
  const auto [i, j] = rows;
  for (unsigned int d = 0; d < dim; ++d)
    {
      columns[Layout::position + d][row] = 0.5 * (x[i][d] + x[j][d]);
      columns[Layout::velocity + d][row] = 0.5 * (corrected[i][d] + corrected[j][d]);
    }
  columns[Layout::pressure][row] = 0.5 * (pressure[i] + pressure[j]);
  columns[Layout::spacing][row]  = 0.5 * (points.spacing[i] + points.spacing[j]);
  columns[Layout::id][row]       = id;
  columns[Layout::walls][row]    = walls[i] & walls[j];
  columns[Layout::free][row]     = free_surface[i] && free_surface[j];
  columns[Layout::region][row]   = region_between(i, j);
  columns[Layout::sliding][row]  = 0;
  typename StructureSurface<dim>::Place place;
  if (is_along_structure(i, j, x) &&
      structures.surface.find_nearest(x[i] + 0.5 * (x[j] - x[i]), place))
    put_on_structure(row, place);
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
