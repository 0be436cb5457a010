// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/base/mpi.h>
#include <coracle/structure/elements.h>
#include <coracle/structure/update_elements.h>

#include <cmath>
#include <sstream>

namespace coracle
{
namespace
{
/// Corner coordinates of an element, in the form that element_geometry.h takes.
template <int dim>
NodalVectors<dim, double>
corners(const StructureMesh<dim> &mesh, const unsigned int element)
{
  NodalVectors<dim, double> x;
  for (int n = 0; n < nodes_per_element<dim>; ++n)
    for (int d = 0; d < dim; ++d)
      x[d][n] = mesh.nodes[mesh.elements[element][n]][d];
  return x;
}

/// Value of shape function n at Gauss point q.
template <int dim>
double
shape_value(const int n, const int q)
{
  constexpr double near = 0.5 * (1. + 0.57735026918962576451), far = 1. - near;
  double           value = 1.;
  for (int d = 0; d < dim; ++d)
    value *= (((n ^ q) >> d) & 1) == 0 ? near : far;
  return value;
}

/// Is the volume at any Gauss point not positive?
template <int dim>
bool
is_turned_out(NodalVectors<dim, double> x)
{
  for (auto &component : x)
    {
      to_modes<dim>(component);
      scale_for_gauss_points<dim>(component);
    }
  for (int q = 0; q < nodes_per_element<dim>; ++q)
    if (!(determinant<dim, double>(point_gradient<dim, double>(x, q)) > 0))
      return true;
  return false;
}

/**
 * Resistance to a small shear, found by trying it; for liquids, which have none, a thousandth of
 * the modulus of pressure waves, so that hourglasses are still held [Pa].
 */
double
shear_modulus(const MaterialVariant &material)
{
  return std::visit(
    [](const auto &m) {
      using Material           = std::decay_t<decltype(m)>;
      constexpr double  strain = 1e-6;
      Motion<3, double> motion{};
      motion.velocity_gradient[0][1] = motion.velocity_gradient[1][0] = strain;
      motion.deformation_gradient                                     = identity<3, double>();
      motion.deformation_gradient[0][1] = motion.deformation_gradient[1][0] = strain;
      motion.density                                                        = m.reference_density();
      motion.length = motion.dt = 1;
      Symmetric<3, double>                                 stress;
      std::array<double, std::max(Material::n_history, 1)> history{};
      m.template update<3, double>(motion, stress, history.data());
      const double speed = m.sound_speed(m.reference_density());
      return std::max(stress(0, 1) / (2 * strain), 1e-3 * m.reference_density() * speed * speed);
    },
    material);
}

double
reference_density(const MaterialVariant &material)
{
  return std::visit([](const auto &m) { return m.reference_density(); }, material);
}
} // namespace

template <int dim>
Elements<dim>::Elements(const StructureMesh<dim> &mesh,
                        const MaterialVariant    &material,
                        const Integration         integration,
                        const double              hourglass_coefficient)
  : material(material)
  , integration(integration)
  , n_elements(mesh.n_elements())
  , stable_step(std::numeric_limits<double>::infinity())
{
  data.hourglass_modulus = hourglass_coefficient * shear_modulus(material);
  data.n_history  = std::visit([](const auto &m) -> unsigned int { return m.n_history; }, material);
  data.n_elements = n_elements;
  allocate(mesh);
  compute_reference(mesh);
}

template <int dim>
void
Elements<dim>::allocate(const StructureMesh<dim> &mesh)
{
  data.n_packs = (n_elements + pack_size - 1) / pack_size;
  data.connectivity.resize(std::size_t(data.n_packs) * pack_size * n_nodes);
  for (unsigned int i = 0; i < data.n_packs * pack_size; ++i)
    for (int n = 0; n < n_nodes; ++n)
      data.connectivity[(i / pack_size * n_nodes + n) * pack_size + i % pack_size] =
        mesh.elements[std::min(i, n_elements - 1)][n];
  data.columns = Columns(data.stress(n_points()));
  data.columns.resize(std::size_t(data.n_packs) * pack_size);
}

template <int dim>
void
Elements<dim>::compute_reference(const StructureMesh<dim> &mesh)
{
  const double density = reference_density(material);
  for (unsigned int i = 0; i < data.n_packs * pack_size; ++i)
    {
      NodalVectors<dim, double> b;
      const double              volume =
        mean_gradient<dim, double>(corners(mesh, std::min(i, n_elements - 1)), b);
      data.columns[Data::volume][i] = volume;
      data.columns[Data::mass][i]   = density * volume;
    }
}

template <int dim>
double
Elements<dim>::largest_mass() const
{
  double result = 0;
  for (unsigned int e = 0; e < n_elements; ++e)
    result = std::max(result, data.columns[Data::mass][e]);
  return result;
}

template <int dim>
void
Elements<dim>::add_mass(double *const             nodal_mass,
                        const StructureMesh<dim> &mesh,
                        const SumGrid            &grid) const
{
  const double density = reference_density(material);
  for (unsigned int e = 0; e < n_elements; ++e)
    {
      NodalVectors<dim, double> modes = corners(mesh, e);
      for (auto &component : modes)
        {
          to_modes<dim>(component);
          scale_for_gauss_points<dim>(component);
        }
      for (int q = 0; q < n_nodes; ++q)
        {
          const double det = determinant<dim, double>(point_gradient<dim, double>(modes, q));
          for (int n = 0; n < n_nodes; ++n)
            nodal_mass[mesh.elements[e][n]] += grid.round(density * det * shape_value<dim>(n, q));
        }
    }
}

template <int dim>
void
Elements<dim>::make_reproducible(MPI_Comm comm)
{
  communicator = comm;
  data.apart   = true;
  data.forces.resize(std::size_t(data.n_packs) * pack_size * n_nodes * dim);
}

template <int dim>
void
Elements<dim>::add_rounded_forces(Columns &nodes) const
{
  // A node has elements around it and around nodes that hang on it, with weights like 1/4.
  constexpr int bits    = 10;
  constexpr int stride  = n_nodes * pack_size;
  double        largest = 0;
  for (const double force : data.forces)
    largest = std::max(largest, std::abs(force));
  const SumGrid grid(mpi::max(largest, communicator), bits);
  for (unsigned int pack = 0; pack < data.n_packs; ++pack)
    {
      const unsigned int n_lanes = std::min<unsigned int>(pack_size, n_elements - pack * pack_size);
      for (int d = 0; d < dim; ++d)
        for (int n = 0; n < n_nodes; ++n)
          for (unsigned int l = 0; l < n_lanes; ++l)
            nodes[NodeColumns<dim>::internal + d]
                 [data.connectivity[pack * stride + n * pack_size + l]] -=
              grid.round(data.forces[(pack * dim + d) * stride + n * pack_size + l]);
    }
}

template <int dim>
template <typename Material>
void
Elements<dim>::update_with(const Material &m, Columns &nodes, const double dt)
{
  constexpr unsigned int first = NodeColumns<dim>::internal;
  for (unsigned int d = 0; d < dim; ++d)
    std::fill_n(nodes[first + d], nodes.size(), 0.);

  internal::Limits limits;
  internal::update_elements<dim>(m, integration == Integration::full, nodes, dt, data, limits);
  if (data.apart)
    add_rounded_forces(nodes);

  double rate = 0;
  for (int l = 0; l < pack_size; ++l)
    {
      rate = std::max(rate, limits.rate[l]);
      if (limits.is_good[l] == 0)
        report_failure(nodes);
    }
  stable_step = (rate > 0 ? 1. / rate : std::numeric_limits<double>::infinity());
}

template <int dim>
void
Elements<dim>::update(Columns &nodes, const double dt)
{
  std::visit([&](const auto &m) { update_with(m, nodes, dt); }, material);
}

template <int dim>
void
Elements<dim>::report_failure(const Columns &nodes) const
{
  for (unsigned int e = 0; e < n_elements; ++e)
    {
      NodalVectors<dim, double> x;
      dealii::Point<dim>        centre, reference;
      for (int n = 0; n < n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          {
            x[d][n] = nodes[NodeColumns<dim>::position + d][data.node(e, n)];
            centre[d] += x[d][n] / n_nodes;
            reference[d] += nodes[NodeColumns<dim>::reference + d][data.node(e, n)] / n_nodes;
          }
      const bool is_place = std::isfinite(centre.norm_square());
      if (!is_place || is_turned_out<dim>(x) || !std::isfinite(stress(e).trace()))
        {
          std::ostringstream what;
          what << "element " << e << " of " << n_elements << " on this rank, at (" << centre
               << ") m, unloaded at (" << reference << ") m";
          throw RunFailure(
            !is_place               ? "place of a node that is not a number"
            : is_turned_out<dim>(x) ? "element turned inside out"
                                    : "stress that is not a number",
            what.str(),
            "use smaller time steps, smaller or better shaped elements, or a stiffer material");
        }
    }
  throw RunFailure("element that cannot be computed",
                   "one of the elements on this rank",
                   "use smaller time steps");
}

template <int dim>
Symmetric<dim, double>
Elements<dim>::stress(const unsigned int element) const
{
  Symmetric<dim, double> mean;
  for (unsigned int q = 0; q < n_points(); ++q)
    for (int c = 0; c < mean.size; ++c)
      mean[c] += data.columns[data.stress(q) + c][element] / n_points();
  return mean;
}

template <int dim>
void
Elements<dim>::add_hourglass_energy(RankSums &sums, const unsigned int place) const
{
  for (unsigned int e = 0; e < n_elements; ++e)
    sums.add(place, data.columns[Data::energy][e]);
}

template <int dim>
void
Elements<dim>::serialize(Archive &archive, const std::vector<std::uint64_t> &keys)
{
  archive.keyed("elements", keys, n_elements, data.columns, {});
  archive.smallest("stable_step", stable_step);
  std::vector<double> last(data.columns.n_columns());
  for (unsigned int i = n_elements; i < data.columns.size(); ++i)
    {
      data.columns.get_row(n_elements - 1, last.data());
      data.columns.set_row(i, last.data());
    }
}

template <int dim>
Columns
Elements<dim>::rows() const
{
  Columns result = data.columns;
  result.resize(n_elements);
  return result;
}

template <int dim>
void
Elements<dim>::child_row(const double *parent, const unsigned int child, double *row) const
{
  std::copy_n(parent, data.columns.n_columns(), row);
  // The mode's amplitude is a quarter (of the last one in 3-D an eighth), and in 3-D the stiffness
  // of springs is half.
  constexpr int n_modes = n_hourglass_modes<dim>;
  for (int j = 0; j < dim; ++j)
    for (int m = 0; m < n_modes; ++m)
      row[Data::hourglass + j * n_modes + m] *= (dim == 2 ? 0.25 : m < 3 ? 0.125 : 0.0625);
  row[Data::energy] = parent[Data::energy] / (dim == 2 ? 16 : 32);
  if (integration == Integration::one_point)
    return;
  // Point q of the part, in coordinates in which the points of the whole are at -1 and 1.
  constexpr double root    = 1.7320508075688772935;
  const auto       weights = [&](const unsigned int q, const unsigned int p) {
    double weight = 1;
    for (int d = 0; d < dim; ++d)
      {
        const double x =
          0.5 * (((child >> d) & 1) == 0 ? -root : root) + 0.5 * (((q >> d) & 1) == 0 ? -1. : 1.);
        weight *= 0.5 * (1 + (((p >> d) & 1) == 0 ? -x : x));
      }
    return weight;
  };
  const unsigned int n_values = data.stress(1) - data.stress(0);
  for (unsigned int q = 0; q < n_nodes; ++q)
    for (unsigned int c = 0; c < n_values; ++c)
      {
        // From one of the points on, so that what is the same at all of them stays so exactly.
        const double first = parent[data.stress(0) + c];
        double       sum   = first;
        for (unsigned int p = 0; p < n_nodes; ++p)
          sum += weights(q, p) * (parent[data.stress(p) + c] - first);
        row[data.stress(q) + c] = sum;
      }
}

template <int dim>
void
Elements<dim>::reinit(const StructureMesh<dim> &mesh, const Columns &carried)
{
  n_elements      = mesh.n_elements();
  data.n_elements = n_elements;
  allocate(mesh);
  std::vector<double> row(data.columns.n_columns());
  for (unsigned int i = 0; i < data.n_packs * pack_size; ++i)
    {
      carried.get_row(std::min(i, n_elements - 1), row.data());
      data.columns.set_row(i, row.data());
    }
  compute_reference(mesh);
  if (data.apart)
    make_reproducible(communicator);
}

template <int dim>
void
Elements<dim>::hold(Columns &nodes, const double dt)
{
  // Springs of one-point elements remember too where they are in rate form.
  const bool from_motion = std::visit(
    [this](const auto &m) {
      using Material = std::decay_t<decltype(m)>;
      return !Material::remembers_stress &&
             (integration == Integration::full || Material::needs_deformation_gradient);
    },
    material);
  if (from_motion)
    return update(nodes, dt);
  // Nothing is to be added to springs.
  Columns kept(dim);
  kept.resize(nodes.size());
  for (unsigned int d = 0; d < dim; ++d)
    {
      double *const increment = nodes[NodeColumns<dim>::increment + d];
      std::copy_n(increment, nodes.size(), kept[d]);
      std::fill_n(increment, nodes.size(), 0.);
    }
  std::visit(
    [&](const auto &m) {
      update_with(internal::HeldStress<std::decay_t<decltype(m)>>{m}, nodes, dt);
    },
    material);
  for (unsigned int d = 0; d < dim; ++d)
    std::copy_n(kept[d], nodes.size(), nodes[NodeColumns<dim>::increment + d]);
}

template class Elements<2>;
template class Elements<3>;
} // namespace coracle
