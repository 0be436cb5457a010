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
NodalField<dim>::NodalField(const Octree<dim> &octree, const BoxBoundary<dim> &boundary)
  : octree(octree)
  , boundary(boundary)
  , records(octree.n_nodes())
  , motions(octree.n_nodes())
  , impulses(octree.n_nodes())
  , shifts(octree.n_nodes())
  , shifted(octree.n_nodes(), 0)
{}

template <int dim>
void
NodalField<dim>::clear()
{
  std::fill(records.begin(), records.end(), NodeRecord());
  for (const unsigned int node : shifted_nodes)
    {
      shifts[node]  = dealii::Tensor<1, dim>();
      shifted[node] = 0;
    }
  shifted_nodes.clear();
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
NodalField<dim>::sum()
{
  condense(records);
  octree.exchange.sum_to_owners(records);
}

template <int dim>
void
NodalField<dim>::distribute()
{
  octree.exchange.update_ghosts(motions);
  interpolate_hanging(motions);
}

template <int dim>
void
NodalField<dim>::predict(const double dt, const dealii::Tensor<1, dim> &gravity)
{
  books = Energies();
  for (unsigned int i = 0; i < octree.n_owned_nodes(); ++i)
    {
      const NodeRecord &r = records[i];
      NodeRecord       &m = motions[i];
      m                   = NodeRecord();
      const double mass   = r[Gathered::mass];
      if (mass <= no_mass)
        continue;
      const double inverse = 1. / mass;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double before     = r[Gathered::momentum + d] * inverse;
          const double change     = dt * (r[Gathered::force + d] * inverse + gravity[d]);
          m[Motion::change + d]   = change;
          m[Motion::velocity + d] = before + change;
          books.gathered += 0.5 * mass * before * before;
          books.gravity += mass * dt * gravity[d] * (before + 0.5 * change);
          books.given += 0.5 * mass * (before + change) * (before + change);
        }
      m[Motion::mass] = mass;
    }
  fix_boundary_nodes(dt, gravity);
  distribute();
}

template <int dim>
void
NodalField<dim>::fix_boundary_nodes(const double dt, const dealii::Tensor<1, dim> &gravity)
{
  for (const unsigned int i : boundary.fixed_nodes())
    if (i < octree.n_owned_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        if (boundary.fixed(i) & (1u << d))
          {
            NodeRecord  &m    = motions[i];
            const double mass = m[Motion::mass], free = m[Motion::velocity + d],
                         change = m[Motion::change + d], before = free - change;
            // Forces on a fixed node do no work; what is lost is what particles brought there.
            books.gravity -= mass * dt * gravity[d] * (before + 0.5 * change);
            books.given -= 0.5 * mass * free * free;
            books.boundary += 0.5 * mass * before * before;
            // The change takes what particles brought, so that they stop as well.
            m[Motion::change + d]   = -before;
            m[Motion::velocity + d] = 0;
          }
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
  octree.exchange.sum_to_owners(impulses);
  octree.exchange.update_ghosts(impulses);
  const auto apply = [&](const unsigned int node) {
    NodeRecord                  &r       = impulses[node];
    const dealii::Tensor<1, dim> inverse = inverse_mass(node);
    bool                         moves   = false;
    const bool                   owned   = node < octree.n_owned_nodes();
    for (unsigned int d = 0; d < dim; ++d)
      {
        if (owned && inverse[d] > 0)
          {
            const double mean = motions[node][Motion::velocity + d] + 0.5 * r[d] * inverse[d];
            books.given += r[d] * mean;
            // Forces and contact act at once, over the same way: from the velocity at the start of
            // the step to that at its end. So bodies that lean on each other lose nothing.
            books.contact += r[d] * (mean - 0.5 * motions[node][Motion::change + d]);
          }
        motions[node][Motion::velocity + d] += r[d] * inverse[d];
        motions[node][Motion::change + d] += r[d] * inverse[d];
        shifts[node][d] = r[dim + d] * inverse[d];
        moves           = moves || shifts[node][d] != 0;
      }
    if (moves && !shifted[node])
      {
        shifted[node] = 1;
        shifted_nodes.push_back(node);
      }
    r = NodeRecord();
  };
  if (octree.exchange.is_serial())
    for (const unsigned int node : touched)
      apply(node);
  else
    for (unsigned int node = 0; node < octree.n_nodes(); ++node)
      if (impulses[node][7] != 0)
        apply(node);
  touched.clear();

  interpolate_hanging(motions);
  shift_hanging_nodes();
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
  const unsigned int n = octree.n_owned_nodes();
  for (unsigned int i = 0; i < n; ++i)
    {
      NodeRecord  &r       = records[i];
      const double mass    = r[Gathered::mass];
      const double inverse = mass > no_mass ? 1. / mass : 0.;
      for (unsigned int d = 0; d < dim; ++d)
        r[Gathered::momentum + d] *= inverse;
    }
  for (const unsigned int i : boundary.fixed_nodes())
    if (i < n)
      for (unsigned int d = 0; d < dim; ++d)
        if (boundary.fixed(i) & (1u << d))
          records[i][Gathered::momentum + d] = 0;
  octree.exchange.update_ghosts(records);
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
      if (!(boundary.fixed(node) & (1u << d)))
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
  for (unsigned int i = 0; i < octree.n_owned_nodes(); ++i)
    if (octree.hanging_index(i) < 0)
      for (unsigned int d = 0; d < dim; ++d)
        result[d] += motions[i][Motion::mass] * motions[i][Motion::velocity + d];
  return result;
}

template <int dim>
std::size_t
NodalField<dim>::memory_consumption() const
{
  return records.size() * (3 * sizeof(NodeRecord) + sizeof(shifts[0]) + 1);
}

template class NodalField<2>;
template class NodalField<3>;
} // namespace coracle
