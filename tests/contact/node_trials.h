// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trial_scene.h"

/**
 * Random scenes of structures that fly into each other, on any number of ranks:
 * closed bodies and sheets, deformable (free nodes with springs along edges, self contact) or
 * rigid. After contact everything is moved on by random ways that contact has
 * not foreseen, as large as facets, so that nodes are lost unless the continuous check holds them.
 */
namespace trial
{
template <int dim>
class NodeScene
{
public:
  using Vector = dealii::Tensor<1, dim>;

  /// @param check is the continuous check on?
  NodeScene(const unsigned long seed, const bool check, MPI_Comm communicator);

  Outcome     run();
  std::string description() const;

private:
  enum class Motion
  {
    deformable,
    rigid,
    prescribed
  };
  /// What a body's nodes, first to last, do.
  struct Body
  {
    Motion                               motion;
    unsigned int                         first, last;
    std::vector<unsigned int>            points;
    std::vector<std::uint64_t>           keys;
    std::array<std::vector<double>, dim> position, velocity;
    std::vector<std::vector<double>>     side;
    /// Of a rigid one: its way and turn in this step, and the part of them that it goes.
    Vector               way;
    dealii::Tensor<1, 3> turn;
    double               part = 1;
    dealii::Point<dim>   centre;
  };

  void add_body(const dealii::Point<dim> &centre);
  void add_shape(const bool closed, const bool triangles, const dealii::Point<dim> &centre);
  void predict();
  std::vector<PointSet<dim>> sets();
  void                       move();
  void                       place_rigid(const Body &body);
  bool                       change(const EndChanges<dim> &changes);
  void                       step();
  Vector                     random_way(const double length);

  MPI_Comm                       communicator;
  int                            rank, n_ranks_;
  Random                         random;
  ContactOptions                 options;
  Surface<dim>                   surface;
  std::vector<Body>              bodies;
  std::vector<RigidUnknown<dim>> rigid;
  /// Nodes as drawn, at the start of the step, and where they end.
  std::vector<dealii::Point<dim>>     drawn, start;
  unsigned int                        n_sheets = 0;
  double                              size, speed, surprise, thickness;
  std::unique_ptr<ContactSystem<dim>> contacts;
  Outcome                             outcome;
};

template <int dim>
NodeScene<dim>::NodeScene(const unsigned long seed, const bool check, MPI_Comm communicator)
  : communicator(communicator)
  , rank(my_rank(communicator))
  , n_ranks_(n_ranks(communicator))
  , random(104729 * seed + dim)
{
  options.continuous_check = check;
  contacts                 = std::make_unique<ContactSystem<dim>>(options, communicator);
  // In space fewer and coarser bodies, because they take longer.
  const bool plane         = (dim == 2);
  size                     = random.uniform(0.1, 0.4) * (plane ? 1. : 1.5);
  speed                    = size * random.log_uniform(plane ? 0.05 : 0.2, 1.);
  surprise                 = size * random.log_uniform(0.03, plane ? 0.5 : 0.2);
  thickness                = random.chance(0.5) ? 0. : random.uniform(0.002, 0.1);
  const unsigned int n     = 2 + random.integer(plane ? 3 : 1);
  const double       apart = 2.2 + thickness;
  for (unsigned int b = 0; b < n; ++b)
    {
      dealii::Point<dim> centre;
      centre[0] = (b % 2 ? 0.5 : -0.5) * apart;
      centre[1] = (b / 2 ? 0.5 : -0.5) * apart;
      add_body(centre);
    }
}

template <int dim>
std::string
NodeScene<dim>::description() const
{
  std::ostringstream out;
  out << dim << "-D, " << bodies.size() << " bodies, " << rigid.size() << " rigid, " << n_sheets
      << " sheets, facet " << size << ", speed " << speed << ", surprise " << surprise << ", d "
      << thickness;
  return out.str();
}

template <int dim>
typename NodeScene<dim>::Vector
NodeScene<dim>::random_way(const double length)
{
  Vector result;
  for (int d = 0; d < dim; ++d)
    result[d] = random.uniform(-1, 1);
  return length * result;
}

/// An ellipse, an arc, and in space what they sweep along z.
template <int dim>
void
NodeScene<dim>::add_shape(const bool closed, const bool triangles, const dealii::Point<dim> &centre)
{
  const double a = random.uniform(0.3, 1.), b = random.uniform(0.1, 1.);
  const double angle = (closed ? 2 * M_PI : random.uniform(1, 4)), tilt = random.uniform(0, 6);
  const unsigned int n      = std::max(5., angle * std::max(a, b) / size);
  const unsigned int line   = closed ? n : n + 1;
  const unsigned int layers = dim == 2 ? 0 : 1 + random.integer(3);
  const unsigned int first = surface.nodes.size(), body = bodies.size();
  const auto         add_node = [&](const double x, const double y, const double z) {
    SurfaceNode<dim> node;
    node.position = centre;
    node.position[0] += std::cos(tilt) * x - std::sin(tilt) * y;
    node.position[1] += std::sin(tilt) * x + std::cos(tilt) * y;
    if (dim == 3)
      node.position[2] += z;
    node.key = (1ull << 32) + surface.nodes.size();
    surface.nodes.push_back(node);
  };
  const auto add_facet = [&](const std::array<unsigned int, vertices_per_facet<dim>> &nodes) {
    surface.facets.push_back({nodes, body, surface.facets.size()});
  };
  for (unsigned int l = 0; l <= layers; ++l)
    for (unsigned int i = 0; i < line; ++i)
      add_node(a * std::cos(angle * i / n), b * std::sin(angle * i / n), size * (l - 0.5 * layers));
  if constexpr (dim == 2)
    for (unsigned int i = 0; i < n; ++i)
      add_facet({{first + i, first + (i + 1) % line}});
  else
    {
      for (unsigned int l = 0; l < layers; ++l)
        for (unsigned int i = 0; i < n; ++i)
          {
            const unsigned int p = first + l * line + i, q = first + l * line + (i + 1) % line;
            if (triangles)
              {
                add_facet({{p, q, q + line, q + line}});
                add_facet({{p, q + line, p + line, p + line}});
              }
            else
              add_facet({{p, q, q + line, p + line}});
          }
      for (unsigned int l = 0; l <= layers && closed; l += layers)
        {
          const unsigned int c = surface.nodes.size();
          add_node(0, 0, size * (l - 0.5 * layers));
          for (unsigned int i = 0; i < n; ++i)
            {
              const unsigned int p = first + l * line + i, q = first + l * line + (i + 1) % line;
              if (l == 0)
                add_facet({{c, q, p, p}});
              else
                add_facet({{c, p, q, q}});
            }
        }
    }
}

template <int dim>
void
NodeScene<dim>::add_body(const dealii::Point<dim> &centre)
{
  const bool closed = random.chance(0.6);
  // Prescribed motion leaves no place between two of its kind: one at most, and at rest.
  const double which = random.uniform(0, 1);
  Body         body;
  body.motion = (which < 0.6                      ? Motion::deformable
                 : which < 0.9 || !bodies.empty() ? Motion::rigid
                                                  : Motion::prescribed);
  body.first  = surface.nodes.size();
  // Warped quadrilaterals take long to audit.
  add_shape(closed, body.motion == Motion::deformable, centre);
  body.last   = surface.nodes.size();
  body.centre = centre;
  SurfaceBody description;
  description.kind         = closed ? SurfaceKind::closed : SurfaceKind::sheet;
  description.thickness    = thickness;
  description.sheet        = closed ? -1 : int(n_sheets++);
  description.part         = bodies.size();
  description.self_contact = body.motion == Motion::deformable;
  const double mass        = random.log_uniform(0.3, 3.);
  const Vector velocity    = -speed / 1.5 * Vector(centre) + random_way(0.2 * speed);
  if (body.motion == Motion::rigid)
    {
      description.rigid_body = rigid.size();
      RigidUnknown<dim> unknown;
      unknown.centre   = centre;
      unknown.velocity = velocity;
      for (int d = 0; d < dim; ++d)
        unknown.inverse_mass[d] = 1 / (mass * (body.last - body.first));
      for (unsigned int d = 0; d < 3; ++d)
        unknown.inverse_inertia[d][d] = 3 * unknown.inverse_mass[0];
      unknown.spin[2] = speed * random.uniform(-1, 1);
      rigid.push_back(unknown);
    }
  surface.bodies.push_back(description);
  for (unsigned int i = body.first; i < body.last; ++i)
    {
      auto &node = surface.nodes[i];
      if (body.motion == Motion::deformable)
        {
          node.velocity = velocity + random_way(0.2 * speed);
          for (int d = 0; d < dim; ++d)
            node.inverse_mass[d] = (i % 17 == 3 && d == 0 ? 0. : 1 / mass);
        }
      drawn.push_back(node.position);
      if (int(i % n_ranks_) == rank)
        {
          body.points.push_back(i);
          body.keys.push_back(node.key);
        }
    }
  bodies.push_back(body);
}

template <int dim>
void
NodeScene<dim>::predict()
{
  const auto pull = pull_of_edges(surface, drawn);
  for (auto &body : bodies)
    for (unsigned int i = body.first; i < body.last; ++i)
      {
        auto &node = surface.nodes[i];
        if (body.motion == Motion::deformable)
          {
            for (int d = 0; d < dim; ++d)
              if (node.inverse_mass[d] > 0)
                node.velocity[d] += 0.1 * pull[i][d] - 0.01 * node.velocity[d];
              else
                node.velocity[d] = 0;
          }
        else if (body.motion == Motion::rigid)
          {
            const auto &r = rigid[surface.bodies[&body - bodies.data()].rigid_body];
            node.velocity = r.velocity + Delassus<dim>::cross(r.spin, node.position - r.centre);
          }
        start[i] = node.position;
      }
}

template <int dim>
std::vector<PointSet<dim>>
NodeScene<dim>::sets()
{
  std::vector<PointSet<dim>> result(bodies.size());
  for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      auto &body = bodies[b];
      auto &set  = result[b];
      body.side.resize(n_sheets, std::vector<double>(body.points.size()));
      set.n_points        = body.points.size();
      set.ids             = body.keys.data();
      set.constant_radius = thickness > 0 ? 0.5 * thickness : 0.01 * size;
      set.body            = b;
      set.surface_node    = body.points.data();
      set.least_skin      = 0.25 * size;
      for (auto &column : body.side)
        set.side.push_back(column.data());
      for (int d = 0; d < dim; ++d)
        {
          body.position[d].resize(set.n_points);
          body.velocity[d].resize(set.n_points);
          for (unsigned int i = 0; i < set.n_points; ++i)
            {
              body.position[d][i] = surface.nodes[body.points[i]].position[d];
              body.velocity[d][i] = surface.nodes[body.points[i]].velocity[d];
            }
          set.position[d] = body.position[d].data();
          set.velocity[d] = body.velocity[d].data();
        }
    }
  return result;
}

template <int dim>
void
NodeScene<dim>::place_rigid(const Body &body)
{
  const double angle = body.part * body.turn.norm();
  const auto   r     = rotation(angle > 0 ? body.turn / body.turn.norm() : body.turn, angle);
  for (unsigned int i = body.first; i < body.last; ++i)
    surface.nodes[i].position =
      body.part == 0 ? start[i]
                     : body.centre + body.part * body.way + turned<dim>(r, start[i] - body.centre);
}

/// What contact says, and a surprise.
template <int dim>
void
NodeScene<dim>::move()
{
  std::vector<Vector> impulse(surface.nodes.size()), correction(surface.nodes.size());
  contacts->surface_impulses(impulse, correction);
  sum_over_ranks(impulse, communicator);
  sum_over_ranks(correction, communicator);
  for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      auto &body = bodies[b];
      if (body.motion == Motion::rigid)
        {
          auto       &r    = rigid[surface.bodies[b].rigid_body];
          const auto &sums = contacts->rigid_impulses()[surface.bodies[b].rigid_body];
          r.velocity += r.inverse_mass[0] * sums.impulse;
          r.spin += r.inverse_inertia * sums.moment;
          body.centre = r.centre;
          body.way  = r.velocity + r.inverse_mass[0] * sums.correction + random_way(0.3 * surprise);
          body.turn = r.spin + r.inverse_inertia * sums.correction_moment;
          body.turn[2] += 0.3 * surprise * random.uniform(-1, 1);
          body.part = 1;
          place_rigid(body);
        }
      else if (body.motion == Motion::deformable)
        for (unsigned int i = body.first; i < body.last; ++i)
          {
            auto        &node  = surface.nodes[i];
            const Vector extra = random_way(random.chance(0.3) ? surprise : 0.);
            for (int d = 0; d < dim; ++d)
              {
                node.velocity[d] += node.inverse_mass[d] * impulse[i][d];
                if (node.inverse_mass[d] > 0)
                  node.position[d] +=
                    node.velocity[d] + node.inverse_mass[d] * correction[i][d] + extra[d];
              }
          }
    }
}

template <int dim>
bool
NodeScene<dim>::change(const EndChanges<dim> &changes)
{
  auto shift = changes.shift, count = changes.count;
  sum_over_ranks(shift, communicator);
  sum_over_ranks(count, communicator);
  bool result = false;
  for (unsigned int b = 0; b < bodies.size(); ++b)
    if (auto &body = bodies[b]; body.motion == Motion::rigid)
      {
        const double part = changes.rigid_part[surface.bodies[b].rigid_body];
        if (part == 1 || body.part == 0)
          continue;
        body.part *= part;
        place_rigid(body);
        result = true;
      }
    else
      for (unsigned int i = body.first; i < body.last; ++i)
        for (int d = 0; d < dim; ++d)
          if (auto &x = surface.nodes[i].position[d]; surface.nodes[i].inverse_mass[d] > 0)
            {
              const double before = x;
              if (count[i][1] > 0)
                x = start[i][d] + changes.held_part * (x - start[i][d]);
              else if (count[i][0] > 0)
                x += shift[i][d] / count[i][0];
              result = result || x != before;
            }
  return result;
}

template <int dim>
void
NodeScene<dim>::step()
{
  start.resize(surface.nodes.size());
  predict();
  // Every rank has all nodes and publishes its share of the facets.
  const auto all_facets = surface.facets;
  surface.facets.erase(std::remove_if(surface.facets.begin(),
                                      surface.facets.end(),
                                      [this](const auto &f) {
                                        return int(f.key % n_ranks_) != rank;
                                      }),
                       surface.facets.end());
  const auto at_start = sets();
  contacts->find(surface, at_start, 1.);
  contacts->build_rows([](const unsigned int, const unsigned int, std::vector<Rows::Entry> &) {},
                       [](const unsigned int) { return Unknown<dim>(); });
  contacts->solve(rigid, 1.);
  move();
  contacts->resolve_in_time(surface,
                            at_start,
                            typename ContinuousCheck<dim>::Ends(at_start.size()),
                            [this](const auto &changes) { return change(changes); });
  for (unsigned int b = 0; b < bodies.size(); ++b)
    if (bodies[b].motion == Motion::rigid)
      rigid[surface.bodies[b].rigid_body].centre += bodies[b].part * bodies[b].way;
  outcome.crossings += contacts->audit(surface, sets());
  surface.facets = all_facets;
  ++outcome.steps;
  outcome.contacts += contacts->report().n_contacts;
  outcome.unconverged += !contacts->report().solver.velocity.converged;
}

template <int dim>
Outcome
NodeScene<dim>::run()
{
  const unsigned int n_steps = std::min(dim == 2 ? 60. : 20., 4 / speed);
  for (unsigned int k = 0; k < n_steps; ++k)
    step();
  outcome.points   = surface.nodes.size();
  outcome.resolved = contacts->report().n_resolved;
  outcome.failed   = contacts->report().n_failed;
  return outcome;
}
} // namespace trial
