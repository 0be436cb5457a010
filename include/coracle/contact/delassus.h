// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/block_rows.h>
#include <coracle/contact/contact.h>
#include <coracle/contact/lanes.h>
#include <coracle/contact/rows.h>
#include <coracle/contact/shared_unknowns.h>

namespace coracle::contact
{
/// Velocities of all unknowns that contacts act on, or changes of them.
template <int dim>
struct LaneVelocities
{
  std::vector<Lanes<dim>>             nodes;
  std::vector<dealii::Tensor<1, dim>> rigid;
  std::vector<dealii::Tensor<1, 3>>   spin;
};

/**
 * The contacts' rows J and inverse masses M^-1, made ready for fast sweeps: the
 * relative velocity of a contact is u = J v, an impulse P on it changes v by
 * M^-1 J^T P. Sweeps need nothing of J M^-1 J^T but the blocks' diagonals.
 *
 * Where several ranks touch an unknown, each works with a part of its mass
 * (SharedUnknowns), and synchronise() brings the parts together.
 *
 * A rigid body is struck at the point, not at its surface below: so normal and
 * friction impulses have one line of action for both sides, and angular
 * momentum is conserved to round-off. Either side may be a rigid body.
 */
template <int dim>
class Delassus
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// One contact: what every sweep reads, a cache line. Entries of both sides are in a row, those
  /// of the facet with negative weight.
  struct Row
  {
    Lanes<dim> normal;
    /// Normal part of the change of u by a unit normal impulse [1/kg], and one over it.
    double         normal_inverse_mass;
    double         normal_mass;
    unsigned int   begin;
    unsigned short n_entries;
    /// Both sides are prescribed: no impulse can change anything.
    bool fixed;
    bool has_friction;
    /// Of each side, or -1.
    std::array<int, 2> rigid_body;
  };

  /// What friction needs of a contact besides.
  struct Sliding
  {
    /// Change of u by a unit normal impulse [1/kg].
    Lanes<dim> normal_response;
    /// A bound of the tangential block [1/kg].
    double tangential_inverse_mass;
    double friction;
  };

  /// Inverse masses of a contact as if no other rank touched the unknowns [1/kg].
  struct TrueMasses
  {
    double normal, tangential;
  };

  explicit Delassus(MPI_Comm communicator);

  /// Collective.
  void reinit(const std::vector<Contact<dim>>      &contacts,
              const Rows                           &rows,
              const std::vector<Unknown<dim>>      &unknowns,
              const std::vector<RigidUnknown<dim>> &rigid);

  /// The same for contacts in blocks, instead of those of each rank; the blocks must stay.
  void reinit(const std::vector<Contact<dim>> &contacts, BlockRows<dim> &blocks);

  const std::vector<Row> &rows() const { return list; }
  /// Of each contact.
  const Sliding &sliding(const std::size_t contact) const { return slidings[contact]; }
  const std::vector<TrueMasses> &true_inverse_masses() const { return true_masses; }

  /// Nodes that a contact acts on.
  const unsigned int *first_node(const Row &row) const { return entry_unknown.data() + row.begin; }
  const unsigned int *last_node(const Row &row) const { return first_node(row) + row.n_entries; }
  /// Nodes that other ranks (or blocks) have as well.
  const std::vector<unsigned int> &shared_nodes() const { return shared_list; }

  /// u = J v of one contact [m/s].
  Lanes<dim> relative_velocity(const Row &row, const LaneVelocities<dim> &v) const
  {
    // Four sums, so that additions need not wait for each other.
    Lanes<dim>                sum[4] = {};
    const unsigned int *const i      = entry_unknown.data() + row.begin;
    const double *const       weight = entry_weight.data() + row.begin;
    const unsigned int        whole  = row.n_entries & ~3u;
    for (unsigned int e = 0; e < whole; e += 4)
      for (unsigned int k = 0; k < 4; ++k)
        sum[k] += weight[e + k] * v.nodes[i[e + k]];
    for (unsigned int e = whole; e < row.n_entries; ++e)
      sum[0] += weight[e] * v.nodes[i[e]];
    Lanes<dim> u = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    for (unsigned int side = 0; side < 2; ++side)
      if (const int b = row.rigid_body[side]; b >= 0)
        u += to_lanes<dim>(sign(side) *
                           (v.rigid[b] + cross(v.spin[b], arms[&row - list.data()][side])));
    return u;
  }

  /// v += M^-1 J^T P for the impulse P [N s] of one contact.
  void apply(const Row &row, const Lanes<dim> &impulse, LaneVelocities<dim> &v) const
  {
    const unsigned int *const i      = entry_unknown.data() + row.begin;
    const double *const       weight = entry_weight.data() + row.begin;
    for (unsigned int e = 0; e < row.n_entries; ++e)
      v.nodes[i[e]] += (weight[e] * impulse) * inverse_mass[i[e]];
    for (unsigned int side = 0; side < 2; ++side)
      if (row.rigid_body[side] >= 0)
        apply_rigid(row, side, to_tensor<dim>(impulse), v);
  }

  /// Collective. Shared velocities change by what all ranks have done to them since `before`;
  /// `scalar` is summed over the ranks on the same occasion.
  void synchronise(LaneVelocities<dim> &v, const LaneVelocities<dim> &before, double &scalar);

  /// What synchronise() will need of v, from among these nodes and the rigid bodies.
  void copy_shared(const LaneVelocities<dim>       &v,
                   const std::vector<unsigned int> &nodes,
                   LaneVelocities<dim>             &before) const;

  /// The predicted velocities; and zeros of the same shape.
  LaneVelocities<dim> predicted;
  void                set_zero(LaneVelocities<dim> &v) const;

  /// omega x r; in 2-D the spin is about z.
  static Vector cross(const dealii::Tensor<1, 3> &spin, const Vector &arm);
  /// r x P; in 2-D only component 2.
  static dealii::Tensor<1, 3> torque(const Vector &arm, const Vector &impulse);

private:
  /// An impulse acts on the point, and the opposite on the facet.
  static constexpr double sign(const unsigned int side) { return side == 0 ? 1. : -1.; }
  void                    apply_rigid(const Row           &row,
                                      const unsigned int   side,
                                      const Vector        &impulse,
                                      LaneVelocities<dim> &v) const;
  void                    take_entries(const Rows &rows);
  void                    set_rows(const std::vector<Contact<dim>>      &contacts,
                                   const Rows                           &rows,
                                   const std::vector<Unknown<dim>>      &unknowns,
                                   const std::vector<RigidUnknown<dim>> &rigid);
  void                    count_ranks_of_bodies(const Rows &rows, const unsigned int n_bodies);
  void                    count_blocks_of_bodies();
  void                    share_rigid_bodies(const std::vector<RigidUnknown<dim>> &rigid);
  void         synchronise_blocks(LaneVelocities<dim> &v, const LaneVelocities<dim> &before);
  unsigned int multiplicity(const unsigned int unknown) const
  {
    return blocks != nullptr ? blocks->copies.multiplicity(unknown) : shared.multiplicity(unknown);
  }
  void prepare(Row &row, Sliding &slide, TrueMasses &masses) const;
  /// The largest eigenvalue of the tangential block, so that updates do not overshoot [1/kg].
  double tangential_inverse_mass(const Row &row, const bool split) const;
  /// Diagonal block times an impulse, with the split masses or the true ones.
  Vector response(const Row &row, const Vector &impulse, const bool split = true) const;

  MPI_Comm                  communicator;
  SharedUnknowns<dim>       shared;
  BlockRows<dim>           *blocks = nullptr;
  std::vector<Row>          list;
  std::vector<Sliding>      slidings;
  std::vector<TrueMasses>   true_masses;
  std::vector<unsigned int> entry_unknown, shared_list;
  std::vector<double>       entry_weight;
  std::vector<Lanes<dim>>   inverse_mass;
  /// From the centre of each side's rigid body to the point, if there are rigid bodies [m].
  std::vector<std::array<Vector, 2>> arms;
  std::vector<Vector>                rigid_inverse_mass;
  std::vector<dealii::Tensor<2, 3>>  rigid_inverse_inertia;
  std::vector<double>                rigid_multiplicity;
  std::vector<double>                buffer;
};
} // namespace coracle::contact
