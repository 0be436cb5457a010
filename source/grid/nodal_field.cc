// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/nodal_field.h>

namespace coracle
{
namespace
{
// Below this a node has only round-off of a particle on the opposite face of a cell.
constexpr double no_mass = 1e-100;
} // namespace

template <int dim>
NodalField<dim>::NodalField(const Octree<dim>      &octree,
                            const BoxBoundary<dim> &boundary,
                            const NodeSplit<dim>   *split)
  : octree(octree), boundary(boundary), split(split)
{
  reinit();
}

template <int dim>
void
NodalField<dim>::reinit()
{
  const auto clear = [this](NodeRecords &r) {
    r.resize(octree.n_nodes());
    std::fill(r.begin(), r.end(), NodeRecord());
  };
  clear(records);
  if (is_reproducible)
    clear(rests);
  clear(motions);
  clear(impulses);
  shifts.assign(octree.n_nodes(), dealii::Tensor<1, dim>());
  shifted.assign(octree.n_nodes(), 0);
  shifted_nodes.clear();
  touched.clear();
}

template <int dim>
void
NodalField<dim>::clear()
{
  for (const unsigned int node : shifted_nodes)
    {
      shifts[node]  = dealii::Tensor<1, dim>();
      shifted[node] = 0;
    }
  shifted_nodes.clear();
  if (n_records() != records.size())
    {
      records.resize(n_records());
      motions.resize(n_records());
      impulses.resize(n_records());
      shifts.resize(n_records());
      shifted.resize(n_records(), 0);
    }
  std::fill(records.begin(), records.end(), NodeRecord());
}

template <int dim>
void
NodalField<dim>::bound(const Bounds &bounds)
{
  // Nodes of leaves around a node hang on it, with weights that are multiples of 2^-6 at least.
  constexpr int bits_of_weights = 6;
  const int     bits = bits_of_weights + static_cast<int>(std::ceil(std::log2(bounds.number)));
  const auto    set  = [&](const unsigned int place, const double largest) {
    high_grid[place] = SumGrid(largest, bits);
    low_grid[place]  = SumGrid(high_grid[place].largest_rest(), bits);
  };
  set(Gathered::mass, bounds.mass);
  for (int d = 0; d < dim; ++d)
    {
      set(Gathered::momentum + d, bounds.momentum);
      set(Gathered::force + d, bounds.force);
    }
  rests.resize(n_records());
  std::fill(rests.begin(), rests.end(), NodeRecord());
}

template <int dim>
double
NodalField<dim>::largest_velocity() const
{
  double result = 0;
  for (unsigned int i = 0; i < octree.n_owned_nodes(); ++i)
    for (int d = 0; d < 2 * dim; ++d)
      result = std::max(result, std::abs(motions[i][d]));
  for (unsigned int i = octree.n_nodes(); i < n_records(); ++i)
    for (int d = 0; d < 2 * dim; ++d)
      result = std::max(result, std::abs(motions[i][d]));
  return result;
}

template <int dim>
void
NodalField<dim>::condense(NodeRecords &r) const
{
  for (const auto &hanging : octree.hanging_nodes())
    {
      NodeRecord &from = r[hanging.node];
      for (const auto &[parent, weight] : hanging.parents)
        for (unsigned int k = 0; k < 8; ++k)
          r[parent][k] += weight * from[k];
      from = NodeRecord();
    }
}

template <int dim>
void
NodalField<dim>::interpolate_hanging(NodeRecords &r) const
{
  for (const auto &hanging : octree.hanging_nodes())
    {
      NodeRecord to;
      for (const auto &[parent, weight] : hanging.parents)
        for (unsigned int k = 0; k < 8; ++k)
          to[k] += weight * r[parent][k];
      r[hanging.node] = to;
    }
}

template <int dim>
void
NodalField<dim>::sum_to_owners(NodeRecords &r) const
{
  octree.exchange.sum_to_owners(r);
  if (split)
    split->sum_to_owners(r);
}

template <int dim>
void
NodalField<dim>::update_ghosts(NodeRecords &r) const
{
  octree.exchange.update_ghosts(r);
  if (split)
    split->update_ghosts(r);
}

template <int dim>
void
NodalField<dim>::sum()
{
  condense(records);
  sum_to_owners(records);
  if (is_reproducible)
    sum_rests();
}

// Both sums were exact so far: one rounding makes them what the owner has.
template <int dim>
void
NodalField<dim>::sum_rests()
{
  condense(rests);
  sum_to_owners(rests);
  for_each_owned([&](const unsigned int i) {
    for (unsigned int k = 0; k < 8; ++k)
      records[i][k] += rests[i][k];
    rests[i] = NodeRecord();
  });
}

template <int dim>
void
NodalField<dim>::distribute()
{
  update_ghosts(motions);
  interpolate_hanging(motions);
}

template <int dim>
void
NodalField<dim>::predict(const double dt, const dealii::Tensor<1, dim> &gravity)
{
  books = Energies();
  if (is_reproducible)
    exact_books = RankSums(5, true);
  for_each_owned([&](const unsigned int i) { predict_node(i, dt, gravity); });
  fix_boundary_nodes(dt, gravity);
  distribute();
}

template <int dim>
inline void
NodalField<dim>::book(const Energies &e)
{
  if (is_reproducible)
    {
      exact_books.add(0, e.gathered);
      exact_books.add(1, e.gravity);
      exact_books.add(2, e.boundary);
      exact_books.add(3, e.contact);
      exact_books.add(4, e.given);
      return;
    }
  books.gathered += e.gathered;
  books.gravity += e.gravity;
  books.boundary += e.boundary;
  books.contact += e.contact;
  books.given += e.given;
}

template <int dim>
void
NodalField<dim>::sum_energies()
{
  if (!is_reproducible)
    return;
  const auto all = exact_books.share(octree.triangulation.get_communicator());
  books          = {all[0], all[1], all[2], all[3], all[4]};
}

template <int dim>
inline void
NodalField<dim>::predict_node(const unsigned int            i,
                              const double                  dt,
                              const dealii::Tensor<1, dim> &gravity)
{
  const NodeRecord &r = records[i];
  NodeRecord       &m = motions[i];
  m                   = NodeRecord();
  const double mass   = r[Gathered::mass];
  if (mass <= no_mass)
    return;
  const double inverse = 1. / mass;
  Energies     e;
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double before     = r[Gathered::momentum + d] * inverse;
      const double change     = dt * (r[Gathered::force + d] * inverse + gravity[d]);
      m[Motion::change + d]   = change;
      m[Motion::velocity + d] = before + change;
      e.gathered += 0.5 * mass * before * before;
      e.gravity += mass * dt * gravity[d] * (before + 0.5 * change);
      e.given += 0.5 * mass * (before + change) * (before + change);
    }
  m[Motion::mass] = mass;
  book(e);
}

template <int dim>
void
NodalField<dim>::fix_boundary_nodes(const double dt, const dealii::Tensor<1, dim> &gravity)
{
  for_each_fixed([&](const unsigned int i, const unsigned int d) {
    NodeRecord  &m    = motions[i];
    const double mass = m[Motion::mass], free = m[Motion::velocity + d],
                 change = m[Motion::change + d], before = free - change;
    Energies e;
    // Forces on a fixed node do no work; what is lost is what particles brought there.
    e.gravity -= mass * dt * gravity[d] * (before + 0.5 * change);
    e.given -= 0.5 * mass * free * free;
    e.boundary += 0.5 * mass * before * before;
    book(e);
    // The change takes what particles brought, so that they stop as well.
    m[Motion::change + d]   = -before;
    m[Motion::velocity + d] = 0;
  });
}

template <int dim>
void
NodalField<dim>::add_impulse(const unsigned int            node,
                             const dealii::Tensor<1, dim> &impulse,
                             const dealii::Tensor<1, dim> &correction)
{
  NodeRecord &r = impulses[node];
  if (r[7] == 0)
    {
      r[7] = 1;
      touched.push_back(node);
    }
  for (unsigned int d = 0; d < dim; ++d)
    {
      r[d] += impulse[d];
      r[dim + d] += correction[d];
    }
}

template <int dim>
void
NodalField<dim>::apply_impulses()
{
  sum_to_owners(impulses);
  update_ghosts(impulses);
  if (octree.exchange.is_serial())
    for (const unsigned int node : touched)
      apply_impulse(node);
  else
    for (unsigned int node = 0; node < n_records(); ++node)
      if (impulses[node][7] != 0)
        apply_impulse(node);
  touched.clear();

  interpolate_hanging(motions);
  shift_hanging_nodes();
}

template <int dim>
void
NodalField<dim>::apply_impulse(const unsigned int node)
{
  NodeRecord                  &r       = impulses[node];
  const dealii::Tensor<1, dim> inverse = inverse_mass(node);
  bool                         moves   = false;
  Energies                     e;
  const bool owned = split ? split->is_owned(node) : node < octree.n_owned_nodes();
  for (unsigned int d = 0; d < dim; ++d)
    {
      if (owned && inverse[d] > 0)
        {
          const double mean = motions[node][Motion::velocity + d] + 0.5 * r[d] * inverse[d];
          e.given += r[d] * mean;
          // Forces and contact act at once, over the same way: from the velocity at the start of
          // the step to that at its end. So bodies that lean on each other lose nothing.
          e.contact += r[d] * (mean - 0.5 * motions[node][Motion::change + d]);
        }
      motions[node][Motion::velocity + d] += r[d] * inverse[d];
      motions[node][Motion::change + d] += r[d] * inverse[d];
      shifts[node][d] = r[dim + d] * inverse[d];
      moves           = moves || shifts[node][d] != 0;
    }
  book(e);
  if (moves && !shifted[node])
    {
      shifted[node] = 1;
      shifted_nodes.push_back(node);
    }
  r = NodeRecord();
}

template <int dim>
void
NodalField<dim>::shift_hanging_nodes()
{
  for (const auto &hanging : octree.hanging_nodes())
    {
      dealii::Tensor<1, dim> shift;
      bool                   moves = false;
      for (const auto &[parent, weight] : hanging.parents)
        {
          shift += weight * shifts[parent];
          moves = moves || shifted[parent];
        }
      if (moves)
        {
          shifts[hanging.node]  = shift;
          shifted[hanging.node] = 1;
          shifted_nodes.push_back(hanging.node);
        }
    }
}

template <int dim>
void
NodalField<dim>::clear_momentum()
{
  for (NodeRecord &r : records)
    for (unsigned int k = Gathered::momentum; k < 8; ++k)
      r[k] = 0;
}

template <int dim>
void
NodalField<dim>::remap()
{
  for_each_owned([&](const unsigned int i) {
    NodeRecord  &r       = records[i];
    const double mass    = r[Gathered::mass];
    const double inverse = mass > no_mass ? 1. / mass : 0.;
    for (unsigned int d = 0; d < dim; ++d)
      r[Gathered::momentum + d] *= inverse;
  });
  for_each_fixed(
    [&](const unsigned int i, const unsigned int d) { records[i][Gathered::momentum + d] = 0; });
  update_ghosts(records);
  interpolate_hanging(records);
}

template <int dim>
dealii::Tensor<1, dim>
NodalField<dim>::inverse_mass(const unsigned int node) const
{
  dealii::Tensor<1, dim> result;
  const double           mass = motions[node][Motion::mass];
  if (mass > no_mass)
    for (unsigned int d = 0; d < dim; ++d)
      if (!(fixed(node) & (1u << d)))
        result[d] = 1. / mass;
  return result;
}

template <int dim>
dealii::Tensor<1, dim>
NodalField<dim>::velocity(const unsigned int node) const
{
  dealii::Tensor<1, dim> result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] = motions[node][Motion::velocity + d];
  return result;
}

template <int dim>
dealii::Tensor<1, dim>
NodalField<dim>::momentum() const
{
  dealii::Tensor<1, dim> result;
  for_each_owned([&](const unsigned int i) {
    if (i >= octree.n_nodes() || octree.hanging_index(i) < 0)
      for (unsigned int d = 0; d < dim; ++d)
        result[d] += motions[i][Motion::mass] * motions[i][Motion::velocity + d];
  });
  return result;
}

template <int dim>
std::size_t
NodalField<dim>::memory_consumption() const
{
  return (3 * records.capacity() + rests.capacity()) * sizeof(NodeRecord) +
         shifts.capacity() * (sizeof(shifts[0]) + 1);
}

template class NodalField<2>;
template class NodalField<3>;
} // namespace coracle
