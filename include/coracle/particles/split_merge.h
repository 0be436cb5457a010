// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/particles/material_points.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/tensor.h>

namespace coracle
{
/**
 * One particle becomes 2^dim, which fill its box, or several become one.
 *
 * A particle stands for a box of its size with the velocity v + C (x - x_p), where C is its affine
 * velocity (APIC) or 0 (FLIP). Mass, momentum and angular momentum of this motion,
 *
 *   sum m,   sum m v,   sum m (x_p x v + axial vector of T),  T = s^2/12 C,
 *
 * stay what they were to round-off, and so does the centre of mass. Density, stress, history and
 * deformation gradient are copied to children, and averaged by volume when particles merge, so that
 * the volume is kept as well.
 *
 * Merged particles lie at the centre of mass of their group and have its velocity. What turned
 * within a group is lost by that. With C the merged particle takes it as its own turning. Without,
 * all groups that are merged together (those of one cell) take it as a common rotation about their
 * centre.
 */
template <int dim>
class SplitMerge
{
public:
  static constexpr unsigned int n_children = 1u << dim;

  /// Half of the distance between children, by direction [m].
  using Arm = dealii::Tensor<1, dim>;

  /// Rows are appended behind the others and in no cell yet: the caller sorts.
  explicit SplitMerge(MaterialPoints<dim> &points) : points(points) {}

  /// Of a particle in a box: a quarter of its size, less where it is nearer to a face of the box.
  static Arm arm(const MaterialPoints<dim>      &points,
                 const std::size_t               row,
                 const dealii::BoundingBox<dim> &box);

  static dealii::Point<dim>
  child_place(const dealii::Point<dim> &parent, const Arm &arm, const unsigned int child)
  {
    dealii::Point<dim> x = parent;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] += ((child >> d) & 1 ? 1. : -1.) * arm[d];
    return x;
  }

  /// The row becomes the first child and keeps its id; the others have ids from `first_id` on. With
  /// affine velocity the arm must be a quarter of the size.
  void split(const std::size_t row, const Arm &arm, const std::uint64_t first_id);

  /**
   * Merge each group of rows; all of one list share their turning. The merged particle is in the
   * group's first row and has its least id, the others become holes.
   * @return false, and nothing is done, if the merged particles cannot take the turning over: where
   *         there is but one of them, they are in a line, or it would cost more energy than merging
   * loses
   */
  bool merge(const std::vector<std::vector<unsigned int>> &groups);

  /// Kinetic energy lost so far by what this object did [J].
  double          lost_energy() const { return lost.value(); }
  const ExactSum &lost_energy_sum() const { return lost; }

private:
  using Layout = ParticleLayout<dim>;
  /// First moment of velocity, T[i][j] = sum m v_i x_j.
  using Moment = dealii::Tensor<2, dim>;

  struct Merged
  {
    double                 mass = 0, volume = 0, box = 0;
    dealii::Point<dim>     place;
    dealii::Tensor<1, dim> velocity;
    Moment                 turning, affine;
    /// Relative to the centre [J].
    double        energy = 0;
    std::uint64_t id     = 0;
  };

  dealii::Tensor<1, dim> velocity(const std::size_t row) const;
  Moment                 affine(const std::size_t row) const;
  Merged                 sum_up(const std::vector<unsigned int> &group) const;
  bool                   turn_alone(Merged &merged) const;
  static bool            turn_together(std::vector<Merged> &merged);
  void                   store(const Merged &merged, const std::vector<unsigned int> &group);

  MaterialPoints<dim> &points;
  ExactSum             lost;
};
} // namespace coracle
