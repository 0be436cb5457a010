// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exact_sum.h>
#include <coracle/contact/momentum.h>

#include <cmath>

namespace coracle::contact
{
namespace
{
/// The first rest, how much later each next one begins, and its length, in iterations so far.
constexpr unsigned int first_rest  = 40;
constexpr double       rest_growth = 1.5, rest_part = 0.1;

/// a += theta * (a - last), and last becomes what a was.
template <typename Value>
void
move_on(const double theta, Value &a, Value &last)
{
  const Value now = a;
  a += theta * (now - last);
  last = now;
}

/// last += sign * a.
template <typename Value>
void
add(const double sign, const std::vector<Value> &a, std::vector<Value> &last)
{
  for (std::size_t i = 0; i < a.size(); ++i)
    last[i] += sign * a[i];
}
} // namespace

template <int dim>
void
Momentum<dim>::restart(const std::vector<Lanes<dim>> &impulses, const LaneVelocities<dim> &v)
{
  t             = 1;
  iteration     = 0;
  rest_begin    = first_rest;
  rest_end      = 0;
  last          = impulses;
  start         = impulses;
  last_velocity = v;
}

template <int dim>
double
Momentum<dim>::turn(const Delassus<dim>             &delassus,
                    const std::vector<unsigned int> &contacts,
                    const std::vector<Lanes<dim>>   &impulses) const
{
  double      result = 0;
  const auto &rows   = delassus.rows();
  for (const unsigned int c : contacts)
    result += rows[c].normal_inverse_mass * dot<dim>(start[c] - impulses[c], impulses[c] - last[c]);
  return result;
}

template <int dim>
double
Momentum<dim>::turn_of_all(const Delassus<dim>             &delassus,
                           const std::vector<unsigned int> &contacts,
                           const std::vector<Lanes<dim>>   &impulses,
                           MPI_Comm                         communicator) const
{
  std::vector<double> terms;
  const auto         &rows = delassus.rows();
  for (const unsigned int c : contacts)
    terms.push_back(rows[c].normal_inverse_mass *
                    dot<dim>(start[c] - impulses[c], impulses[c] - last[c]));
  return exact_sum(terms, communicator);
}

template <int dim>
void
Momentum<dim>::advance(const bool                 turned,
                       const ActiveContacts<dim> &active,
                       std::vector<Lanes<dim>>   &impulses,
                       LaneVelocities<dim>       &v)
{
  ++iteration;
  const bool was_resting = iteration <= rest_end;
  if (iteration == rest_begin)
    {
      make_relative(-1, impulses, v);
      rest_end   = iteration + static_cast<unsigned int>(rest_part * iteration);
      rest_begin = rest_end + static_cast<unsigned int>((rest_growth - 1) * iteration);
    }
  if (resting())
    return;
  if (was_resting)
    make_relative(1, impulses, v);
  // Directions before and after a rest cannot be compared.
  extrapolate(turned && !was_resting, active, impulses, v);
}

template <int dim>
void
Momentum<dim>::make_relative(const double                   sign,
                             const std::vector<Lanes<dim>> &impulses,
                             const LaneVelocities<dim>     &v)
{
  add(sign, impulses, last);
  add(sign, v.nodes, last_velocity.nodes);
  add(sign, v.rigid, last_velocity.rigid);
  add(sign, v.spin, last_velocity.spin);
}

template <int dim>
void
Momentum<dim>::extrapolate(const bool                 turned,
                           const ActiveContacts<dim> &active,
                           std::vector<Lanes<dim>>   &impulses,
                           LaneVelocities<dim>       &v)
{
  const double next  = (turned ? 1. : 0.5 * (1 + std::sqrt(1 + 4 * t * t))),
               theta = (turned ? 0. : (t - 1) / next);
  t                  = next;
  for (const unsigned int c : active.contacts())
    {
      move_on(theta, impulses[c], last[c]);
      start[c] = impulses[c];
    }
  for (const unsigned int i : active.nodes())
    move_on(theta, v.nodes[i], last_velocity.nodes[i]);
  for (unsigned int b = 0; b < v.rigid.size(); ++b)
    {
      move_on(theta, v.rigid[b], last_velocity.rigid[b]);
      move_on(theta, v.spin[b], last_velocity.spin[b]);
    }
}

template <int dim>
void
Momentum<dim>::stop(Delassus<dim>                   &delassus,
                    const std::vector<unsigned int> &contacts,
                    const std::vector<Lanes<dim>>   &impulses,
                    LaneVelocities<dim>             &before)
{
  delassus.copy_shared(last_velocity, delassus.shared_nodes(), before);
  for (const unsigned int c : contacts)
    {
      const Lanes<dim> d = direction(c, impulses);
      if (dot<dim>(d, d) > 0)
        delassus.apply(delassus.rows()[c], d, last_velocity);
      last[c]  = (resting() ? Lanes<dim>{} : impulses[c]);
      start[c] = impulses[c];
    }
  double unused = 0;
  delassus.synchronise(last_velocity, before, unused);
}

template class Momentum<2>;
template class Momentum<3>;
} // namespace coracle::contact
