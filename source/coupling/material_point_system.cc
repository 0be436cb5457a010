// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/material_point_system.h>
#include <coracle/particles/shape.h>

#include <algorithm>
#include <sstream>

namespace coracle
{
namespace
{
constexpr unsigned int steps_between_sorts = 10;

// Work expected in a cell: its particles, on top of one for the cell itself.
template <int dim>
std::function<double(const dealii::Point<dim> &, const double)>
particle_weight(const Parameters &bodies)
{
  std::vector<std::pair<std::shared_ptr<Shape<dim>>, double>> shapes;
  for (const std::string &name : bodies.section_names())
    {
      const Parameters body = bodies.section(name);
      if (body.choice("Kind") == "material points")
        shapes.emplace_back(read_shape<dim>(body), body.quantity("Particle spacing"));
    }
  return [shapes](const dealii::Point<dim> &centre, const double size) {
    double n_particles = 0;
    for (const auto &[shape, spacing] : shapes)
      if (shape->contains(centre))
        n_particles += std::pow(size / spacing, dim);
    return n_particles;
  };
}
} // namespace

template <int dim>
MaterialPointSystem<dim>::MaterialPointSystem(const Parameters             &root,
                                              const MaterialLibrary        &materials,
                                              const dealii::Tensor<1, dim> &gravity,
                                              const MetSurfaces            &met,
                                              MPI_Comm                      comm,
                                              Archive                      *saved_octree)
  : octree(OctreeDescription<dim>::read(root.section("Grid")),
           particle_weight<dim>(root.section("Bodies")),
           comm,
           saved_octree)
  , boundary(BoxBoundary<dim>::read(root.section("Grid")), octree)
  , split(octree)
  , gravity(gravity)
  , sides(octree)
{
  const Parameters section = root.section("Bodies");
  for (const std::string &name : section.section_names())
    if (section.section(name).choice("Kind") == "material points")
      bodies.emplace_back(section.section(name), materials, octree, met, saved_octree == nullptr);
  make_fields();
  for (auto &body : bodies)
    energy.kinetic += body.points.kinetic_energy();
}

template <int dim>
void
MaterialPointSystem<dim>::serialize(Archive &archive)
{
  for (auto &body : bodies)
    {
      body.serialize(archive);
      if (!archive.is_exact())
        redistribute(octree, body.margin_of_shape(), body.points);
    }
  archive.share("energy.kinetic", energy.kinetic);
  archive.share("energy.internal", energy.internal);
  archive.share("energy.damping", energy.damping);
  archive.share("energy.transfer", energy.transfer);
  archive.share("energy.boundary", energy.boundary);
  archive.share("energy.contact", energy.contact);
  archive.share("energy.external_work", energy.external_work);
  archive.same("steps_since_sort", steps_since_sort);
  archive.own("renumbered", renumbered);
  if (archive.loads())
    for (auto &body : bodies)
      body.points.find_touched();
}

template <int dim>
void
MaterialPointSystem<dim>::make_fields()
{
  for (auto &body : bodies)
    {
      const auto found = std::find(field_names.begin(), field_names.end(), body.field_name);
      body.field       = found - field_names.begin();
      if (found == field_names.end())
        {
          field_names.push_back(body.field_name);
          fields.emplace_back(octree, boundary, &split);
        }
    }
}

template <int dim>
NodalField<dim> &
MaterialPointSystem<dim>::field(const MaterialPointBody<dim> &body)
{
  return *std::next(fields.begin(), body.field);
}

// Nodes need the momenta of all bodies of their field, or none.
template <int dim>
bool
MaterialPointSystem<dim>::shares_musl_field(const MaterialPointBody<dim> &body) const
{
  return std::any_of(bodies.begin(), bodies.end(), [&body](const auto &other) {
    return other.field == body.field && other.stress_update == StressUpdate::musl;
  });
}

template <int dim>
double
MaterialPointSystem<dim>::stable_time_step() const
{
  double rate = 0;
  for (const auto &body : bodies)
    {
      rate = std::max(rate, body.sweep.rate);
      // h / c and h^2 / (2 dim nu) are limits of their own: the sum of their inverses is on the
      // safe side.
      rate = std::max(rate, body.sweep.rate + 2 * dim * body.sweep.diffusion_rate);
    }
  rate = mpi::max(rate, octree.triangulation.get_communicator());
  return rate > 0 ? 1. / rate : std::numeric_limits<double>::infinity();
}

template <int dim>
std::string
MaterialPointSystem<dim>::describe_limit() const
{
  using Layout        = ParticleLayout<dim>;
  const MPI_Comm comm = octree.triangulation.get_communicator();
  const auto     rate = [comm](const auto &body) {
    return mpi::max(body.sweep.rate + 2 * dim * body.sweep.diffusion_rate, comm);
  };
  const auto body =
    std::max_element(bodies.begin(), bodies.end(), [&](const auto &a, const auto &b) {
      return rate(a) < rate(b);
    });
  if (body == bodies.end())
    return "";
  // Speed, id, place.
  std::array<double, 2 + dim> fastest{};
  for (std::size_t row = 0; row < body->points.n_rows(); ++row)
    {
      double square = 0;
      for (int d = 0; d < dim; ++d)
        square += std::pow(body->points.column(Layout::velocity + d)[row], 2);
      if (square > fastest[0])
        {
          fastest = {square, static_cast<double>(body->points.id(row))};
          for (int d = 0; d < dim; ++d)
            fastest[2 + d] = body->points.position(row)[d];
        }
    }
  for (const auto &other : dealii::Utilities::MPI::all_gather(comm, fastest))
    fastest = std::max(fastest, other);
  std::ostringstream text;
  text << "'" << body->name() << "' asks for it, whose fastest particle is number " << fastest[1]
       << " at (";
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << fastest[2 + d];
  text << ") m with " << std::sqrt(fastest[0]) << " m/s";
  return text.str();
}

template <int dim>
void
MaterialPointSystem<dim>::cut(const contact::Surface<dim> &surface)
{
  if (renumbered)
    for (auto &body : bodies)
      body.points.find_touched();
  sides.update(surface, bodies, split);
}

template <int dim>
void
MaterialPointSystem<dim>::gather(const double time, const double dt)
{
  const bool any_usf = std::any_of(bodies.begin(), bodies.end(), [](const auto &body) {
    return body.stress_update == StressUpdate::usf;
  });
  // Exact sums are made once: all forces together.
  const auto gives_force_later = [&](const auto &body) {
    return body.stress_update == StressUpdate::usf || (any_usf && reproducible);
  };
  for (auto &f : fields)
    f.clear();
  for (auto &body : bodies)
    {
      const double damped = body.damp(time, dt, octree.triangulation.get_communicator());
      energy.damping += damped;
      energy.kinetic -= damped;
    }
  bound_sums(time, false);
  for (auto &body : bodies)
    particles_to_grid(octree,
                      body.points,
                      body.transfer,
                      gives_force_later(body) ? Give::mass_and_momentum : Give::everything,
                      field(body));
  if (any_usf)
    {
      // Stresses follow the velocities gathered so far, then give their forces. Every body of the
      // field has given its momentum by now.
      for (auto &f : fields)
        {
          f.sum();
          f.predict(0., dealii::Tensor<1, dim>());
        }
      for (auto &body : bodies)
        if (body.stress_update == StressUpdate::usf)
          update_stress(body, field(body).motion(), NodalField<dim>::Motion::velocity, time, dt);
      bound_sums(time, false);
      for (auto &body : bodies)
        if (gives_force_later(body))
          particles_to_grid(octree, body.points, body.transfer, Give::force, field(body));
    }
  for (auto &body : bodies)
    if (body.body_force)
      add_body_forces(body, time, dt);
  for (auto &f : fields)
    f.sum();
}

template <int dim>
void
MaterialPointSystem<dim>::predict(const double dt)
{
  for (auto &f : fields)
    f.predict(dt, gravity);
}

template <int dim>
void
MaterialPointSystem<dim>::apply_impulses()
{
  for (auto &f : fields)
    f.apply_impulses();
}

template <int dim>
double
MaterialPointSystem<dim>::share_of_step(const MaterialPointBody<dim> &body,
                                        const double                  share,
                                        const double                  dt) const
{
  if (share == 0)
    return 0;
  // The same for all bodies of a field: nodes give back what they got only if all take it alike.
  double rate = 0;
  for (const auto &other : bodies)
    if (other.field == body.field)
      rate = std::max(rate, other.sweep.rate);
  rate = mpi::max(rate, octree.triangulation.get_communicator());
  return 1. - std::pow(1. - share, std::min(1., dt * rate));
}

template <int dim>
void
MaterialPointSystem<dim>::move(const double dt)
{
  for (auto &f : fields)
    {
      f.sum_energies();
      const auto &books = f.energies();
      energy.external_work += books.gravity;
      energy.boundary += books.boundary;
      energy.contact += books.contact;
      energy.transfer += books.given - books.gathered;
      f.clear_momentum();
    }
  bound_sums(0, true);
  // Lost to the grid and back: (particles - gathered) before, (given - particles) after the step.
  energy.transfer += energy.kinetic;
  energy.kinetic = 0;
  for (auto &body : bodies)
    {
      // The fraction is meant for a stable step, so that shorter steps do not damp more.
      TransferOptions transfer = body.transfer;
      transfer.pic_fraction    = share_of_step(body, body.transfer.pic_fraction, dt);
      const double kinetic =
        grid_to_particles(octree, transfer, dt, shares_musl_field(body), field(body), body.points);
      energy.kinetic += reproducible ? kinetic_energy(body) : kinetic;
    }
  energy.transfer -= energy.kinetic;
}

template <int dim>
void
MaterialPointSystem<dim>::update_stress(MaterialPointBody<dim> &body,
                                        const NodeRecords      &velocity,
                                        const unsigned int      place,
                                        const double            time,
                                        const double            dt)
{
  const StressOptions options = {body.transfer.shape,
                                 body.volume_strain,
                                 share_of_step(body, body.volume_smoothing, dt),
                                 dt,
                                 reproducible};
  body.sweep = update_particle_stress(octree, velocity, place, body.material, options, body.points);
  const double work = reproducible ? on_first_rank(body.sweep.exact_work) : body.sweep.work;
  body.internal_energy += work;
  energy.internal += work;
  if (body.sweep.bad_row >= 0 && !failure)
    {
      const auto        &points = body.points;
      std::ostringstream details;
      details << "particle " << points.id(body.sweep.bad_row) << " of '" << body.name() << "' at ("
              << points.position(body.sweep.bad_row) << ") m, t = " << time << " s: density "
              << points.column(ParticleLayout<dim>::density)[body.sweep.bad_row]
              << " kg/m^3, stress "
              << points.column(ParticleLayout<dim>::stress)[body.sweep.bad_row] << " Pa";
      failure.emplace("the state of a particle is no longer physical",
                      details.str(),
                      "lower Time/Safety factor, or look at what hits this place");
    }
}

template <int dim>
void
MaterialPointSystem<dim>::update_stresses(const double time, const double dt)
{
  using Field = NodalField<dim>;
  for (auto &f : fields)
    {
      f.sum();
      f.remap();
    }
  for (auto &body : bodies)
    if (body.stress_update == StressUpdate::musl)
      update_stress(body, field(body).gathered(), Field::Gathered::momentum, time, dt);
    else if (body.stress_update == StressUpdate::usl)
      update_stress(body, field(body).motion(), Field::Motion::velocity, time, dt);
}

template <int dim>
void
MaterialPointSystem<dim>::locate(const double time)
{
  for (auto &body : bodies)
    try
      {
        if (move_and_locate(octree, boundary, body.margin_of_shape(), time, body.points) > 0)
          renumbered = true;
      }
    catch (const RunFailure &lost)
      {
        if (!failure)
          failure.emplace(lost);
      }
  if (++steps_since_sort >= steps_between_sorts || reproducible)
    sort();
}

template <int dim>
void
MaterialPointSystem<dim>::sort()
{
  for (auto &body : bodies)
    sort_by_leaf(octree, body.margin_of_shape(), body.points);
  steps_since_sort = 0;
  renumbered       = true;
}

template <int dim>
void
MaterialPointSystem<dim>::octree_changed()
{
  boundary.reinit(octree);
  split.reinit();
  sides.octree_changed();
  for (auto &f : fields)
    f.reinit();
  redistribute_particles();
}

template <int dim>
void
MaterialPointSystem<dim>::redistribute_particles()
{
  for (auto &body : bodies)
    {
      redistribute(octree, body.margin_of_shape(), body.points);
      body.find_rates(octree);
    }
  steps_since_sort = 0;
  renumbered       = true;
}

template <int dim>
void
MaterialPointSystem<dim>::book_split_merge(MaterialPointBody<dim> &body, const ExactSum &sum)
{
  const double lost = reproducible ? on_first_rank(sum) : sum.value();
  energy.kinetic -= lost;
  energy.internal += lost;
  body.internal_energy += lost;
}

template <int dim>
bool
MaterialPointSystem<dim>::take_renumbered()
{
  const bool result = renumbered;
  renumbered        = false;
  return result;
}

template <int dim>
std::uint64_t
MaterialPointSystem<dim>::n_particles() const
{
  std::uint64_t n = 0;
  for (const auto &body : bodies)
    n += body.points.n_particles();
  return n;
}

template <int dim>
std::int64_t
MaterialPointSystem<dim>::ledger_error() const
{
  std::int64_t error = 0;
  for (const auto &body : bodies)
    error += body.points.ledger.expected() - std::int64_t(body.points.n_particles());
  return mpi::sum(error, octree.triangulation.get_communicator());
}

template <int dim>
std::size_t
MaterialPointSystem<dim>::memory_consumption() const
{
  std::size_t bytes =
    octree.memory_consumption() + split.memory_consumption() + sides.memory_consumption();
  for (const auto &body : bodies)
    bytes += body.points.memory_consumption();
  for (const auto &f : fields)
    bytes += f.memory_consumption();
  return bytes;
}

template class MaterialPointSystem<2>;
template class MaterialPointSystem<3>;
} // namespace coracle
