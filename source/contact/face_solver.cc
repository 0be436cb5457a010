// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/face_solver.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
/// The residual on the face is brought down to this part before the next sweep.
constexpr double       reduction  = 0.05;
constexpr unsigned int most_steps = 40;
/// Length of the expansion step; it must stay below 2 for the true largest eigenvalue.
constexpr double expansion = 1.5;

/// Nearest impulse that pushes and does not exceed friction.
template <int dim>
dealii::Tensor<1, dim>
admissible(const typename Delassus<dim>::Row &row,
           const dealii::Tensor<1, dim>      &impulse,
           const bool                         friction)
{
  const double normal = impulse * row.normal;
  if (normal <= 0)
    return {};
  const dealii::Tensor<1, dim> tangential = impulse - normal * row.normal;
  const double limit = (friction ? row.friction * normal : 0.), size = tangential.norm();
  return normal * row.normal + (size > limit ? limit / size : 1.) * tangential;
}

template <int dim>
void
add_scaled(Velocities<dim> &v, const double factor, const Velocities<dim> &a)
{
  for (std::size_t i = 0; i < v.nodes.size(); ++i)
    v.nodes[i] += factor * a.nodes[i];
  for (std::size_t b = 0; b < v.rigid.size(); ++b)
    {
      v.rigid[b] += factor * a.rigid[b];
      v.spin[b] += factor * a.spin[b];
    }
}
} // namespace

template <int dim>
FaceSolver<dim>::FaceSolver(MPI_Comm communicator) : communicator(communicator)
{}

template <int dim>
void
FaceSolver<dim>::reinit(const Delassus<dim> &delassus)
{
  const auto &rows = delassus.rows();
  for (auto *list : {&direction, &remainder, &change})
    list->resize(rows.size());
  face.resize(rows.size());
  delassus.set_zero(zero);
  stiffness = 1;
}

template <int dim>
void
FaceSolver<dim>::find_face(const Delassus<dim>       &delassus,
                           const bool                 friction,
                           const std::vector<Vector> &impulses)
{
  const auto &rows = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      const double normal = impulses[c] * rows[c].normal;
      face[c]             = (rows[c].fixed || normal <= 0 ? Free::nothing : Free::normal);
      if (face[c] == Free::normal && friction && rows[c].friction > 0 &&
          (impulses[c] - normal * rows[c].normal).norm() < (1 - 1e-9) * rows[c].friction * normal)
        face[c] = Free::all;
    }
}

template <int dim>
dealii::Tensor<1, dim>
FaceSolver<dim>::restrict_to_face(const std::size_t c, const Vector &normal, const Vector &a) const
{
  switch (face[c])
    {
      case Free::nothing:
        return Vector();
      case Free::normal:
        return (a * normal) * normal;
      default:
        return a;
    }
}

template <int dim>
void
FaceSolver<dim>::respond(Delassus<dim> &delassus, const std::vector<Vector> &impulses)
{
  double unused = 0;
  response      = zero;
  for (std::size_t c = 0; c < impulses.size(); ++c)
    if (impulses[c].norm_square() > 0)
      delassus.apply(delassus.rows()[c], impulses[c], response);
  delassus.synchronise(response, zero, unused);
}

template <int dim>
void
FaceSolver<dim>::start_face(const Delassus<dim>       &delassus,
                            const std::vector<double> &target,
                            const bool                 friction,
                            const std::vector<Vector> &impulses,
                            const Velocities<dim>     &v)
{
  find_face(delassus, friction, impulses);
  const auto &rows = delassus.rows();
  rho = largest = 0;
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      direction[c] = remainder[c] = Vector();
      if (face[c] == Free::nothing)
        continue;
      const Vector wanted = target[c] * rows[c].normal - delassus.relative_velocity(rows[c], v);
      remainder[c]        = restrict_to_face(c, rows[c].normal, wanted);
      direction[c]        = remainder[c] / rows[c].true_inverse_mass;
      rho += remainder[c] * direction[c];
      largest = std::max(largest, remainder[c].norm());
    }
  MPI_Allreduce(MPI_IN_PLACE, &rho, 1, MPI_DOUBLE, MPI_SUM, communicator);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator);
}

template <int dim>
double
FaceSolver<dim>::admissible_length(const Delassus<dim>       &delassus,
                                   const bool                 friction,
                                   const std::vector<Vector> &impulses) const
{
  double      length = 1e300;
  const auto &rows   = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      if (face[c] == Free::nothing)
        continue;
      const double normal = impulses[c] * rows[c].normal, step = direction[c] * rows[c].normal;
      if (step < 0)
        length = std::min(length, -normal / step);
      if (!friction || rows[c].friction == 0)
        continue;
      // Where |P_t + s d_t| = mu (P_n + s d_n).
      const Vector tangential = impulses[c] - normal * rows[c].normal,
                   slide      = direction[c] - step * rows[c].normal;
      const double mu2        = rows[c].friction * rows[c].friction;
      const double A          = slide * slide - mu2 * step * step,
                   B          = tangential * slide - mu2 * normal * step,
                   C          = std::min(0., tangential * tangential - mu2 * normal * normal);
      const double root       = B * B - A * C;
      if (root >= 0)
        {
          const double q = -(B + std::copysign(std::sqrt(root), B));
          for (const double s : {A != 0 ? q / A : -1., q != 0 ? C / q : -1.})
            if (s > 0)
              length = std::min(length, s);
        }
    }
  MPI_Allreduce(MPI_IN_PLACE, &length, 1, MPI_DOUBLE, MPI_MIN, communicator);
  return length;
}

template <int dim>
bool
FaceSolver<dim>::take_step(Delassus<dim>       &delassus,
                           const bool           friction,
                           std::vector<Vector> &impulses,
                           Velocities<dim>     &v)
{
  const auto &rows = delassus.rows();
  respond(delassus, direction);
  double sums[2] = {0, 0};
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (face[c] != Free::nothing)
      {
        change[c] =
          restrict_to_face(c, rows[c].normal, delassus.relative_velocity(rows[c], response));
        sums[0] += direction[c] * change[c];
        sums[1] += direction[c] * direction[c] * rows[c].true_inverse_mass;
      }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, communicator);
  if (!(sums[0] > 0))
    return false;
  stiffness          = std::max(stiffness, sums[0] / sums[1]);
  const double whole = rho / sums[0], allowed = admissible_length(delassus, friction, impulses);
  if (allowed < whole)
    {
      // Cut short contact by contact instead of all together.
      for (std::size_t c = 0; c < rows.size(); ++c)
        {
          change[c] = Vector();
          if (face[c] == Free::nothing)
            continue;
          const Vector next =
            admissible<dim>(rows[c], impulses[c] + whole * direction[c], friction);
          change[c]   = next - impulses[c];
          impulses[c] = next;
        }
      respond(delassus, change);
      add_scaled(v, 1., response);
      return false;
    }
  const double length  = whole;
  double       next[2] = {0, 0};
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (face[c] != Free::nothing)
      {
        impulses[c] += length * direction[c];
        if (impulses[c] * rows[c].normal <= 0)
          impulses[c] = Vector();
        remainder[c] -= length * change[c];
        next[0] += remainder[c].norm_square() / rows[c].true_inverse_mass;
        next[1] = std::max(next[1], remainder[c].norm_square());
      }
  add_scaled(v, length, response);
  MPI_Allreduce(MPI_IN_PLACE, &next[0], 1, MPI_DOUBLE, MPI_SUM, communicator);
  MPI_Allreduce(MPI_IN_PLACE, &next[1], 1, MPI_DOUBLE, MPI_MAX, communicator);
  const double beta = next[0] / rho;
  rho               = next[0];
  largest           = std::sqrt(next[1]);
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (face[c] != Free::nothing)
      direction[c] = remainder[c] / rows[c].true_inverse_mass + beta * direction[c];
  return true;
}

template <int dim>
void
FaceSolver<dim>::expand(Delassus<dim>             &delassus,
                        const std::vector<double> &target,
                        const bool                 friction,
                        std::vector<Vector>       &impulses,
                        Velocities<dim>           &v)
{
  const auto &rows = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      change[c] = Vector();
      if (rows[c].fixed)
        continue;
      // Masses are true here, not split among ranks.
      const double share =
        expansion / stiffness * rows[c].normal_inverse_mass / rows[c].true_inverse_mass;
      const Vector next = next_impulse<dim>(
        rows[c], impulses[c], delassus.relative_velocity(rows[c], v), target[c], friction, share);
      change[c]   = next - impulses[c];
      impulses[c] = next;
    }
  respond(delassus, change);
  add_scaled(v, 1., response);
}

template <int dim>
unsigned int
FaceSolver<dim>::improve(Delassus<dim>             &delassus,
                         const std::vector<double> &target,
                         const bool                 friction,
                         const double               goal,
                         std::vector<Vector>       &impulses,
                         Velocities<dim>           &v)
{
  start_face(delassus, target, friction, impulses, v);
  const double enough = reduction * reduction * rho;
  unsigned int steps  = 0;
  while (steps < most_steps && rho > enough && largest > goal)
    {
      ++steps;
      if (!take_step(delassus, friction, impulses, v))
        {
          expand(delassus, target, friction, impulses, v);
          start_face(delassus, target, friction, impulses, v);
          ++steps;
        }
    }
  return steps;
}

template class FaceSolver<2>;
template class FaceSolver<3>;
} // namespace coracle::contact
