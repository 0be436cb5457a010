// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/particles/generate.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace coracle
{
template <int dim>
Lattice<dim>::Lattice(const dealii::BoundingBox<dim> &box, const double asked_spacing)
  : lower(box.get_boundary_points().first)
{
  double n_points = 1;
  for (int d = 0; d < dim; ++d)
    {
      const double cells = std::max(1., std::round(box.side_length(d) / asked_spacing));
      n_points *= cells;
      n[d]       = static_cast<std::uint64_t>(std::min(cells, 0x1p53));
      spacing[d] = box.side_length(d) / cells;
    }
  AssertThrow(n_points < 0x1p53,
              dealii::ExcMessage("More lattice points than a double can number."));
}

template <int dim>
dealii::Point<dim>
Lattice<dim>::point(const Index &index) const
{
  dealii::Point<dim> p = lower;
  for (int d = 0; d < dim; ++d)
    p[d] += (index[d] + 0.5) * spacing[d];
  return p;
}

template <int dim>
std::uint64_t
Lattice<dim>::id(const Index &index) const
{
  std::uint64_t result = 0;
  for (int d = dim - 1; d >= 0; --d)
    result = result * n[d] + index[d];
  return result;
}

template <int dim>
std::uint64_t
Lattice<dim>::first_from(const int d, const double coordinate) const
{
  const double place = std::ceil((coordinate - lower[d]) / spacing[d] - 0.5);
  return static_cast<std::uint64_t>(std::clamp(place, 0., static_cast<double>(n[d])));
}

template <int dim>
double
Lattice<dim>::cell_volume() const
{
  double volume = 1;
  for (int d = 0; d < dim; ++d)
    volume *= spacing[d];
  return volume;
}

void
GenerationSettings::declare(Declaration &body)
{
  declare_shape(body);
  body.quantity(
    "Particle spacing",
    "10 mm",
    "m",
    "d",
    "Distance between particles at the start; adjusted in each direction so that it divides "
    "the box around the shape evenly",
    1e-300);
  body.flag(
    "Exact volume",
    true,
    "Scale the particles' volumes so that their sum is the shape's, where that is known (all "
    "shapes but the indicator, and surfaces whose facets do not agree on the outside)");
}

GenerationSettings::GenerationSettings(const Parameters &body)
  : GenerationSettings(body.quantity("Particle spacing"), body.flag("Exact volume"))
{}

GenerationSettings::GenerationSettings(const double spacing, const bool exact_volume)
  : spacing(spacing), exact_volume(exact_volume)
{}

namespace
{
/// Append the particles of one row of the lattice, along x.
template <int dim>
void
generate_row(const Shape<dim>                                      &shape,
             const Lattice<dim>                                    &lattice,
             typename Lattice<dim>::Index                           index,
             const std::uint64_t                                    end,
             const std::function<bool(const dealii::Point<dim> &)> &is_mine,
             GeneratedParticles<dim>                               &particles)
{
  for (; index[0] < end; ++index[0])
    {
      const dealii::Point<dim> point = lattice.point(index);
      if (!is_mine(point) || !shape.contains(point))
        continue;
      particles.positions.push_back(point);
      particles.ids.push_back(lattice.id(index));
    }
}

/// The particles of a shape that brings its own places; false if it does not.
template <int dim>
bool
generate_places(const Shape<dim>                                      &shape,
                const GenerationSettings                              &settings,
                const std::function<bool(const dealii::Point<dim> &)> &is_mine,
                const MPI_Comm                                         communicator,
                GeneratedParticles<dim>                               &particles)
{
  std::uint64_t id = 0;
  if (!shape.for_each_place(settings.spacing, [&](const dealii::Point<dim> &place) {
        if (is_mine(place))
          {
            particles.positions.push_back(place);
            particles.ids.push_back(id);
          }
        ++id;
      }))
    return false;
  particles.n_total =
    dealii::Utilities::MPI::sum(std::uint64_t(particles.ids.size()), communicator);
  particles.volume = shape.volume().value() / id;
  for (int d = 0; d < dim; ++d)
    particles.spacing[d] = std::pow(particles.volume, 1. / dim);
  return true;
}
} // namespace

template <int dim>
GeneratedParticles<dim>
generate_particles(const Shape<dim>                                      &shape,
                   const GenerationSettings                              &settings,
                   const std::function<bool(const dealii::Point<dim> &)> &is_mine,
                   const dealii::BoundingBox<dim>                        &my_region,
                   const MPI_Comm                                         communicator)
{
  GeneratedParticles<dim> particles;
  if (generate_places(shape, settings, is_mine, communicator, particles))
    return particles;
  const Lattice<dim> lattice(shape.bounding_box(), settings.spacing);

  // One point more on either side: round-off must not take a point from the rank that owns it.
  typename Lattice<dim>::Index begin, end;
  for (int d = 0; d < dim; ++d)
    {
      begin[d] = lattice.first_from(d, my_region.lower_bound(d) - lattice.spacing[d]);
      end[d]   = lattice.first_from(d, my_region.upper_bound(d) + lattice.spacing[d]);
    }

  typename Lattice<dim>::Index index = begin;
  for (index[dim - 1] = begin[dim - 1]; index[dim - 1] < end[dim - 1]; ++index[dim - 1])
    if constexpr (dim == 2)
      generate_row(shape, lattice, index, end[0], is_mine, particles);
    else
      for (index[1] = begin[1]; index[1] < end[1]; ++index[1])
        generate_row(shape, lattice, index, end[0], is_mine, particles);

  particles.spacing = lattice.spacing;
  particles.volume  = lattice.cell_volume();
  particles.n_total =
    dealii::Utilities::MPI::sum(std::uint64_t(particles.ids.size()), communicator);
  if (const auto exact = shape.volume(); exact && particles.n_total > 0)
    {
      particles.volume_error = particles.n_total * particles.volume / *exact - 1.;
      if (settings.exact_volume)
        particles.volume = *exact / particles.n_total;
    }
  return particles;
}

template <int dim>
GeneratedParticles<dim>
generate_particles(const Parameters                                      &body,
                   const std::function<bool(const dealii::Point<dim> &)> &is_mine,
                   const dealii::BoundingBox<dim>                        &my_region,
                   const MPI_Comm                                         communicator)
{
  const auto               shape = read_shape<dim>(body);
  const GenerationSettings settings(body);

  for (int d = 0; d < dim; ++d)
    if (const double side = shape->bounding_box().side_length(d); side < 0.5 * settings.spacing)
      {
        std::ostringstream found;
        found << "spacing " << settings.spacing << " m, but '" << body.name() << "' is only "
              << side << " m wide along "
              << "xyz"[d];
        std::ostringstream cure;
        cure << "set Particle spacing to at most " << side << " m, or enlarge the shape";
        throw body.error("Particle spacing",
                         "particles too coarse for their body",
                         found.str(),
                         cure.str());
      }

  auto particles = generate_particles<dim>(*shape, settings, is_mine, my_region, communicator);
  if (particles.n_total == 0)
    {
      std::ostringstream found;
      found << "no point of the lattice with spacing " << settings.spacing
            << " m lies in the shape and in the domain";
      throw body.error("Particle spacing",
                       "body without particles",
                       found.str(),
                       "reduce the spacing, or check the shape and the domain");
    }
  return particles;
}

#define INSTANTIATE(dim)                                     \
  template class Lattice<dim>;                               \
  template GeneratedParticles<dim> generate_particles<dim>(  \
    const Shape<dim> &,                                      \
    const GenerationSettings &,                              \
    const std::function<bool(const dealii::Point<dim> &)> &, \
    const dealii::BoundingBox<dim> &,                        \
    const MPI_Comm);                                         \
  template GeneratedParticles<dim> generate_particles<dim>(  \
    const Parameters &,                                      \
    const std::function<bool(const dealii::Point<dim> &)> &, \
    const dealii::BoundingBox<dim> &,                        \
    const MPI_Comm);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace coracle
