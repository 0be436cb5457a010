// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/field_split.h>
#include <coracle/grid/pieces.h>

namespace coracle
{
namespace
{
/// In smallest cells: nearer than this to a mid-surface is on it.
constexpr double on_surface = 1e-6;
/// In smallest cells: how far moving sheets may go before leaves near them are looked for anew.
constexpr double skin_of_moving_sheets = 0.25;
/// Boxes that tell other ranks where this rank's leaves are.
constexpr unsigned int n_reach_boxes = 8;

template <int dim>
void
unite(contact::Box &box, const contact::Box &other, const double margin = 0)
{
  for (int d = 0; d < dim; ++d)
    {
      box.lower[d] = std::min(box.lower[d], other.lower[d] - margin);
      box.upper[d] = std::max(box.upper[d], other.upper[d] + margin);
    }
}

template <int dim>
bool
is_inside(const contact::Box &box, const dealii::Point<dim> &x)
{
  bool result = true;
  for (int d = 0; d < dim; ++d)
    result &= (box.lower[d] < x[d]) & (x[d] < box.upper[d]);
  return result;
}

template <int dim>
contact::Box
empty_box()
{
  contact::Box box;
  for (int d = 0; d < dim; ++d)
    {
      box.lower[d] = std::numeric_limits<double>::max();
      box.upper[d] = std::numeric_limits<double>::lowest();
    }
  return box;
}
} // namespace

template <int dim>
FieldSplit<dim>::FieldSplit(const Octree<dim> &octree)
  : octree(octree)
  , comm(octree.triangulation.get_communicator())
  , smallest_cell(octree.smallest_cell_size())
  , exchange(comm)
{}

template <int dim>
void
FieldSplit<dim>::octree_changed()
{
  smallest_cell = octree.smallest_cell_size();
  searched      = false;
  node_places.clear();
  asked_nodes.clear();
}

template <int dim>
void
FieldSplit<dim>::update(const contact::Surface<dim>       &surface,
                        std::list<MaterialPointBody<dim>> &bodies,
                        NodeSplit<dim>                    &split)
{
  if (!select_sheets(surface))
    {
      for (auto &body : bodies)
        cut(body, split);
      return;
    }
  split.clear();
  const bool gimp = std::any_of(bodies.begin(), bodies.end(), [](const auto &body) {
    return body.margin_of_shape() > 0;
  });
  follow_sheets(gimp);
  if (node_places.empty())
    node_places.assign(octree.n_nodes(), -1);
  for (const unsigned int node : asked_nodes)
    node_places[node] = -1;
  asked_nodes.clear();
  cleared.clear();
  for (auto &body : bodies)
    cut(body, split);
  split.share();
}

// False if there are no sheets, on all ranks alike.
template <int dim>
bool
FieldSplit<dim>::select_sheets(const contact::Surface<dim> &surface)
{
  const auto is_sheet = [](const contact::SurfaceBody &body) {
    return body.kind == contact::SurfaceKind::sheet;
  };
  if (std::none_of(surface.bodies.begin(), surface.bodies.end(), is_sheet))
    return false;
  if (n_published != surface.facets.size() + surface.nodes.size() || !searched)
    {
      n_published   = surface.facets.size() + surface.nodes.size();
      sheets.bodies = surface.bodies;
      sheets.facets.clear();
      source.clear();
      std::vector<int> place(surface.nodes.size(), -1);
      for (auto facet : surface.facets)
        if (is_sheet(surface.bodies[facet.body]))
          {
            for (unsigned int &node : facet.nodes)
              {
                if (place[node] < 0)
                  {
                    place[node] = source.size();
                    source.push_back(node);
                  }
                node = place[node];
              }
            sheets.facets.push_back(facet);
          }
      sheets.nodes.resize(source.size());
      searched_at.clear();
    }
  for (unsigned int i = 0; i < source.size(); ++i)
    sheets.nodes[i] = surface.nodes[source[i]];
  return true;
}

template <int dim>
void
FieldSplit<dim>::follow_sheets(const bool gimp)
{
  double way =
    searched_at.size() == sheets.nodes.size() && searched ? 0. : std::numeric_limits<double>::max();
  for (unsigned int i = 0; i < searched_at.size(); ++i)
    way = std::max(way, sheets.nodes[i].position.distance(searched_at[i]));
  way = mpi::max(way, comm);
  if (way == 0 && !moved)
    return;
  if (way > searched_skin)
    // Sheets that have never moved may never do.
    find_near_leaves((searched ? skin_of_moving_sheets : on_surface) * smallest_cell, gimp);
  else
    {
      moved = true;
      exchange.update(sheets);
      crossing.update();
    }
}

template <int dim>
void
FieldSplit<dim>::extend(const unsigned int leaf, contact::Box &box) const
{
  const auto take = [&](const unsigned int node) {
    const auto &x = octree.position(node);
    for (int d = 0; d < dim; ++d)
      {
        box.lower[d] = std::min(box.lower[d], x[d]);
        box.upper[d] = std::max(box.upper[d], x[d]);
      }
  };
  for (const unsigned int node : octree.nodes(leaf))
    {
      take(node);
      if (const int hanging = octree.hanging_index(node); hanging >= 0)
        for (const auto &parent : octree.hanging_nodes()[hanging].parents)
          take(parent.first);
    }
}

template <int dim>
contact::Box
FieldSplit<dim>::reach(const unsigned int leaf, const bool gimp) const
{
  contact::Box box = empty_box<dim>();
  extend(leaf, box);
  if (!gimp)
    return box;
  // A particle's box may reach into all neighbours; finer ones end within one and a half cells.
  const double size = octree.size(leaf);
  contact::Box around;
  for (int d = 0; d < dim; ++d)
    {
      around.lower[d] = octree.lower(leaf)[d] - 1.5 * size;
      around.upper[d] = octree.lower(leaf)[d] + 2.5 * size;
    }
  unite<dim>(box, around);
  for (int direction = 0; direction < (dim == 2 ? 9 : 27); ++direction)
    {
      dealii::Point<dim> x = octree.lower(leaf);
      for (int d = 0, rest = direction; d < dim; ++d, rest /= 3)
        x[d] += (0.5 + (rest % 3 - 1) * 0.5001) * size;
      if (const int neighbour = octree.find(x); neighbour >= 0)
        extend(neighbour, box);
    }
  return box;
}

template <int dim>
void
FieldSplit<dim>::find_near_leaves(const double skin, const bool gimp)
{
  searched      = true;
  moved         = false;
  searched_skin = skin;
  searched_at.clear();
  for (const auto &node : sheets.nodes)
    searched_at.push_back(node.position);

  const unsigned int        n = octree.n_owned_leaves();
  std::vector<contact::Box> boxes;
  for (unsigned int b = 0; b < n_reach_boxes; ++b)
    {
      contact::Box box = empty_box<dim>();
      for (unsigned int leaf = std::uint64_t(n) * b / n_reach_boxes;
           leaf < std::uint64_t(n) * (b + 1) / n_reach_boxes;
           ++leaf)
        unite<dim>(box, reach(leaf, gimp), skin);
      if (box.lower[0] <= box.upper[0])
        boxes.push_back(box);
    }
  exchange.rebuild(sheets, boxes, {});
  crossing.reinit(exchange.surface());

  contact::Box              all = empty_box<dim>();
  std::vector<contact::Box> simplices;
  for (unsigned int s = 0; s < crossing.n_simplices(); ++s)
    {
      simplices.push_back(crossing.box(s));
      unite<dim>(simplices.back(), crossing.box(s), skin);
      unite<dim>(all, simplices.back());
    }
  tree.build(simplices);
  place_of_leaf.assign(n, -1);
  near_leaves.clear();
  near.clear();
  begin.assign(1, 0);
  std::vector<unsigned int> found;
  for (unsigned int leaf = 0; leaf < n; ++leaf)
    if (const contact::Box box = reach(leaf, gimp); overlap(box, all))
      if (tree.find(box, found); !found.empty())
        {
          std::sort(found.begin(), found.end());
          place_of_leaf[leaf] = near_leaves.size();
          near_leaves.push_back(leaf);
          near.insert(near.end(), found.begin(), found.end());
          begin.push_back(near.size());
        }
}

template <int dim>
void
FieldSplit<dim>::find_candidates(const MaterialPointBody<dim> &body)
{
  const MaterialPoints<dim> &points = body.points;
  const double *const        size   = points.column(ParticleLayout<dim>::size);
  candidates.clear();
  for (unsigned int place = 0; place < near_leaves.size(); ++place)
    {
      const unsigned int leaf = near_leaves[place];
      for (unsigned int row = points.cell_begin()[leaf]; row < points.cell_begin()[leaf + 1]; ++row)
        if (!points.is_hole(row) &&
            is_inside_leaf(octree, leaf, points.position(row), body.margin_of_shape() * size[row]))
          candidates.push_back({row, place});
    }
  // Where no sheet has been looked for, there are no places.
  for (const auto &stray : points.strays)
    if (const int place = place_of_leaf.empty() ? -1 : place_of_leaf[stray.leaf]; place >= 0)
      candidates.push_back({stray.row, static_cast<unsigned int>(place)});
  const auto by_row = [](const Candidate &a, const Candidate &b) { return a.row < b.row; };
  std::sort(candidates.begin(), candidates.end(), by_row);
  const std::size_t n = candidates.size();
  for (const unsigned int row : points.touched)
    if (!points.is_hole(row) &&
        !std::binary_search(candidates.begin(), candidates.begin() + n, Candidate{row, 0}, by_row))
      candidates.push_back({row, nowhere});
  std::inplace_merge(candidates.begin(), candidates.begin() + n, candidates.end(), by_row);
}

template <int dim>
const dealii::Point<dim> &
FieldSplit<dim>::place_of_node(const unsigned int node, const typename Crossing::List &list)
{
  int &place = node_places[node];
  if (place < 0)
    {
      place = cleared.size();
      asked_nodes.push_back(node);
      cleared.push_back(crossing.clear_of(
        octree.position(node), list, on_surface * smallest_cell, [](const int) { return 1.; }));
    }
  return cleared[place];
}

// Around a particle and the nodes of the leaves that its box meets, if they are as large as its
// own.
template <int dim>
contact::Box
FieldSplit<dim>::box_around(const dealii::Point<dim> &x,
                            const unsigned int        leaf,
                            const double              half) const
{
  const double room = half + (1 + 2 * on_surface) * octree.size(leaf);
  contact::Box box;
  for (int d = 0; d < dim; ++d)
    {
      box.lower[d] = x[d] - room;
      box.upper[d] = x[d] + room;
    }
  return box;
}

template <int dim>
void
FieldSplit<dim>::cut(MaterialPointBody<dim> &body, NodeSplit<dim> &split)
{
  find_candidates(body);
  PointCutter<dim>    cutter(octree, body.margin_of_shape(), split, body.points);
  const double *const size = body.points.column(ParticleLayout<dim>::size);
  for (const auto &[row, place] : candidates)
    {
      if (place == nowhere)
        {
          cutter.cut(row, octree.find(body.points.position(row)), [](const unsigned int) {
            return 0;
          });
          continue;
        }
      const typename Crossing::List list{near.data() + begin[place],
                                         near.data() + begin[place + 1]};
      const auto                    side = [&, r = row](const int sheet) {
        const auto &layout = body.points.layout();
        return sheet < layout.n_sheets && body.points.column(layout.side + sheet)[r] < 0 ? -1. : 1.;
      };
      const dealii::Point<dim> x =
        crossing.clear_of(body.points.position(row), list, on_surface * smallest_cell, side);
      // Nearly all nodes that are asked for are near, and few simplices are.
      const auto around = box_around(x, near_leaves[place], body.margin_of_shape() * size[row]);
      crossing.within(around, list, close);
      const typename Crossing::List close_list{close.data(), close.data() + close.size()};
      cutter.cut(row, near_leaves[place], [&](const unsigned int node) {
        const auto &y = place_of_node(node, list);
        return crossing.between(x, y, is_inside(around, y) ? close_list : list);
      });
    }
  cutter.finish();
}

template <int dim>
std::size_t
FieldSplit<dim>::memory_consumption() const
{
  return near.capacity() * sizeof(near[0]) + near_leaves.capacity() * sizeof(near_leaves[0]) +
         begin.capacity() * sizeof(begin[0]) +
         (place_of_leaf.capacity() + node_places.capacity()) * sizeof(int) +
         cleared.capacity() * sizeof(cleared[0]) + candidates.capacity() * sizeof(Candidate);
}

template class FieldSplit<2>;
template class FieldSplit<3>;
} // namespace coracle
