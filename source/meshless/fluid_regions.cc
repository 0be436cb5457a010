// SPDX-License-Identifier: GPL-3.0-or-later
// Regions of the fluid: materials of elements, viscosity that varies, points that keep off.
#include <coracle/base/mpi.h>
#include <coracle/meshless/fluid.h>
#include <coracle/meshless/simplex.h>

namespace coracle::meshless
{
namespace
{
/// Nodes of structures beside regions are of any.
constexpr unsigned char any_region = 255;

/// Share of the spacing that a point keeps to a facet of a region's. The sphere of the square or
/// cube of points behind the facet reaches 0.21 or 0.37 spacings out of it; a point in there would
/// take the element out of the region.
template <int dim>
constexpr double keep_off = dim == 2 ? 0.3 : 0.5;

/// The same for points of the free surface, which are volume.
template <int dim>
constexpr double keep_off_surface = dim == 2 ? 0.22 : 0.42;
/// The same to an edge, in space, where the sphere of the cube reaches 0.16 spacings.
constexpr double keep_off_edge = 0.3;

/// Share of the spacing below which an element is too flat to have a sphere worth keeping.
constexpr double flat = 0.05;

/// A point put in keeps to the spheres' centres this over their radii.
constexpr double keep_off_sphere = 1.1;

/// Of an element a twentieth of the spacing high; flatter ones have less viscosity, as their
/// entries would spoil the system, and they have hardly any volume.
template <int dim>
constexpr double flattest_element = dim == 2 ? 10. : 3.;

/// Is a point near a facet of others, and not beside it?
template <int dim>
bool
is_before(const dealii::Point<dim>                  &x,
          const std::array<dealii::Point<dim>, dim> &facet,
          const double                               h,
          const double                               share)
{
  const auto normal = normal_of(facet);
  const auto from   = x - center_of(facet);
  return from.norm() < 0.85 * h && std::fabs(from * normal) < share * h * normal.norm();
}

bool
is_beside_edge(const dealii::Point<3> &x,
               const dealii::Point<3> &a,
               const dealii::Point<3> &b,
               const double            h)
{
  const auto   edge   = b - a;
  const auto   middle = x - (a + edge / 2);
  const double length = edge.norm(), along = middle * edge / length;
  return length < 1.2 * h && std::fabs(along) < 0.5 * length &&
         middle.norm_square() - along * along < std::pow(keep_off_edge * h, 2);
}
} // namespace

template <int dim>
void
Fluid<dim>::find_element_regions()
{
  element_region.clear();
  if (options.regions.empty())
    {
      region.assign(points.size(), 0);
      return;
    }
  region.resize(n_cloud);
  region.resize(points.n_own, any_region);
  halo.update(region);
  for (auto *const column : {&relative_density, &relative_lightness, &viscosity, &outside_regions})
    column->clear();
  const std::vector<double> flatness = rules.flatness();
  const double              flattest = flattest_element<dim> * std::pow(options.spacing, dim - 2);
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      unsigned char common = any_region;
      for (unsigned int k = mesh.first_node[e]; k < mesh.first_node[e + 1]; ++k)
        if (const unsigned char of_node = region[mesh.node[k]]; common == any_region)
          common = of_node;
        else if (of_node != any_region && of_node != common)
          common = 0;
      if (common == any_region)
        common = 0;
      element_region.push_back(common);
      const double density = common > 0 ? options.regions[common - 1].density : options.density;
      relative_density.push_back(density / options.density);
      relative_lightness.push_back(options.density / density);
      viscosity.push_back(std::min(1., flattest / flatness[e]) *
                          (common > 0 ? options.regions[common - 1].viscosity : options.viscosity));
      outside_regions.push_back(common == 0);
    }
}

template <int dim>
void
Fluid<dim>::find_masses(const ElementRules<dim>   &of,
                        const std::vector<double> &volumes,
                        std::vector<double>       &masses) const
{
  if (options.regions.empty())
    masses = volumes;
  else
    FluidOperators<dim>(mesh, of, halo).lumped_volume(masses, relative_density);
}

// A new point is of a region if both its neighbours are.
template <int dim>
unsigned char
Fluid<dim>::region_between(const unsigned int i, const unsigned int j) const
{
  if (options.regions.empty())
    return 0;
  if (is_structure(i) || is_structure(j))
    return region[is_structure(i) ? j : i];
  return region[i] == region[j] ? region[i] : 0;
}

// As diffuse(), all directions at once, as the symmetric gradient couples them.
template <int dim>
void
Fluid<dim>::diffuse_regions(const double dt, const std::vector<Vector> &acceleration)
{
  const FluidOperators<dim> apply(mesh, moved_rules, halo);
  std::vector<Vector>       force, balanced(acceleration), change(points.n_own);
  std::vector<double>       own_mass(points.n_own), factor(viscosity);
  auto                     &fixed = held_directions;
  fixed.assign(points.size(), 0);
  known_force.resize(points.n_own);
  apply.viscous_force(velocity, viscosity, force);
  if (pressure_solves > 0)
    {
      apply.gradient(pressure, gradient);
      for (std::size_t i = 0; i < points.n_own; ++i)
        if (!isolated[i])
          balanced[i] =
            (gradient[i] - pressure[i] * surface_area[i]) / (options.density * moved_mass[i]);
    }
  for (double &f : factor)
    f *= options.time_weight * dt;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (unsigned int d = 0; d < dim; ++d)
      fixed[i] |= is_held(i, d) << d;
  for (std::size_t i = 0; i < points.n_own; ++i)
    {
      own_mass[i]    = options.density * moved_mass[i];
      known_force[i] = own_mass[i] * balanced[i];
      force[i]       = dt * (own_mass[i] * (acceleration[i] - balanced[i]) - force[i]);
    }
  viscous_system.assemble(mesh, moved_rules, own_mass, factor, fixed);
  last_viscous_solve = viscous_system.solve(force, change, options.solver);
  unconverged_viscous_solves += !last_viscous_solve.converged;
  for (std::size_t i = 0; i < points.n_own; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      if (!(fixed[i] >> d & 1))
        predicted[i][d] = velocity[i][d] + change[i][d] + dt * balanced[i][d];
}

// The new pressure in the viscous solution after all: (M + theta dt V) of the velocity's change
// from the old one is what all forces give, and a solid stays rigid. What is left of divergence is
// at the rim of what is viscous.
template <int dim>
void
Fluid<dim>::stiffen(const double dt)
{
  std::vector<Vector> left(points.n_own), change(points.n_own);
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      if (!isolated[i])
        left[i] = dt * (known_force[i] - gradient[i]);
      for (unsigned int d = 0; d < dim && !isolated[i]; ++d)
        change[i][d] = left[i][d] / (options.density * moved_mass[i]);
    }
  auto solved        = change;
  last_viscous_solve = viscous_system.solve(left, solved, options.solver);
  unconverged_viscous_solves += !last_viscous_solve.converged;
  stiffened.assign(points.n_own, Vector());
  for (std::size_t i = 0; i < n_cloud; ++i)
    for (unsigned int d = 0; d < dim; ++d)
      if (!(held_directions[i] >> d & 1))
        {
          stiffened[i][d] = solved[i][d] - change[i][d];
          corrected[i][d] += stiffened[i][d];
        }
}

// Points outside of regions that are about to come into the spheres of a region's elements. What is
// asked of each pair and facet of a region's points is asked in the elements of the point, so that
// it is the same on any number of ranks.
template <int dim>
void
Fluid<dim>::find_encroaching(const std::vector<dealii::Point<dim>> &x,
                             std::vector<double>                   &marks) const
{
  std::vector<unsigned int> rim, outside;
  const double              h = options.spacing;
  for (unsigned int e = 0; e < element_region.size(); ++e)
    {
      if (element_region[e] > 0)
        continue;
      rim.clear();
      outside.clear();
      for (unsigned int k = mesh.first_node[e]; k < mesh.first_node[e + 1]; ++k)
        if (const unsigned int i = mesh.node[k]; !is_structure(i))
          (region[i] > 0 ? rim : outside).push_back(i);
      for (std::size_t a = 0; a < rim.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          if (region[rim[a]] == region[rim[b]])
            for (const unsigned int tip : outside)
              {
                const double share = free_surface[tip] ? keep_off_surface<dim> : keep_off<dim>;
                bool         near  = false;
                if constexpr (dim == 2)
                  near = is_before<2>(x[tip], {{x[rim[a]], x[rim[b]]}}, h, share);
                else
                  {
                    near = is_beside_edge(x[tip], x[rim[a]], x[rim[b]], h);
                    for (std::size_t c = 0; c < b && !near; ++c)
                      near = region[rim[c]] == region[rim[a]] &&
                             is_before<3>(x[tip], {{x[rim[a]], x[rim[b]], x[rim[c]]}}, h, share);
                  }
                if (near)
                  marks[tip] += 1;
              }
    }
}

// Those in the sphere of an element of a region that is not theirs, or so near to it that they
// would soon be.
template <int dim>
std::vector<unsigned char>
Fluid<dim>::find_intruders(const std::vector<NewPoint>           &new_points,
                           const std::vector<dealii::Point<dim>> &x) const
{
  std::vector<unsigned char> result(new_points.size());
  if (options.regions.empty() || new_points.empty())
    return result;
  for (unsigned int e = 0; e < element_region.size(); ++e)
    {
      if (element_region[e] == 0 || mesh.first_simplex[e] == mesh.first_simplex[e + 1])
        continue;
      std::array<dealii::Point<dim>, dim + 1> corners;
      for (unsigned int i = 0; i <= dim; ++i)
        corners[i] = x[mesh.simplex[mesh.first_simplex[e]][i]];
      if (least_height<dim>(corners) < flat * options.spacing)
        continue;
      const auto   center = sphere_center<dim>(corners);
      const double reach  = std::pow(keep_off_sphere, 2) * center.distance_square(corners[0]);
      for (std::size_t k = 0; k < new_points.size(); ++k)
        result[k] |= new_points[k].region != element_region[e] &&
                     period.nearest(new_points[k].position - center).norm_square() < reach;
    }
  for (const auto &there : dealii::Utilities::MPI::all_gather(comm, result))
    for (std::size_t k = 0; k < result.size(); ++k)
      result[k] |= there[k];
  return result;
}

template <int dim>
std::vector<typename Fluid<dim>::Summary>
Fluid<dim>::region_summaries() const
{
  constexpr unsigned int n_sums = 1 + 2 * dim;
  const std::size_t      n      = options.regions.size();
  std::vector<double>    sums(n * n_sums), total(n * n_sums), inside(mesh.n_elements());
  for (std::size_t k = 0; k < n; ++k)
    {
      for (unsigned int e = 0; e < mesh.n_elements(); ++e)
        inside[e] = element_region[e] == k + 1;
      rules.for_each(mesh,
                     inside,
                     [&](const unsigned int *nodes,
                         const unsigned int  n_nodes,
                         const double        weight,
                         const double       *value,
                         const Vector *) {
                       double *const sum = &sums[k * n_sums];
                       sum[0] += weight;
                       for (unsigned int i = 0; i < n_nodes; ++i)
                         for (unsigned int d = 0; d < dim; ++d)
                           {
                             sum[1 + d] += weight * value[i] * points.position[nodes[i]][d];
                             sum[1 + dim + d] += weight * value[i] * velocity[nodes[i]][d];
                           }
                     });
    }
  MPI_Allreduce(sums.data(), total.data(), total.size(), MPI_DOUBLE, MPI_SUM, comm);
  std::vector<Summary> result(n);
  for (std::size_t k = 0; k < n; ++k)
    {
      const double *const sum = &total[k * n_sums];
      result[k].volume        = sum[0];
      result[k].mass          = options.regions[k].density * sum[0];
      for (unsigned int d = 0; d < dim && sum[0] > 0; ++d)
        {
          result[k].centre[d]   = sum[1 + d] / sum[0];
          result[k].velocity[d] = sum[1 + dim + d] / sum[0];
        }
    }
  return result;
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
