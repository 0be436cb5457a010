// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/coupling/initial_velocity.h>
#include <coracle/coupling/meshless_points.h>
#include <coracle/meshless/surface_seeds.h>
#include <coracle/particles/shape.h>

namespace coracle
{
namespace
{
/// Is a place of the box on its lower (side 0) or upper face?
template <int dim>
bool
on_face(const meshless::FluidOptions<dim> &options,
        const dealii::Point<dim>          &x,
        const unsigned int                 d,
        const unsigned int                 side)
{
  const double face = side == 0 ? options.box.lower_bound(d) : options.box.upper_bound(d);
  return std::fabs(x[d] - face) < 1e-6 * options.spacing;
}

/// Points evenly over the box around a shape, from face to face.
template <int dim>
class ClosedLattice
{
public:
  ClosedLattice(const dealii::BoundingBox<dim> &box, const double spacing) : box(box)
  {
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = static_cast<std::uint64_t>(std::max(1., std::round(box.side_length(d) / spacing))) + 1;
  }

  std::uint64_t size() const
  {
    std::uint64_t result = 1;
    for (unsigned int d = 0; d < dim; ++d)
      result *= n[d];
    return result;
  }

  dealii::Point<dim> point(std::uint64_t id) const
  {
    dealii::Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double share = double(id % n[d]) / (n[d] - 1);
        x[d]               = (1 - share) * box.lower_bound(d) + share * box.upper_bound(d);
        id /= n[d];
      }
    return x;
  }

private:
  const dealii::BoundingBox<dim> box;
  std::array<std::uint64_t, dim> n;
};

/// A shape with its lattice.
template <int dim>
class Source
{
public:
  explicit Source(const Parameters &section, const double spacing)
    : shape(read_shape<dim>(section))
    , box(shape->bounding_box())
    , lattice(box, spacing)
    , velocity(section)
  {}

  /// Points on the shape's boundary are in.
  bool contains(const dealii::Point<dim> &x) const
  {
    return shape->contains(x + 1e-9 * (box.center() - x));
  }

  /// Is the point in the shape, or nearer to it than this in one of the directions along axes and
  /// diagonals?
  bool is_near(const dealii::Point<dim> &x, const double reach) const
  {
    dealii::Tensor<1, dim> way;
    for (unsigned int direction = 0; direction < (dim == 2 ? 9 : 27); ++direction)
      {
        for (unsigned int d = 0, rest = direction; d < dim; ++d, rest /= 3)
          way[d] = double(rest % 3) - 1;
        if (contains(way.norm() > 0 ? x + reach / way.norm() * way : x))
          return true;
      }
    return false;
  }

  const std::unique_ptr<Shape<dim>> shape;
  const dealii::BoundingBox<dim>    box;
  const ClosedLattice<dim>          lattice;
  const InitialVelocity<dim>        velocity;
};

/// On a periodic face there is one point for both ends.
template <int dim>
bool
is_second_end(const meshless::Fluid<dim>     &fluid,
              const dealii::BoundingBox<dim> &box,
              const dealii::Point<dim>       &x)
{
  for (unsigned int d = 0; d < dim; ++d)
    if (fluid.period.along(d) && on_face(fluid.options, x, d, 1) &&
        on_face(fluid.options, box.get_boundary_points().first, d, 0))
      return true;
  return false;
}

void
check_number(const Parameters &section, const std::uint64_t n, const unsigned int dim)
{
  if (n <= dim)
    throw section.error(
      "",
      "a body has no points",
      std::to_string(n) + " points of the fluid's spacing are in its shape and the box",
      "choose a smaller spacing, or move the shape into the grid's box, or out of other regions");
}
} // namespace

void
declare_regions(Declaration &body)
{
  Declaration &region = body.named_sections(
    "Regions",
    "region",
    "Parts of a meshless fluid that are another fluid, such as a layer of oil, or one so viscous "
    "that it is a solid. Their points have the fluid's spacing and keep their region; an element "
    "is of "
    "a region if all its points are.");
  declare_shape(region);
  region.quantity("Density", "1000", "kg/m^3", "rho", "Of the region.", 1e-300);
  region.quantity("Viscosity", "0", "Pa s", "mu", "Dynamic; 0: none.", 0.);
  region.list("Initial velocity", "", "m/s", "v_0", "Of its points; empty is rest.");
  region.function("Initial velocity function",
                  "",
                  "m/s",
                  "One expression for each direction; used instead of the constant if not empty.");
}

template <int dim>
void
read_regions(const Parameters &body, meshless::FluidOptions<dim> &options)
{
  const Parameters regions = body.section("Regions");
  for (const std::string &name : regions.section_names())
    {
      const Parameters region = regions.section(name);
      options.regions.push_back({name, region.quantity("Density"), region.quantity("Viscosity")});
    }
  if (options.regions.size() > 200)
    throw body.error("",
                     "a meshless fluid has too many regions",
                     std::to_string(options.regions.size()),
                     "give at most 200");
  // Points on structures are of no region.
  if (!options.regions.empty() && body.choice("Structures") == "slip")
    throw body.error("Structures",
                     "a fluid with regions does not slip on structures",
                     "Structures = slip, and " + std::to_string(options.regions.size()) +
                       " regions",
                     "set Structures to auto or stick, or take the regions out");
  options.slips_on_structures &= options.regions.empty();
}

template <int dim>
void
generate_points(const Parameters &body, const Octree<dim> &octree, meshless::Fluid<dim> &fluid)
{
  const double            spacing  = fluid.options.spacing;
  const MPI_Comm          comm     = octree.triangulation.get_communicator();
  const Parameters        sections = body.section("Regions");
  std::vector<Parameters> parts;
  for (const auto &region : fluid.options.regions)
    parts.push_back(sections.section(region.name));
  parts.push_back(body);
  std::list<Source<dim>> sources;
  std::uint64_t          first_id = 0, created = 0;
  for (unsigned int part = 0; part < parts.size(); ++part)
    {
      check_inside_box(parts[part], octree.box());
      const Source<dim> &source = sources.emplace_back(parts[part], spacing);
      std::uint64_t      n      = 0;
      for (std::uint64_t id = 0; id < source.lattice.size(); ++id)
        {
          const dealii::Point<dim> x    = source.lattice.point(id);
          const int                leaf = octree.find(x);
          if (leaf < 0 || leaf >= static_cast<int>(octree.n_owned_leaves()) ||
              is_second_end(fluid, source.box, x) || !source.contains(x) ||
              std::any_of(sources.begin(), std::prev(sources.end()), [&](const auto &earlier) {
                return earlier.is_near(x, 0.4999 * spacing);
              }))
            continue;
          fluid.add_point(x,
                          source.velocity(x),
                          first_id + id,
                          part + 1 < parts.size() ? part + 1 : 0);
          ++n;
        }
      n = mpi::sum(n, comm);
      check_number(parts[part], n, dim);
      first_id += source.lattice.size();
      created += n;
    }
  fluid.counts.created = created;
}

// Where the fluid is beside a structure, points slide on it. Their ids follow those of the
// lattice.
template <int dim>
void
put_points_on_structures(const Parameters     &body,
                         const Octree<dim>    &octree,
                         meshless::Fluid<dim> &fluid)
{
  if (!fluid.structures.slip || fluid.structures.empty())
    return;
  const double                   spacing = fluid.options.spacing;
  const auto                     shape   = read_shape<dim>(body);
  const dealii::BoundingBox<dim> box     = shape->bounding_box();
  const auto                     beside  = [&](const meshless::SurfaceSeed<dim> &seed) {
    return seed.position + 0.05 * spacing * seed.normal;
  };
  const auto is_wet = [&](const meshless::SurfaceSeed<dim> &seed) {
    const dealii::Point<dim> x = beside(seed), inner = x + 1e-9 * (box.center() - x);
    return fluid.options.box.point_inside(x) && fluid.options.box.point_inside(seed.position) &&
           shape->contains(inner) && !fluid.structures.contains(x);
  };
  const InitialVelocity<dim> velocity(body);
  std::uint64_t              id = ClosedLattice<dim>(box, spacing).size(), n = 0;
  for (const auto &seed : meshless::seed<dim>(fluid.structures.surface, spacing, is_wet))
    {
      ++id;
      const int leaf = octree.find(seed.position);
      if (leaf < 0 || leaf >= static_cast<int>(octree.n_owned_leaves()))
        continue;
      fluid.add_point(seed.position, velocity(seed.position), id);
      fluid.columns[meshless::FluidLayout<dim>::sliding][fluid.n_fluid() - 1] = 1;
      ++n;
    }
  fluid.counts.created += mpi::sum(n, octree.triangulation.get_communicator());
}

template void read_regions(const Parameters &, meshless::FluidOptions<2> &);
template void read_regions(const Parameters &, meshless::FluidOptions<3> &);
template void generate_points(const Parameters &, const Octree<2> &, meshless::Fluid<2> &);
template void generate_points(const Parameters &, const Octree<3> &, meshless::Fluid<3> &);
template void put_points_on_structures(const Parameters &, const Octree<2> &, meshless::Fluid<2> &);
template void put_points_on_structures(const Parameters &, const Octree<3> &, meshless::Fluid<3> &);
} // namespace coracle
