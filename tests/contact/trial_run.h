// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trial_scene.h"

/// The steps of a random scene, see trial_scene.h.
namespace trial
{
template <int dim>
dealii::Point<dim>
Scene<dim>::place_at(const unsigned int node, const double t) const
{
  const auto &m     = motions[group[node]];
  const auto  limit = [](const double value, const double largest) {
    return largest > 0 ? largest * std::sin(value / largest) : value;
  };
  double angle = limit(m.rate * t, m.largest_angle);
  if (m.twist_length > 0)
    {
      double along = 0;
      for (int d = 0; d < dim; ++d)
        along += drawn[node][d] * m.axis[d];
      angle *= along / m.twist_length;
    }
  const double v = m.velocity.norm(), shift = (v > 0 ? limit(v * t, m.largest_shift) / v : 0.);
  // A plate that has come as near as it shall stays there.
  const double held =
    (m.largest_shift > 0 && name == "closing" ? std::min(t, 0.5 * M_PI * m.largest_shift / v) : t);
  if (held < t)
    return place_at(node, held);
  return m.pivot + turned<dim>(rotation(m.axis, angle), drawn[node] - m.pivot) + shift * m.velocity;
}

template <int dim>
void
Scene<dim>::predict_surface()
{
  const auto kind_of = [&](const unsigned int i) { return motions[group[i]].kind; };
  using Kind         = typename GroupMotion<dim>::Kind;
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    {
      auto &node = surface.nodes[i];
      if (kind_of(i) == Kind::prescribed)
        {
          // As rigid bodies tell it: tangential to the circle at the start of the step.
          const double small = 1e-4 * dt;
          node.velocity = (place_at(i, time + small) - place_at(i, time - small)) / (2 * small);
        }
      else if (kind_of(i) == Kind::rigid)
        node.velocity =
          rigid[0].velocity + Delassus<dim>::cross(rigid[0].spin, node.position - rigid[0].centre);
      else
        {
          node.velocity += 0.04 / dt * (drawn[i] - node.position) - 0.05 * node.velocity;
          for (int d = 0; d < dim; ++d)
            node.inverse_mass[d] = 1 / node_mass;
        }
    }
  if (motions[0].kind == Kind::springs)
    {
      const auto pull = pull_of_edges(surface, drawn);
      for (unsigned int i = 0; i < surface.nodes.size(); ++i)
        surface.nodes[i].velocity += 0.03 / dt * pull[i];
    }
}

template <int dim>
std::vector<PointSet<dim>>
Scene<dim>::sets()
{
  return {points.set()};
}

template <int dim>
void
Scene<dim>::contact_step()
{
  auto all = sets();
  contacts.find(surface, all, dt);
  contacts.build_rows(
    [this](const unsigned int, const unsigned int p, std::vector<Rows::Entry> &entries) {
      points.for_each_node(points.x(p), [&](const unsigned int node, const double weight) {
        entries.push_back({node, weight});
      });
    },
    [this](const unsigned int node) { return points.unknown(node); });
  contacts.solve(rigid, dt);
  contacts.point_impulses([this](const unsigned int node, const Vector &p, const Vector &c) {
    points.add_impulse(node, p, c);
  });
}

template <int dim>
void
Scene<dim>::move_surface(const std::vector<Vector> &impulse, const std::vector<Vector> &correction)
{
  using Kind = typename GroupMotion<dim>::Kind;
  if (!rigid.empty())
    {
      auto       &body = rigid[0];
      const auto &sums = contacts.rigid_impulses()[0];
      for (int d = 0; d < dim; ++d)
        body.velocity[d] += body.inverse_mass[d] * sums.impulse[d];
      body.spin += body.inverse_inertia * sums.moment;
      const auto   turn  = body.inverse_inertia * sums.correction_moment + dt * body.spin;
      const double angle = turn.norm();
      const auto   r     = rotation(angle > 0 ? turn / angle : turn, angle);
      const auto   old   = body.centre;
      body.centre += dt * body.velocity;
      for (int d = 0; d < dim; ++d)
        body.centre[d] += body.inverse_mass[d] * sums.correction[d];
      for (auto &node : surface.nodes)
        node.position = body.centre + turned<dim>(r, node.position - old);
      return;
    }
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    {
      auto &node = surface.nodes[i];
      if (motions[group[i]].kind == Kind::prescribed)
        node.position = place_at(i, time + dt);
      else
        for (int d = 0; d < dim; ++d)
          {
            node.velocity[d] += node.inverse_mass[d] * impulse[i][d];
            node.position[d] += dt * node.velocity[d] + node.inverse_mass[d] * correction[i][d];
          }
    }
}

template <int dim>
void
Scene<dim>::step()
{
  // Every rank has all nodes and publishes its share of the facets.
  points.gather(dt);
  predict_surface();
  const auto all_facets = surface.facets;
  surface.facets.erase(std::remove_if(surface.facets.begin(),
                                      surface.facets.end(),
                                      [this](const auto &f) {
                                        return int(f.key % n_ranks_) != rank;
                                      }),
                       surface.facets.end());
  contact_step();
  std::vector<Vector> impulse(surface.nodes.size()), correction(surface.nodes.size());
  contacts.surface_impulses(impulse, correction);
  sum_over_ranks(impulse, communicator);
  sum_over_ranks(correction, communicator);

  points.move(dt);
  move_surface(impulse, correction);
  auto all = sets();
  contacts.resolve_in_time(surface, all, points.ends());
  points.take_positions();
  all                       = sets();
  const unsigned long found = contacts.audit(surface, all);
  if (verbose && found > 0)
    for (const auto &c : contacts.first_crossings())
      std::cout << "    step " << outcome.steps << " point " << c.id << " at " << c.place
                << ", time " << c.time << ", body " << c.body << ", facet " << c.facet_key
                << std::endl;
  surface.facets = all_facets;
  time += dt;
  ++outcome.steps;
  outcome.crossings += found;
  outcome.resolved = contacts.report().n_resolved;
  outcome.failed   = contacts.report().n_failed;
  outcome.contacts += contacts.report().n_contacts;
  const auto &solved = contacts.report().solver;
  outcome.unconverged += !solved.velocity.converged;
  if (verbose && rank == 0 && !solved.velocity.converged)
    std::cout << "    step " << outcome.steps << " not converged: " << solved.n_contacts
              << " contacts, residual " << solved.velocity.residual / solved.scale
              << " of the approach speed, violation " << solved.worst_violation / solved.scale
              << std::endl;
}

template <int dim>
Outcome
Scene<dim>::run()
{
  for (unsigned int k = 0; k < n_steps; ++k)
    step();
  outcome.points = points.n_over_ranks();
  return outcome;
}
} // namespace trial
