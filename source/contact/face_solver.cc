// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/face_solver.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
/// The residual on the face is brought down to this part before the next sweep.
constexpr double       reduction   = 0.05;
constexpr unsigned int least_steps = 4;
constexpr unsigned int most_steps  = 64;
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
  n_steps   = least_steps;
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
  const auto &rows = delassus.rows();
  static bool have = false; (void)have;
  unsigned int steps = 0;
  if (stiffness == 1)
    {
      for (std::size_t c = 0; c < rows.size(); ++c) direction[c] = rows[c].fixed ? Vector() : (1.+0.3*((c*2654435761u>>7)%17-8.)/8.)*rows[c].normal;
      for (int k = 0; k < 12; ++k, ++steps)
        {
          respond(delassus, direction);
          double a=0,b=0;
          for (std::size_t c = 0; c < rows.size(); ++c) if(!rows[c].fixed){
            const double q = delassus.relative_velocity(rows[c], response) * rows[c].normal / rows[c].true_inverse_mass;
            const double d = direction[c]*rows[c].normal; a += q*q*rows[c].true_inverse_mass; b += d*d*rows[c].true_inverse_mass; direction[c] = q*rows[c].normal; }
          stiffness = std::sqrt(a/b);
          for (auto &d: direction) d /= stiffness;
        }
      stiffness *= 1.1;
    }
  std::vector<Vector> y = impulses;
  Velocities<dim> vy = v, vn;
  double t = 1;
  for (unsigned int k = 0; k < 60; ++k)
    {
      double s = 0, big = 0;
      for (std::size_t c = 0; c < rows.size(); ++c)
        {
          change[c]=Vector(); if (rows[c].fixed) continue;
          const Vector next = next_impulse<dim>(rows[c], y[c], delassus.relative_velocity(rows[c], vy), target[c], friction, 1/stiffness*rows[c].normal_inverse_mass/rows[c].true_inverse_mass);
          change[c] = next - y[c];
          s -= (change[c]*(next-impulses[c]))*rows[c].true_inverse_mass;
          big = std::max(big, change[c].norm()*rows[c].true_inverse_mass*stiffness);
        }
      respond(delassus, change); ++steps;
      vn = vy; add_scaled(vn, 1., response);
      const double tn = 0.5*(1+std::sqrt(1+4*t*t));
      double beta = (t-1)/tn; t = tn;
      if (s > 0) { t = 1; beta = 0; }
      for (std::size_t c = 0; c < rows.size(); ++c)
        { const Vector next = y[c]+change[c]; y[c] = next + beta*(next-impulses[c]); impulses[c]=next; }
      vy = vn; add_scaled(vy, beta, vn); add_scaled(vy, -beta, v); v = vn;
      if (big < goal) break;
    }
  return steps;
}

template class FaceSolver<2>;
template class FaceSolver<3>;
} // namespace coracle::contact
