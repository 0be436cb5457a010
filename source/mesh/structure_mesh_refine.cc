// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/mesh/structure_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace coracle
{
namespace
{
/// p4est knows whole numbers; nothing is added to these.
unsigned int
whole_weight(const double weight)
{
  return static_cast<unsigned int>(std::clamp(std::round(1000. * weight), 1., 1e9));
}
} // namespace

/**
 * Takes rows of nodes and elements along when the mesh changes. Each element packs
 * the rows of its corners and its own one; they travel to where the element, or what
 * it is cut into, comes to lie.
 */
template <int dim>
class StructureMesh<dim>::Carrier
{
public:
  Carrier(StructureMesh &mesh, CarriedState<dim> &state);

  /// Rows of an element as it is before the change.
  std::vector<char> pack(const unsigned int active_cell) const;
  /// Of an element as it is before the change, and so of each of its parts.
  double weight(const unsigned int active_cell) const
  {
    return mesh.weight[element_of_cell[active_cell]];
  }
  /// After nodes and elements have new numbers.
  void begin_unpacking();
  using Cell  = typename dealii::Triangulation<dim>::cell_iterator;
  using Bytes = boost::iterator_range<std::vector<char>::const_iterator>;
  void unpack(const Cell &cell, const bool was_refined, const Bytes &bytes);
  /// Nodes that several ranks have become what the best informed one knows.
  void finish();

private:
  static constexpr unsigned int n_corners = nodes_per_element;

  /// A node's row as far as this rank can tell: known before, or the mean of those around it.
  enum Source : unsigned char
  {
    kept,
    mean,
    unknown
  };

  std::size_t row_size() const { return dim + state.nodes.n_columns(); }
  /// Rows of the corners, the element's row, its weight.
  std::size_t packed_size() const { return place_of_weight() + 1; }
  std::size_t place_of_weight() const
  {
    return n_corners * row_size() + state.elements.n_columns();
  }
  void offer(const unsigned int node, const Source source, const double *row);
  void unpack_child(const unsigned int element, const unsigned int child, const double *parent);
  /// Mean of those corners of an element that the point `place` (0, 1 or 2 along each axis) is
  /// between; the same bits from any element that has them.
  void mean_of_corners(const std::array<unsigned int, dim> &place,
                       const double                        *corners,
                       double                              *row) const;
  void exchange_offers();

  StructureMesh     &mesh;
  CarriedState<dim> &state;
  /// Number of an element by that of its active cell.
  std::vector<unsigned int> element_of_cell;
  /// Position, then the node's row, for each local node of the new mesh.
  std::vector<double> rows;
  std::vector<Source> sources;
  Columns             new_elements;
};

template <int dim>
StructureMesh<dim>::Carrier::Carrier(StructureMesh &mesh, CarriedState<dim> &state)
  : mesh(mesh), state(state), element_of_cell(mesh.triangulation.n_active_cells(), -1)
{
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    element_of_cell[mesh.active_cell_index[e]] = e;
}

template <int dim>
std::vector<char>
StructureMesh<dim>::Carrier::pack(const unsigned int active_cell) const
{
  const unsigned int  element = element_of_cell[active_cell];
  std::vector<double> values(packed_size());
  double             *value = values.data();
  for (const unsigned int node : mesh.elements[element])
    {
      for (int d = 0; d < dim; ++d)
        value[d] = mesh.nodes[node][d];
      if (state.nodes.n_columns() > 0)
        state.nodes.get_row(node, value + dim);
      value += row_size();
    }
  if (state.elements.n_columns() > 0)
    state.elements.get_row(element, value);
  values[place_of_weight()] = mesh.weight[element];
  std::vector<char> bytes(values.size() * sizeof(double));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

template <int dim>
void
StructureMesh<dim>::Carrier::begin_unpacking()
{
  rows.assign(row_size() * mesh.n_nodes(), 0.);
  sources.assign(mesh.n_nodes(), unknown);
  new_elements = Columns(state.elements.n_columns());
  new_elements.resize(mesh.n_elements());
  state.is_child.assign(mesh.n_elements(), false);
  element_of_cell.assign(mesh.triangulation.n_active_cells(), -1);
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    element_of_cell[mesh.active_cell_index[e]] = e;
}

template <int dim>
void
StructureMesh<dim>::Carrier::offer(const unsigned int node, const Source source, const double *row)
{
  if (source >= sources[node])
    return;
  sources[node] = source;
  std::copy_n(row, row_size(), rows.data() + node * row_size());
}

template <int dim>
void
StructureMesh<dim>::Carrier::unpack(const Cell &cell, const bool was_refined, const Bytes &bytes)
{
  std::vector<double> values(packed_size());
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char *>(values.data()));
  if (was_refined)
    {
      for (unsigned int child = 0; child < n_corners; ++child)
        unpack_child(element_of_cell[cell->child(child)->active_cell_index()],
                     child,
                     values.data());
      return;
    }
  const unsigned int element = element_of_cell[cell->active_cell_index()];
  for (unsigned int v = 0; v < n_corners; ++v)
    offer(mesh.elements[element][v], kept, &values[v * row_size()]);
  mesh.weight[element] = values[place_of_weight()];
  if (new_elements.n_columns() > 0)
    new_elements.set_row(element, &values[n_corners * row_size()]);
}

template <int dim>
void
StructureMesh<dim>::Carrier::unpack_child(const unsigned int element,
                                          const unsigned int child,
                                          const double      *parent)
{
  std::vector<double> row(row_size());
  for (unsigned int v = 0; v < n_corners; ++v)
    {
      std::array<unsigned int, dim> place;
      bool                          is_corner = true;
      for (int d = 0; d < dim; ++d)
        {
          place[d]  = ((child >> d) & 1) + ((v >> d) & 1);
          is_corner = is_corner && place[d] != 1;
        }
      mean_of_corners(place, parent, row.data());
      offer(mesh.elements[element][v], is_corner ? kept : mean, row.data());
    }
  state.is_child[element] = true;
  mesh.weight[element]    = parent[place_of_weight()];
  if (new_elements.n_columns() == 0)
    return;
  std::vector<double> own(new_elements.n_columns());
  state.child_row(parent + n_corners * row_size(), child, own.data());
  new_elements.set_row(element, own.data());
}

template <int dim>
void
StructureMesh<dim>::Carrier::mean_of_corners(const std::array<unsigned int, dim> &place,
                                             const double                        *corners,
                                             double                              *row) const
{
  std::vector<unsigned int> around;
  for (unsigned int v = 0; v < n_corners; ++v)
    {
      bool is_near = true;
      for (int d = 0; d < dim; ++d)
        is_near = is_near && (place[d] == 1 || place[d] == 2 * ((v >> d) & 1));
      if (is_near)
        around.push_back(v);
    }
  std::array<double, n_corners> values;
  for (std::size_t c = 0; c < row_size(); ++c)
    {
      // In ascending order: elements at a face know its corners in orders of their own.
      for (unsigned int i = 0; i < around.size(); ++i)
        {
          const double value    = corners[around[i] * row_size() + c];
          unsigned int place_of = i;
          for (; place_of > 0 && values[place_of - 1] > value; --place_of)
            values[place_of] = values[place_of - 1];
          values[place_of] = value;
        }
      double sum = values[0];
      for (unsigned int i = 1; i < around.size(); ++i)
        sum += values[i];
      row[c] = sum / around.size();
    }
}

template <int dim>
void
StructureMesh<dim>::Carrier::exchange_offers()
{
  // A node's number, where its row comes from, and the row.
  const std::size_t                           size = 2 + row_size();
  std::map<unsigned int, std::vector<double>> to_owners;
  for (unsigned int n = mesh.n_owned_nodes(); n < mesh.n_nodes(); ++n)
    if (sources[n] != unknown)
      {
        auto &message = to_owners[mesh.owner(n)];
        message.push_back(mesh.key(n));
        message.push_back(sources[n]);
        message.insert(message.end(), &rows[n * row_size()], &rows[n * row_size()] + row_size());
      }
  for (const auto &[rank, message] : mpi::exchange_values(to_owners, mesh.communicator()))
    for (std::size_t i = 0; i < message.size(); i += size)
      offer(mesh.exchange.indices()->global_to_local(message[i]),
            static_cast<Source>(static_cast<unsigned char>(message[i + 1])),
            &message[i + 2]);
}

template <int dim>
void
StructureMesh<dim>::Carrier::finish()
{
  exchange_offers();
  Columns columns(row_size() + 1);
  columns.resize(mesh.n_nodes());
  for (unsigned int n = 0; n < mesh.n_owned_nodes(); ++n)
    {
      Assert(sources[n] != unknown, dealii::ExcInternalError());
      for (std::size_t c = 0; c < row_size(); ++c)
        columns[c][n] = rows[n * row_size() + c];
      columns[row_size()][n] = sources[n];
    }
  mesh.exchange.update_ghosts(columns, 0, columns.n_columns());

  state.nodes = Columns(state.nodes.n_columns());
  state.nodes.resize(mesh.n_nodes());
  state.is_new_node.resize(mesh.n_nodes());
  for (unsigned int n = 0; n < mesh.n_nodes(); ++n)
    {
      for (int d = 0; d < dim; ++d)
        mesh.nodes[n][d] = columns[d][n];
      for (unsigned int c = 0; c < state.nodes.n_columns(); ++c)
        state.nodes[c][n] = columns[dim + c][n];
      state.is_new_node[n] = (columns[row_size()][n] == mean);
    }
  state.elements = new_elements;
}

template <int dim>
bool
StructureMesh<dim>::refine(const std::vector<bool> &wanted, CarriedState<dim> &state)
{
  AssertDimension(wanted.size(), n_elements());
  if (!mpi::any(std::find(wanted.begin(), wanted.end(), true) != wanted.end(),
                this->communicator()))
    return false;
  for (const auto &cell : triangulation.active_cell_iterators())
    cell->clear_refine_flag();
  std::vector<bool> flags(triangulation.n_active_cells());
  for (unsigned int e = 0; e < n_elements(); ++e)
    flags[active_cell_index[e]] = wanted[e];
  for (const auto &cell : triangulation.active_cell_iterators())
    if (flags[cell->active_cell_index()])
      {
        Assert(cell->level() < static_cast<int>(deepest_level), dealii::ExcInternalError());
        cell->set_refine_flag();
      }
  carry(state, [this] { triangulation.execute_coarsening_and_refinement(); });
  return true;
}

template <int dim>
void
StructureMesh<dim>::set_weights(const std::vector<double> &by_element)
{
  AssertDimension(by_element.size(), n_elements());
  weight   = by_element;
  weighted = true;
}

template <int dim>
void
StructureMesh<dim>::share_out(CarriedState<dim> &state)
{
  carry(state, [this] { triangulation.repartition(); });
}

template <int dim>
void
StructureMesh<dim>::carry(CarriedState<dim> &state, const std::function<void()> &change)
{
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
  Carrier                     carrier(*this, state);
  boost::signals2::connection connection;
  if (weighted)
    connection = triangulation.signals.weight.connect(
      [&carrier](const auto &cell, const typename Triangulation::CellStatus) {
        return whole_weight(carrier.weight(cell->active_cell_index()));
      });
  const unsigned int handle = triangulation.register_data_attach(
    [&carrier](const auto &cell, const typename Triangulation::CellStatus) {
      return carrier.pack(cell->active_cell_index());
    },
    false);
  change();
  connection.disconnect();
  number_nodes();
  carrier.begin_unpacking();
  triangulation.notify_ready_to_unpack(handle,
                                       [&carrier](const auto                              &cell,
                                                  const typename Triangulation::CellStatus status,
                                                  const auto                              &bytes) {
                                         carrier.unpack(cell,
                                                        status == Triangulation::CELL_REFINE,
                                                        bytes);
                                       });
  carrier.finish();
  move_vertices();
  ++changes;
}

template <int dim>
void
StructureMesh<dim>::move_vertices()
{
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int v : cell->vertex_indices())
        {
          const unsigned int node =
            this->exchange.indices()->global_to_local(cell->vertex_dof_index(v, 0));
          cell->vertex(v) = this->nodes[node];
        }
}

template <int dim>
void
StructureMesh<dim>::refine_to(const AreThere &are_there)
{
  Columns           no_node_columns, no_element_columns;
  CarriedState<dim> nothing{no_node_columns, no_element_columns, {}};
  std::vector<bool> wanted;
  do
    {
      wanted = are_there(element_keys);
      for (unsigned int e = 0; e < n_elements(); ++e)
        wanted[e] = !wanted[e] && level(e) < deepest_level;
  } while (refine(wanted, nothing));
}

template class StructureMesh<2>;
template class StructureMesh<3>;
} // namespace coracle
