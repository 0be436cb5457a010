// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/momentum.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
/// a += theta * (a - last), and last becomes what a was.
template <typename Value>
void
move_on(const double theta, std::vector<Value> &a, std::vector<Value> &last)
{
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      const Value now = a[i];
      a[i] += theta * (now - last[i]);
      last[i] = now;
    }
}
} // namespace

template <int dim>
void
Momentum<dim>::restart(const std::vector<Vector> &impulses, const Velocities<dim> &v)
{
  t             = 1;
  last          = impulses;
  start         = impulses;
  last_velocity = v;
}

template <int dim>
double
Momentum<dim>::turn(const Delassus<dim> &delassus, const std::vector<Vector> &impulses) const
{
  double      result = 0;
  const auto &rows   = delassus.rows();
  for (std::size_t c = 0; c < rows.size(); ++c)
    result += rows[c].normal_inverse_mass * ((start[c] - impulses[c]) * (impulses[c] - last[c]));
  return result;
}

template <int dim>
void
Momentum<dim>::extrapolate(const bool turned, std::vector<Vector> &impulses, Velocities<dim> &v)
{
  const double next  = (turned ? 1. : 0.5 * (1 + std::sqrt(1 + 4 * t * t))),
               theta = (turned ? 0. : (t - 1) / next);
  t                  = next;
  move_on(theta, impulses, last);
  move_on(theta, v.nodes, last_velocity.nodes);
  move_on(theta, v.rigid, last_velocity.rigid);
  move_on(theta, v.spin, last_velocity.spin);
  start = impulses;
}

template class Momentum<2>;
template class Momentum<3>;
} // namespace coracle::contact
