// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact.h>
#include <coracle/contact/rows.h>
#include <coracle/contact/shared_unknowns.h>

namespace coracle::contact
{
/// Velocities of all unknowns that contacts act on, or changes of them.
template <int dim>
struct Velocities
{
  std::vector<dealii::Tensor<1, dim>> nodes;
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

  /// One contact; entries of both sides in a row, those of the facet with negative weight.
  struct Row
  {
    std::size_t begin, end;
    /// Of each side, or -1.
    std::array<int, 2> rigid_body;
    Vector             normal;
    /// From the centre of each side's rigid body to the point [m].
    std::array<Vector, 2> arm;
    /// Change of u by a unit normal impulse [1/kg], its normal part, and a bound of the tangential
    /// block.
    Vector normal_response;
    double normal_inverse_mass;
    double tangential_inverse_mass;
    /// The same with the true masses, as if no other rank touched the unknowns [1/kg].
    double true_inverse_mass;
    double true_tangential_inverse_mass;
    double friction;
    /// Both sides are prescribed: no impulse can change anything.
    bool fixed;
  };

  explicit Delassus(MPI_Comm communicator);

  /// Collective.
  void reinit(const std::vector<Contact<dim>>      &contacts,
              const Rows                           &rows,
              const std::vector<Unknown<dim>>      &unknowns,
              const std::vector<RigidUnknown<dim>> &rigid);

  const std::vector<Row> &rows() const { return list; }

  /// u = J v of one contact [m/s].
  Vector relative_velocity(const Row &row, const Velocities<dim> &v) const
  {
    Vector u;
    for (std::size_t e = row.begin; e < row.end; ++e)
      u += entries[e].weight * v.nodes[entries[e].unknown];
    for (unsigned int side = 0; side < 2; ++side)
      if (const int b = row.rigid_body[side]; b >= 0)
        u += sign(side) * (v.rigid[b] + cross(v.spin[b], row.arm[side]));
    return u;
  }

  /// v += M^-1 J^T P for the impulse P [N s] of one contact.
  void apply(const Row &row, const Vector &impulse, Velocities<dim> &v) const
  {
    for (std::size_t e = row.begin; e < row.end; ++e)
      {
        const unsigned int i = entries[e].unknown;
        for (int d = 0; d < dim; ++d)
          v.nodes[i][d] += entries[e].weight * inverse_mass[i][d] * impulse[d];
      }
    for (unsigned int side = 0; side < 2; ++side)
      if (row.rigid_body[side] >= 0)
        apply_rigid(row, side, impulse, v);
  }

  /// Collective. Shared velocities change by what all ranks have done to them since `before`;
  /// `scalar` is summed over the ranks on the same occasion.
  void synchronise(Velocities<dim> &v, const Velocities<dim> &before, double &scalar);

  /// The predicted velocities; and zeros of the same shape.
  Velocities<dim> predicted;
  void            set_zero(Velocities<dim> &v) const;

  /// omega x r; in 2-D the spin is about z.
  static Vector cross(const dealii::Tensor<1, 3> &spin, const Vector &arm);
  /// r x P; in 2-D only component 2.
  static dealii::Tensor<1, 3> torque(const Vector &arm, const Vector &impulse);

private:
  /// An impulse acts on the point, and the opposite on the facet.
  static constexpr double sign(const unsigned int side) { return side == 0 ? 1. : -1.; }
  void                    apply_rigid(const Row         &row,
                                      const unsigned int side,
                                      const Vector      &impulse,
                                      Velocities<dim>   &v) const;
  void share_rigid_bodies(const Rows &rows, const std::vector<RigidUnknown<dim>> &rigid);
  void prepare(Row &row) const;
  /// The largest eigenvalue of the tangential block, so that updates do not overshoot [1/kg].
  double tangential_inverse_mass(const Row &row, const bool split) const;
  /// Diagonal block times an impulse, with the split masses or the true ones.
  Vector response(const Row &row, const Vector &impulse, const bool split = true) const;

  MPI_Comm                          communicator;
  SharedUnknowns<dim>               shared;
  std::vector<Row>                  list;
  std::vector<Rows::Entry>          entries;
  std::vector<Vector>               inverse_mass;
  std::vector<Vector>               rigid_inverse_mass;
  std::vector<dealii::Tensor<2, 3>> rigid_inverse_inertia;
  std::vector<double>               rigid_multiplicity;
  std::vector<double>               buffer;
};
} // namespace coracle::contact
