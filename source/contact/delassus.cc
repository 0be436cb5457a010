// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exact_sum.h>
#include <coracle/contact/delassus.h>
#include <coracle/contact/messages.h>

#include <cmath>
#include <limits>

namespace coracle::contact
{
template <int dim>
Delassus<dim>::Delassus(MPI_Comm communicator) : communicator(communicator), shared(communicator)
{}

template <int dim>
dealii::Tensor<1, dim>
Delassus<dim>::cross(const dealii::Tensor<1, 3> &spin, const Vector &arm)
{
  if constexpr (dim == 3)
    return dealii::cross_product_3d(spin, arm);
  else
    {
      Vector result;
      result[0] = -spin[2] * arm[1];
      result[1] = spin[2] * arm[0];
      return result;
    }
}

template <int dim>
dealii::Tensor<1, 3>
Delassus<dim>::torque(const Vector &arm, const Vector &impulse)
{
  if constexpr (dim == 3)
    return dealii::cross_product_3d(arm, impulse);
  else
    {
      dealii::Tensor<1, 3> result;
      result[2] = arm[0] * impulse[1] - arm[1] * impulse[0];
      return result;
    }
}

template <int dim>
void
Delassus<dim>::apply_rigid(const Row           &row,
                           const unsigned int   side,
                           const Vector        &impulse,
                           LaneVelocities<dim> &v) const
{
  const int b = row.rigid_body[side];
  for (int d = 0; d < dim; ++d)
    v.rigid[b][d] += sign(side) * rigid_inverse_mass[b][d] * impulse[d];
  v.spin[b] +=
    sign(side) * (rigid_inverse_inertia[b] * torque(arms[&row - list.data()][side], impulse));
}

template <int dim>
dealii::Tensor<1, dim>
Delassus<dim>::response(const Row &row, const Vector &impulse, const bool split) const
{
  Vector result;
  for (std::size_t e = row.begin; e < row.begin + row.n_entries; ++e)
    {
      const unsigned int i      = entry_unknown[e];
      const double       factor = entry_weight[e] * entry_weight[e] / (split ? 1 : multiplicity(i));
      for (int d = 0; d < dim; ++d)
        result[d] += factor * inverse_mass[i][d] * impulse[d];
    }
  for (unsigned int side = 0; side < 2; ++side)
    if (const int b = row.rigid_body[side]; b >= 0)
      {
        const Vector &arm = arms[&row - list.data()][side];
        const double  n   = (split ? 1 : rigid_multiplicity[b]);
        for (int d = 0; d < dim; ++d)
          result[d] += rigid_inverse_mass[b][d] / n * impulse[d];
        result += cross(rigid_inverse_inertia[b] * torque(arm, impulse), arm) / n;
      }
  return result;
}

template <int dim>
double
Delassus<dim>::tangential_inverse_mass(const Row &row, const bool split) const
{
  const Vector normal = to_tensor<dim>(row.normal);
  Vector       t1;
  if constexpr (dim == 2)
    {
      t1[0] = -normal[1];
      t1[1] = normal[0];
      return t1 * response(row, t1, split);
    }
  else
    {
      unsigned int smallest = 0;
      for (int d = 1; d < dim; ++d)
        if (std::abs(normal[d]) < std::abs(normal[smallest]))
          smallest = d;
      t1[smallest] = 1;
      t1 -= (t1 * normal) * normal;
      t1 /= t1.norm();
      const Vector t2 = dealii::cross_product_3d(normal, t1), k1 = response(row, t1, split),
                   k2 = response(row, t2, split);
      const double a = t1 * k1, b = t2 * k2, c = t1 * k2;
      return 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + c * c);
    }
}

template <int dim>
void
Delassus<dim>::prepare(Row &row, Sliding &slide, TrueMasses &masses) const
{
  const Vector normal          = to_tensor<dim>(row.normal);
  const Vector normal_response = response(row, normal);
  row.normal_inverse_mass      = normal * normal_response;
  masses.normal                = normal * response(row, normal, false);
  if (slide.friction > 0)
    {
      slide.normal_response         = to_lanes<dim>(normal_response);
      slide.tangential_inverse_mass = tangential_inverse_mass(row, true);
      masses.tangential             = tangential_inverse_mass(row, false);
    }
  double largest = 0;
  for (std::size_t e = row.begin; e < row.begin + row.n_entries; ++e)
    largest +=
      entry_weight[e] * entry_weight[e] * to_tensor<dim>(inverse_mass[entry_unknown[e]]).norm();
  for (const int b : row.rigid_body)
    if (b >= 0)
      largest += rigid_inverse_mass[b].norm();
  row.fixed       = !(row.normal_inverse_mass > 1e-10 * largest);
  row.normal_mass = (row.fixed ? 0. : 1. / row.normal_inverse_mass);
  // Where both sides' sliding is prescribed, friction changes nothing.
  if (slide.friction > 0 && !(slide.tangential_inverse_mass > 1e-10 * largest))
    slide.friction = 0;
  row.has_friction = (slide.friction > 0);
}

template <int dim>
void
Delassus<dim>::take_entries(const Rows &rows)
{
  Assert(rows.entries.size() < std::numeric_limits<unsigned int>::max(),
         dealii::ExcMessage("Too many entries for one rank"));
  entry_unknown.resize(rows.entries.size());
  entry_weight.resize(rows.entries.size());
  for (std::size_t side = 0; side + 1 < rows.begin.size(); ++side)
    for (std::size_t e = rows.begin[side]; e < rows.begin[side + 1]; ++e)
      {
        entry_unknown[e] = rows.entries[e].unknown;
        entry_weight[e]  = (side % 2 == 0 ? 1 : -1) * rows.entries[e].weight;
      }
}

template <int dim>
void
Delassus<dim>::count_ranks_of_bodies(const Rows &rows, const unsigned int n_bodies)
{
  rigid_multiplicity.assign(n_bodies, 0.);
  for (const auto &sides : rows.rigid_body)
    for (const int b : sides)
      if (b >= 0)
        rigid_multiplicity[b] = 1;
  if (n_bodies > 0)
    MPI_Allreduce(
      MPI_IN_PLACE, rigid_multiplicity.data(), n_bodies, MPI_DOUBLE, MPI_SUM, communicator);
}

template <int dim>
void
Delassus<dim>::count_blocks_of_bodies()
{
  const unsigned int n_copies = blocks->rigid().size();
  buffer.assign(blocks->n_bodies(), 0.);
  for (unsigned int copy = 0; copy < n_copies; ++copy)
    ++buffer[blocks->body(copy)];
  if (!buffer.empty())
    MPI_Allreduce(MPI_IN_PLACE, buffer.data(), buffer.size(), MPI_DOUBLE, MPI_SUM, communicator);
  rigid_multiplicity.resize(n_copies);
  for (unsigned int copy = 0; copy < n_copies; ++copy)
    rigid_multiplicity[copy] = buffer[blocks->body(copy)];
}

template <int dim>
void
Delassus<dim>::share_rigid_bodies(const std::vector<RigidUnknown<dim>> &rigid)
{
  rigid_inverse_mass.resize(rigid.size());
  rigid_inverse_inertia.resize(rigid.size());
  predicted.rigid.resize(rigid.size());
  predicted.spin.resize(rigid.size());
  for (unsigned int b = 0; b < rigid.size(); ++b)
    {
      // Ranks without contact at a body take no part in its change.
      const double n           = std::max(1., rigid_multiplicity[b]);
      rigid_inverse_mass[b]    = n * rigid[b].inverse_mass;
      rigid_inverse_inertia[b] = n * rigid[b].inverse_inertia;
      if (dim == 2)
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            if (i != 2 || j != 2)
              rigid_inverse_inertia[b][i][j] = 0;
      predicted.rigid[b] = rigid[b].velocity;
      predicted.spin[b]  = rigid[b].spin;
    }
}

template <int dim>
void
Delassus<dim>::reinit(const std::vector<Contact<dim>>      &contacts,
                      const Rows                           &rows,
                      const std::vector<Unknown<dim>>      &unknowns,
                      const std::vector<RigidUnknown<dim>> &rigid)
{
  blocks = nullptr;
  shared.reinit(unknowns);
  count_ranks_of_bodies(rows, rigid.size());
  set_rows(contacts, rows, unknowns, rigid);
}

template <int dim>
void
Delassus<dim>::reinit(const std::vector<Contact<dim>> &contacts, BlockRows<dim> &in_blocks)
{
  blocks = &in_blocks;
  count_blocks_of_bodies();
  set_rows(contacts, blocks->rows(), blocks->unknowns(), blocks->rigid());
}

template <int dim>
void
Delassus<dim>::set_rows(const std::vector<Contact<dim>>      &contacts,
                        const Rows                           &rows,
                        const std::vector<Unknown<dim>>      &unknowns,
                        const std::vector<RigidUnknown<dim>> &rigid)
{
  share_rigid_bodies(rigid);
  inverse_mass.resize(unknowns.size());
  predicted.nodes.resize(unknowns.size());
  shared_list.clear();
  for (unsigned int i = 0; i < unknowns.size(); ++i)
    {
      if (multiplicity(i) > 1)
        shared_list.push_back(i);
      inverse_mass[i]    = double(multiplicity(i)) * to_lanes<dim>(unknowns[i].inverse_mass);
      predicted.nodes[i] = to_lanes<dim>(unknowns[i].velocity);
    }

  take_entries(rows);
  list.resize(contacts.size());
  slidings.resize(contacts.size());
  true_masses.resize(contacts.size());
  arms.resize(rigid.empty() ? 0 : contacts.size());
  for (std::size_t c = 0; c < contacts.size(); ++c)
    {
      Row &row             = list[c];
      row.begin            = rows.begin[2 * c];
      row.n_entries        = rows.begin[2 * c + 2] - row.begin;
      row.rigid_body       = rows.rigid_body[c];
      row.normal           = to_lanes<dim>(contacts[c].normal);
      slidings[c].friction = contacts[c].friction;
      for (unsigned int side = 0; side < 2; ++side)
        if (const int b = row.rigid_body[side]; b >= 0)
          arms[c][side] =
            contacts[c].place + contacts[c].gap * contacts[c].normal - rigid[b].centre;
      prepare(row, slidings[c], true_masses[c]);
    }
}

template <int dim>
void
Delassus<dim>::set_zero(LaneVelocities<dim> &v) const
{
  v.nodes.assign(predicted.nodes.size(), Lanes<dim>{});
  v.rigid.assign(predicted.rigid.size(), Vector());
  v.spin.assign(predicted.spin.size(), dealii::Tensor<1, 3>());
}

template <int dim>
void
Delassus<dim>::copy_shared(const LaneVelocities<dim>       &v,
                           const std::vector<unsigned int> &nodes,
                           LaneVelocities<dim>             &before) const
{
  if (blocks == nullptr && n_ranks(communicator) == 1)
    return;
  for (const unsigned int i : nodes)
    before.nodes[i] = v.nodes[i];
  before.rigid = v.rigid;
  before.spin  = v.spin;
}

template <int dim>
void
Delassus<dim>::synchronise(LaneVelocities<dim>       &v,
                           const LaneVelocities<dim> &before,
                           double                    &scalar)
{
  if (blocks != nullptr)
    return synchronise_blocks(v, before);
  if (n_ranks(communicator) == 1)
    return;
  shared.average_change(v.nodes, before.nodes);

  buffer.clear();
  buffer.push_back(scalar);
  for (unsigned int b = 0; b < v.rigid.size(); ++b)
    {
      const double share = 1. / std::max(1., rigid_multiplicity[b]);
      for (int d = 0; d < dim; ++d)
        buffer.push_back(share * (v.rigid[b][d] - before.rigid[b][d]));
      for (int d = 0; d < 3; ++d)
        buffer.push_back(share * (v.spin[b][d] - before.spin[b][d]));
    }
  MPI_Allreduce(MPI_IN_PLACE, buffer.data(), buffer.size(), MPI_DOUBLE, MPI_SUM, communicator);
  const double *in = buffer.data();
  scalar           = *in++;
  for (unsigned int b = 0; b < v.rigid.size(); ++b)
    {
      for (int d = 0; d < dim; ++d)
        v.rigid[b][d] = before.rigid[b][d] + *in++;
      for (int d = 0; d < 3; ++d)
        v.spin[b][d] = before.spin[b][d] + *in++;
    }
}

template <int dim>
void
Delassus<dim>::synchronise_blocks(LaneVelocities<dim> &v, const LaneVelocities<dim> &before)
{
  blocks->copies.average_change(v.nodes, before.nodes);
  if (blocks->n_bodies() == 0)
    return;
  constexpr unsigned int n_values = dim + 3;
  std::vector<ExactSum>  sums(n_values * blocks->n_bodies());
  for (unsigned int copy = 0; copy < v.rigid.size(); ++copy)
    {
      ExactSum *const sum = &sums[n_values * blocks->body(copy)];
      for (int d = 0; d < dim; ++d)
        sum[d].add(v.rigid[copy][d] - before.rigid[copy][d]);
      for (int d = 0; d < 3; ++d)
        sum[dim + d].add(v.spin[copy][d] - before.spin[copy][d]);
    }
  ExactSum::sum(sums, communicator);
  for (unsigned int copy = 0; copy < v.rigid.size(); ++copy)
    {
      const ExactSum *const sum = &sums[n_values * blocks->body(copy)];
      for (int d = 0; d < dim; ++d)
        v.rigid[copy][d] = before.rigid[copy][d] + sum[d].value() / rigid_multiplicity[copy];
      for (int d = 0; d < 3; ++d)
        v.spin[copy][d] = before.spin[copy][d] + sum[dim + d].value() / rigid_multiplicity[copy];
    }
}

template class Delassus<2>;
template class Delassus<3>;
} // namespace coracle::contact
