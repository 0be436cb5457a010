// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/face_solver.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// The residual on the face is brought down to this part before the next sweep.
constexpr double       reduction     = 0.03;
constexpr unsigned int least_steps   = 4;
constexpr unsigned int most_steps    = 64;
constexpr unsigned int most_attempts = 3;

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
double
FaceSolver<dim>::sum(double a) const
{
  MPI_Allreduce(MPI_IN_PLACE, &a, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return a;
}

template <int dim>
void
FaceSolver<dim>::reinit(const Delassus<dim> &delassus, const Velocities<dim> &free)
{
  const auto &rows = delassus.rows();
  n_steps          = 2 * least_steps;
  free_velocity.resize(rows.size());
  for (std::size_t c = 0; c < rows.size(); ++c)
    free_velocity[c] = delassus.relative_velocity(rows[c], free);
  for (auto *list : {&way, &direction, &remainder, &trial, &change})
    list->resize(rows.size());
  face.resize(rows.size());
  delassus.set_zero(zero);
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
FaceSolver<dim>::respond(Delassus<dim>             &delassus,
                         const std::vector<Vector> &impulses,
                         Velocities<dim>           &result)
{
  double unused = 0;
  result        = zero;
  for (std::size_t c = 0; c < impulses.size(); ++c)
    if (impulses[c].norm_square() > 0)
      delassus.apply(delassus.rows()[c], impulses[c], result);
  delassus.synchronise(result, zero, unused);
}

template <int dim>
double
FaceSolver<dim>::energy(const Delassus<dim>       &delassus,
                        const std::vector<double> &target,
                        const std::vector<Vector> &impulses,
                        const Velocities<dim>     &v) const
{
  double      result = 0;
  const auto &rows   = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    result += impulses[c] * (0.5 * (delassus.relative_velocity(rows[c], v) + free_velocity[c]) -
                             target[c] * rows[c].normal);
  return sum(result);
}

template <int dim>
unsigned int
FaceSolver<dim>::conjugate_gradients(Delassus<dim>             &delassus,
                                     const std::vector<double> &target,
                                     const Velocities<dim>     &v)
{
  const auto &rows = delassus.rows();
  double      rho  = 0;
  for (std::size_t c = 0; c < rows.size(); ++c)
    {
      const Vector wanted = target[c] * rows[c].normal - delassus.relative_velocity(rows[c], v);
      way[c]              = Vector();
      remainder[c]        = restrict_to_face(c, rows[c].normal, wanted);
      direction[c] =
        (face[c] == Free::nothing ? Vector() : remainder[c] / rows[c].true_inverse_mass);
      rho += remainder[c] * direction[c];
    }
  rho                = sum(rho);
  const double goal  = reduction * reduction * rho;
  unsigned int steps = 0;
  while (steps < n_steps && rho > goal)
    {
      respond(delassus, direction, response);
      double curvature = 0;
      for (std::size_t c = 0; c < rows.size(); ++c)
        if (face[c] != Free::nothing)
          {
            change[c] =
              restrict_to_face(c, rows[c].normal, delassus.relative_velocity(rows[c], response));
            curvature += direction[c] * change[c];
          }
      curvature = sum(curvature);
      if (curvature <= 0)
        break;
      const double length = rho / curvature;
      double       next   = 0;
      for (std::size_t c = 0; c < rows.size(); ++c)
        if (face[c] != Free::nothing)
          {
            way[c] += length * direction[c];
            remainder[c] -= length * change[c];
            next += remainder[c].norm_square() / rows[c].true_inverse_mass;
          }
      next              = sum(next);
      const double beta = next / rho;
      for (std::size_t c = 0; c < rows.size(); ++c)
        if (face[c] != Free::nothing)
          direction[c] = remainder[c] / rows[c].true_inverse_mass + beta * direction[c];
      rho = next;
      ++steps;
    }
  return steps;
}

template <int dim>
unsigned int
FaceSolver<dim>::improve(Delassus<dim>             &delassus,
                         const std::vector<double> &target,
                         const bool                 friction,
                         std::vector<Vector>       &impulses,
                         Velocities<dim>           &v)
{
  const auto &rows = delassus.rows();
  find_face(delassus, friction, impulses);
  unsigned int steps  = conjugate_gradients(delassus, target, v);
  const double before = energy(delassus, target, impulses, v);
  double       share  = 1;
  for (unsigned int attempt = 0; attempt < most_attempts; ++attempt, share *= 0.4)
    {
      for (std::size_t c = 0; c < rows.size(); ++c)
        {
          trial[c]            = impulses[c] + share * way[c];
          const double normal = trial[c] * rows[c].normal;
          if (normal <= 0)
            trial[c] = Vector();
          else if (face[c] != Free::nothing)
            {
              Vector       tangential = trial[c] - normal * rows[c].normal;
              const double limit = rows[c].friction * normal, size = tangential.norm();
              trial[c] = normal * rows[c].normal + (size > limit ? limit / size : 1.) * tangential;
            }
          change[c] = trial[c] - impulses[c];
        }
      respond(delassus, change, response);
      ++steps;
      moved = v;
      add_scaled(moved, 1., response);
      if (energy(delassus, target, trial, moved) <= before)
        {
          impulses.swap(trial);
          std::swap(v, moved);
          n_steps = (share == 1 ? std::min(most_steps, 2 * n_steps) : n_steps);
          return steps;
        }
      n_steps = std::max(least_steps, n_steps / 2);
    }
  return steps;
}

template class FaceSolver<2>;
template class FaceSolver<3>;
} // namespace coracle::contact
