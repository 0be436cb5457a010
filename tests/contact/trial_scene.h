// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact_system.h>

#include "trial_grid.h"
#include "trial_shapes.h"

/**
 * Random scenes of contact, each drawn from a seed, on any number of ranks:
 * points that are coupled through a coarse grid, and surfaces that rest, move,
 * turn, fold, swing or fly. Lengths in cells, the unit of mass is one point.
 */
namespace trial
{
/// How a group of nodes moves: x(t) = pivot + R(angle(t)) (X - pivot) + shift(t).
template <int dim>
struct GroupMotion
{
  enum class Kind
  {
    prescribed,
    springs,
    rigid
  };
  Kind                 kind = Kind::prescribed;
  dealii::Point<dim>   pivot;
  dealii::Tensor<1, 3> axis;
  /// Of the angle and of the shift: rate [1/s], and greatest value (0: without end).
  double                 rate = 0, largest_angle = 0;
  dealii::Tensor<1, dim> velocity;
  double                 largest_shift = 0;
  /// The angle grows along x over this length (0: it does not).
  double twist_length = 0;
};

/// What came of a scene; sums over ranks.
struct Outcome
{
  unsigned long points = 0, steps = 0, contacts = 0, crossings = 0, unconverged = 0, inside = 0,
                resolved = 0, failed = 0;
};

inline dealii::Tensor<2, 3>
rotation(const dealii::Tensor<1, 3> &axis, const double angle)
{
  const double         c = std::cos(angle), s = std::sin(angle);
  dealii::Tensor<2, 3> r;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      r[i][j] = (1 - c) * axis[i] * axis[j] + (i == j ? c : 0.);
  for (unsigned int i = 0; i < 3; ++i)
    {
      r[i][(i + 1) % 3] -= s * axis[(i + 2) % 3];
      r[(i + 1) % 3][i] += s * axis[(i + 2) % 3];
    }
  return r;
}

template <int dim>
dealii::Tensor<1, dim>
turned(const dealii::Tensor<2, 3> &r, const dealii::Tensor<1, dim> &a)
{
  dealii::Tensor<1, dim> result;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      result[i] += r[i][j] * a[j];
  return result;
}

template <int dim>
class Scene
{
public:
  using Vector = dealii::Tensor<1, dim>;

  Scene(const unsigned long seed, const int shape, MPI_Comm communicator);

  /// All steps.
  Outcome run();

  std::string description() const;
  std::string name;

  double       speed = 0, dt = 0, cfl = 0, radius = 0, thickness = 0, facet = 0;
  unsigned int n_steps = 0;

  /// Prints each crossing.
  bool verbose = false;

private:
  void make_surface(const Profile &profile);
  void extrude(const Profile &profile);
  void make_motion(const Profile &profile);
  void make_points(const Profile &profile, const unsigned int n);
  bool starts_inside(const Profile &profile, const dealii::Point<dim> &x) const;
  void turn_everything();

  dealii::Point<dim> place_at(const unsigned int node, const double time) const;
  void               predict_surface();
  void               step();
  void               contact_step();
  void move_surface(const std::vector<Vector> &impulse, const std::vector<Vector> &correction);
  std::vector<PointSet<dim>> sets();

  MPI_Comm     communicator;
  int          rank, n_ranks_;
  Random       random;
  Surface<dim> surface;
  SurfaceKind  kind;
  std::string  motion_name;
  /// Nodes as drawn, and their groups.
  std::vector<dealii::Point<dim>> drawn;
  std::vector<unsigned int>       group;
  std::vector<GroupMotion<dim>>   motions;
  double                          node_mass = 1, warp = 0;
  std::vector<RigidUnknown<dim>>  rigid;
  unsigned int                    n_sheets = 0;
  double                          time     = 0;
  bool                            coherent = true;

  GridPoints<dim>    points;
  ContactSystem<dim> contacts;
  Outcome            outcome;
};

inline ContactOptions
trial_options()
{
  return ContactOptions();
}

template <int dim>
Scene<dim>::Scene(const unsigned long seed, const int wanted_shape, MPI_Comm communicator)
  : communicator(communicator)
  , rank(my_rank(communicator))
  , n_ranks_(n_ranks(communicator))
  , random(7919 * seed + dim)
  , points(communicator)
  , contacts(trial_options(), communicator)
{
  const unsigned int shape   = random.integer(n_shapes);
  const Profile      profile = draw_profile(random, wanted_shape >= 0 ? wanted_shape : shape);
  name                       = profile.name;
  kind                       = profile.kind;
  facet                      = profile.facet;

  speed              = random.log_uniform(1., 3000.);
  const double sound = random.log_uniform(20., 1500.);
  cfl                = random.uniform(0.1, 0.9);
  dt                 = cfl / (sound + speed);
  n_steps            = std::max(20., std::min(100., 6. / (speed * dt)));
  // At a thousandth of a cell, none, and what is usual.
  radius = random.chance(0.3) ? 0. : random.log_uniform(1e-3, 0.3);
  thickness =
    random.chance(kind == SurfaceKind::sheet ? 0.2 : 0.7) ? 0. : random.log_uniform(1e-3, 0.3);

  make_surface(profile);
  make_motion(profile);
  make_points(profile, dim == 2 ? 60 : 80);
  if (random.chance(0.5))
    turn_everything();
  // Grid nodes lie anywhere relative to the surface.
  points.move_origin([&] { return random.uniform(-0.5, 0.5); });
  for (unsigned int i = 0; i < surface.nodes.size(); ++i)
    surface.nodes[i].position = place_at(i, 0);
}

template <int dim>
std::string
Scene<dim>::description() const
{
  std::ostringstream out;
  out << dim << "-D " << name << ", " << motion_name << ", facet " << facet << ", r " << radius
      << ", d " << thickness << ", v " << speed << ", v dt " << speed * dt << ", steps " << n_steps
      << ", facets " << surface.facets.size();
  return out.str();
}

template <int dim>
void
Scene<dim>::make_surface(const Profile &profile)
{
  surface.bodies.resize(profile.n_bodies);
  const double friction = random.chance(0.3) ? random.uniform(0, 1) : 0.;
  for (auto &body : surface.bodies)
    {
      body.kind      = profile.kind;
      body.thickness = thickness;
      body.friction  = friction;
      body.sheet     = (profile.kind == SurfaceKind::sheet ? int(n_sheets++) : -1);
    }
  extrude(profile);
  surface.nodes.resize(drawn.size());
  for (unsigned int i = 0; i < drawn.size(); ++i)
    {
      surface.nodes[i].key      = (1ull << 32) + i;
      surface.nodes[i].position = drawn[i];
    }
}

template <>
inline void
Scene<2>::extrude(const Profile &profile)
{
  drawn = profile.nodes;
  group = profile.group;
  for (unsigned int s = 0; s < profile.segments.size(); ++s)
    surface.facets.push_back({profile.segments[s], profile.body[s], s});
}

template <>
inline void
Scene<3>::extrude(const Profile &profile)
{
  const unsigned int n_layers = 1 + random.integer(std::max(1., std::min(8., 6 / facet)));
  const double depth   = (profile.name == "slivers" ? std::min(6., facet * random.uniform(0.5, 1))
                                                    : std::min(6., std::max(facet, 1.) * n_layers));
  const unsigned int n = profile.nodes.size();
  if (random.chance(0.3) && kind == SurfaceKind::sheet)
    warp = random.uniform(0, 0.15) * std::min(facet, depth / n_layers);
  for (unsigned int l = 0; l <= n_layers; ++l)
    for (unsigned int i = 0; i < n; ++i)
      {
        dealii::Point<3> x(profile.nodes[i][0],
                           profile.nodes[i][1],
                           depth * (double(l) / n_layers - 0.5));
        x[1] += warp * random.uniform(-1, 1);
        drawn.push_back(x);
        group.push_back(profile.group[i]);
      }
  const bool triangles = random.chance(0.3);
  const auto add       = [&](const std::array<unsigned int, 4> &nodes, const unsigned int body) {
    surface.facets.push_back({nodes, body, surface.facets.size()});
  };
  for (unsigned int l = 0; l < n_layers; ++l)
    for (unsigned int s = 0; s < profile.segments.size(); ++s)
      {
        const unsigned int a = l * n + profile.segments[s][0], b = l * n + profile.segments[s][1];
        if (triangles)
          {
            add({{a, b, b + n, b + n}}, profile.body[s]);
            add({{a, b + n, a + n, a + n}}, profile.body[s]);
          }
        else
          add({{a, b, b + n, a + n}}, profile.body[s]);
      }
  if (kind == SurfaceKind::sheet)
    return;
  for (const unsigned int l : {0u, n_layers})
    {
      dealii::Point<3> centre;
      for (unsigned int i = 0; i < n; ++i)
        centre += drawn[l * n + i] / double(n);
      const unsigned int c = drawn.size();
      drawn.push_back(centre);
      group.push_back(0);
      for (const auto &s : profile.segments)
        {
          const unsigned int a = l * n + s[0], b = l * n + s[1];
          if (l == 0)
            add({{c, b, a, a}}, 0);
          else
            add({{c, a, b, b}}, 0);
        }
    }
}

template <int dim>
void
Scene<dim>::make_motion(const Profile &profile)
{
  using Motion = GroupMotion<dim>;
  motions.resize(profile.n_groups);
  auto &all   = motions[0];
  all.axis[2] = 1;
  double size = 0;
  for (const auto &x : drawn)
    size = std::max(size, x.norm());
  // Nothing turns by more than 0.3 in a step.
  const double greatest_rate = std::min(speed / size, 0.3 / dt);
  const double which         = random.uniform(0, 1);
  motion_name                = "at rest";
  if (which < 0.15)
    {
      motion_name = "turns";
      all.rate    = random.uniform(-1, 1) * greatest_rate;
    }
  else if (which < 0.3)
    {
      motion_name = "swings";
      for (int d = 0; d < dim; ++d)
        all.velocity[d] = 0.5 * speed * random.uniform(-1, 1);
      all.largest_shift = random.uniform(0.2, 2.);
      all.rate          = random.uniform(-1, 1) * greatest_rate;
      all.largest_angle = random.uniform(0.1, 1.);
    }
  // Light nodes of small facets would make the sheet fold onto itself, which nothing here resists.
  else if (which < 0.45 && profile.name == "plate" && facet > 0.25)
    {
      motion_name = "springs";
      all.kind    = Motion::Kind::springs;
      node_mass   = random.log_uniform(1., 30.);
    }
  else if (which < 0.6 && profile.special.empty())
    {
      motion_name = "flies";
      all.kind    = Motion::Kind::rigid;
      RigidUnknown<dim> body;
      const double      mass = random.log_uniform(3., 300.);
      for (int d = 0; d < dim; ++d)
        {
          body.inverse_mass[d] = 1 / mass;
          body.velocity[d]     = 0.3 * speed * random.uniform(-1, 1);
        }
      for (unsigned int d = 0; d < 3; ++d)
        body.inverse_inertia[d][d] = 3 / (mass * size * size);
      body.spin[2] = 0.5 * random.uniform(-1, 1) * greatest_rate;
      rigid.push_back(body);
      for (auto &b : surface.bodies)
        b.rigid_body = 0;
    }
  if (profile.n_groups < 2)
    return;
  motions[1]  = all;
  auto &other = motions[1];
  if (profile.special == "flap")
    {
      // As a whole at rest: the two groups share the hinge.
      motion_name += "+flap";
      motions[0]          = Motion();
      motions[0].axis[2]  = 1;
      other               = motions[0];
      other.rate          = random.uniform(0.3, 1) * greatest_rate;
      other.largest_angle = random.uniform(0.3, 2.8);
    }
  else if (profile.special == "twist" && dim == 3)
    {
      motion_name         = "twist";
      other               = Motion();
      other.axis[0]       = 1;
      other.rate          = random.uniform(0.3, 1) * greatest_rate;
      other.largest_angle = random.uniform(0.5, 7.);
      other.twist_length  = 2 * size;
    }
  else if (profile.special == "closing")
    {
      motion_name        = "closing";
      motions[0]         = Motion();
      other              = Motion();
      motions[0].axis[2] = other.axis[2] = 1;
      const double R                     = radius + 0.5 * thickness;
      other.velocity[1]                  = -speed * random.uniform(0.2, 1);
      // Surfaces that pass through each other leave no place for what is between.
      other.largest_shift =
        std::max(1e-3, 2 - 2 * warp - std::max(2 * R, 1e-3) * random.uniform(1.1, 3));
    }
}

/// Is the place inside a closed body, as drawn?
template <int dim>
bool
Scene<dim>::starts_inside(const Profile &profile, const dealii::Point<dim> &x) const
{
  if (kind != SurfaceKind::closed)
    return false;
  if constexpr (dim == 3)
    if (std::abs(x[2]) > drawn.back()[2])
      return false;
  bool inside = false;
  for (const auto &segment : profile.segments)
    {
      const auto &a = profile.nodes[segment[0]], &b = profile.nodes[segment[1]];
      if ((a[1] > x[1]) != (b[1] > x[1]) &&
          x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        inside = !inside;
    }
  return inside;
}

template <int dim>
void
Scene<dim>::make_points(const Profile &profile, const unsigned int n)
{
  const double R       = radius + 0.5 * thickness;
  const bool   one_way = random.chance(0.5), pressed = random.chance(0.5);
  Vector       drift;
  for (int d = 0; d < dim; ++d)
    drift[d] = 0.5 * random.uniform(-1, 1);
  points.n_sheets = n_sheets;
  points.radius   = radius;
  for (unsigned int i = 0; i < n; ++i)
    {
      const auto  &f       = surface.facets[random.integer(surface.facets.size())];
      const double special = random.uniform(0, 1);
      double       u = random.uniform(0, 1), w = random.uniform(0, 1);
      if (special < 0.2)
        u = (random.chance(0.5) ? 0. : 1.);
      if (special < 0.1)
        w = (random.chance(0.5) ? 0. : 1.);
      dealii::Point<dim> x;
      Vector             normal;
      const auto         at = [&](const unsigned int k) { return drawn[f.nodes[k]]; };
      if constexpr (dim == 2)
        {
          x      = at(0) + u * (at(1) - at(0));
          normal = -dealii::cross_product_2d(at(1) - at(0));
          normal *= -1;
        }
      else
        {
          const bool t = (f.nodes[2] == f.nodes[3]);
          if (t && u + w > 1)
            {
              u = 1 - u;
              w = 1 - w;
            }
          x      = t ? at(0) + u * (at(1) - at(0)) + w * (at(2) - at(0))
                     : dealii::Point<dim>((1 - u) * (1 - w) * at(0) + u * (1 - w) * at(1) +
                                     u * w * at(2) + (1 - u) * w * at(3));
          normal = dealii::cross_product_3d(at(1) - at(0), at(n_corners(f) - 1) - at(0));
        }
      normal /= normal.norm();
      if (kind == SurfaceKind::sheet && !one_way && random.chance(0.5))
        normal *= -1;
      const double where = random.uniform(0, 1);
      double       away  = where < 0.1
                             ? 0.
                             : (where < 0.2 ? R * random.uniform(0, 1) : R + random.log_uniform(1e-3, 3.));
      // Between two plates.
      if (name == "closing")
        {
          normal    = Vector();
          normal[1] = (f.body == 0 ? 1. : -1.);
          away      = std::min(away, 1.5);
        }
      Vector v;
      for (int d = 0; d < dim; ++d)
        v[d] = drift[d] + 0.2 * random.uniform(-1, 1);
      v = speed * (v - random.uniform(0.2, 1) * normal) / 1.5;
      // Nothing says to which of the regions at a branch a point exactly on it belongs.
      if (profile.name == "junction" && away == 0 && std::hypot(x[0], x[1]) < 1e-6)
        continue;
      // No overlaps to start with: they are refused in a case.
      if (away > 0 && starts_inside(profile, x + away * normal))
        continue;
      if (i % n_ranks_ == static_cast<unsigned int>(rank))
        points.add(i, x + away * normal, v, pressed ? -0.05 * speed / dt * normal : Vector());
    }
}

template <int dim>
void
Scene<dim>::turn_everything()
{
  dealii::Tensor<1, 3> axis;
  axis[2] = 1;
  if (dim == 3)
    {
      for (unsigned int d = 0; d < 3; ++d)
        axis[d] = random.uniform(-1, 1);
      axis /= axis.norm();
    }
  const auto r = rotation(axis, random.uniform(0, 6));
  for (auto &x : drawn)
    x = dealii::Point<dim>(turned<dim>(r, x));
  for (auto &m : motions)
    {
      m.axis     = r * m.axis;
      m.velocity = turned<dim>(r, m.velocity);
    }
  for (auto &body : rigid)
    {
      body.velocity = turned<dim>(r, body.velocity);
      body.spin     = r * body.spin;
    }
  points.transform([&](const Vector &a) { return turned<dim>(r, a); });
}
} // namespace trial
