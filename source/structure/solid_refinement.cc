// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <coracle/base/mpi.h>
#include <coracle/structure/solid_body.h>

#include <cmath>

namespace coracle
{
namespace
{
/// Rotations about this many axes.
template <int dim>
constexpr int n_spins = (dim == 2 ? 1 : 3);

/// Velocity along direction d of a node at an arm by a unit spin about axis k.
template <int dim>
double
by_spin(const int k, const int d, const dealii::Tensor<1, dim> &arm)
{
  dealii::Tensor<1, 3> spin;
  spin[dim == 2 ? 2 : k] = 1;
  return velocity_from_spin<dim>(spin, arm)[d];
}
} // namespace

template <int dim>
typename SolidBody<dim>::Motion
SolidBody<dim>::motion() const
{
  const Columns &nodes = this->node_columns;
  RankSums       sums(dim + 3 + 1, reproducible);
  for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
    {
      const double mass     = nodes[Node::mass][n];
      const Vector momentum = mass * this->velocity(n);
      const auto   moment   = moment_of<dim>(this->position(n), momentum);
      for (int d = 0; d < dim; ++d)
        sums.add(d, momentum[d]);
      for (int d = 0; d < 3; ++d)
        sums.add(dim + d, moment[d]);
      sums.add(dim + 3, 0.5 * momentum * this->velocity(n));
    }
  const auto total = sums.total(mesh().communicator());
  Motion     result;
  std::copy_n(total.begin(), dim, result.momentum.begin_raw());
  std::copy_n(total.begin() + dim, 3, result.angular_momentum.begin_raw());
  result.kinetic = total.back();
  return result;
}

template <int dim>
bool
SolidBody<dim>::refine(const std::vector<bool> &wanted)
{
  const Motion before = motion();
  // Elements hand on what they know of their corners; this one only owners know.
  mesh().exchange.update_ghosts(this->node_columns, Node::contact_force, dim);
  Columns           rows = elements.rows();
  CarriedState<dim> state{this->node_columns,
                          rows,
                          [this](const double *parent, const unsigned int child, double *row) {
                            elements.child_row(parent, child, row);
                          }};
  if (!changing_mesh().refine(wanted, state))
    return false;
  follow_mesh(state);
  restore_motion(before, state);
  // The kinetic energy of motion that the new, smoother one does not have.
  if (mpi::rank(mesh().communicator()) == 0)
    books.strain += before.kinetic;
  const double after = motion().kinetic;
  if (mpi::rank(mesh().communicator()) == 0)
    books.strain -= after;
  // Before the first step nothing has moved.
  mpi::agree([&] { elements.hold(this->node_columns, last_dt > 0 ? last_dt : 1.); },
             mesh().communicator());
  return true;
}

template <int dim>
void
SolidBody<dim>::share_out()
{
  Columns &nodes = this->node_columns;
  // Sums that ranks have parts of, whole at the owners; elements hand on what they know of corners.
  condense(Node::internal, 2 * dim);
  mesh().exchange.sum_to_owners(nodes, Node::internal, 2 * dim);
  for (const unsigned int column : {Node::internal, Node::external, Node::contact_force})
    mesh().exchange.update_ghosts(nodes, column, dim);
  Columns           rows = elements.rows();
  CarriedState<dim> state{nodes, rows, {}};
  changing_mesh().share_out(state);
  for (unsigned int c = Node::internal; c < Node::internal + 2 * dim; ++c)
    std::fill(nodes[c] + mesh().n_owned_nodes(), nodes[c] + mesh().n_nodes(), 0.);
  take_mesh(state);
}

template <int dim>
void
SolidBody<dim>::take_mesh(const CarriedState<dim> &state)
{
  elements.reinit(mesh(), state.elements);
  this->find_surface_nodes();
  boundary_conditions = BoundaryConditions<dim>(section, mesh());
  loads               = Loads<dim>(section, mesh());
  if (is_met_in_volume)
    contact_through_volume();
  else
    find_contact_nodes();
}

template <int dim>
void
SolidBody<dim>::follow_mesh(const CarriedState<dim> &state)
{
  Columns &nodes = this->node_columns;
  take_mesh(state);
  // Forces are of nodes that were there, not of places.
  for (int d = 0; d < dim; ++d)
    for (unsigned int n = 0; n < nodes.size(); ++n)
      if (state.is_new_node[n])
        nodes[Node::contact_force + d][n] = 0;
  set_mass();
}

template <int dim>
void
SolidBody<dim>::restore_motion(const Motion &before, const CarriedState<dim> &state)
{
  distribute(Node::velocity);
  Columns &nodes = this->node_columns;
  // The column is free between steps.
  for (unsigned int e = 0; e < mesh().n_elements(); ++e)
    if (state.is_child[e])
      for (const unsigned int n : mesh().elements[e])
        nodes[Node::impulse][n] = 1;
  mesh().exchange.sum_to_owners(nodes, Node::impulse, 1);
  std::vector<unsigned int> changed;
  for (unsigned int n = 0; n < mesh().n_owned_nodes(); ++n)
    if (nodes[Node::impulse][n] > 0 && nodes[Node::mass][n] > 0)
      changed.push_back(n);
  std::fill_n(nodes[Node::impulse], nodes.size(), 0.);

  Motion missing                   = motion();
  missing.momentum                 = before.momentum - missing.momentum;
  missing.angular_momentum         = before.angular_momentum - missing.angular_momentum;
  const std::vector<double> change = rigid_change(changed, missing);
  for (unsigned int i = 0; i < changed.size(); ++i)
    for (int d = 0; d < dim; ++d)
      nodes[Node::velocity + d][changed[i]] += change[dim * i + d];
  distribute(Node::velocity);
}

// Of all changes of velocities with these sums, the one with the least kinetic energy is a rigid
// motion, as far as directions are free: normal equations of its velocity and spin.
template <int dim>
std::vector<double>
SolidBody<dim>::rigid_change(const std::vector<unsigned int> &which, const Motion &missing)
{
  constexpr int  n     = dim + n_spins<dim>;
  const Columns &nodes = this->node_columns;
  const double  *mass  = nodes[Node::mass];
  const MPI_Comm comm  = mesh().communicator();
  RankSums       first(1 + dim, reproducible);
  for (const unsigned int i : which)
    {
      first.add(0, mass[i]);
      for (int d = 0; d < dim; ++d)
        first.add(1 + d, mass[i] * this->position(i)[d]);
    }
  const auto         moments = first.total(comm);
  dealii::Point<dim> centre;
  for (int d = 0; d < dim; ++d)
    centre[d] = moments[1 + d] / moments[0];

  const auto arm  = [&](const unsigned int i) { return this->position(i) - centre; };
  const auto mode = [&](const int k, const int d, const Vector &r) {
    return k < dim ? double(k == d) : by_spin<dim>(k - dim, d, r);
  };
  RankSums second(n * n + 1, reproducible);
  for (const unsigned int i : which)
    {
      const Vector r = arm(i);
      second.add(n * n, mass[i] * r.norm_square());
      for (int d = 0; d < dim; ++d)
        if (nodes[Node::inverse_mass + d][i] > 0)
          for (int k = 0; k < n; ++k)
            for (int l = 0; l < n; ++l)
              second.add(k * n + l, mass[i] * mode(k, d, r) * mode(l, d, r));
    }
  const auto   sums = second.total(comm);
  const double size = std::sqrt(sums.back() / moments[0]);
  // Without units, so that what cannot be moved shows in singular values.
  const auto                       scale = [&](const int k) { return k < dim ? 1. : 1. / size; };
  dealii::LAPACKFullMatrix<double> matrix(n, n);
  dealii::Vector<double>           right(n), motion(n);
  const auto moment = missing.angular_momentum - moment_of<dim>(centre, missing.momentum);
  for (int k = 0; k < n; ++k)
    {
      for (int l = 0; l < n; ++l)
        matrix(k, l) = sums[k * n + l] * scale(k) * scale(l) / moments[0];
      right[k] =
        scale(k) / moments[0] * (k < dim ? missing.momentum[k] : moment[dim == 2 ? 2 : k - dim]);
    }
  constexpr double singular = 1e-10;
  matrix.compute_inverse_svd(singular);
  matrix.vmult(motion, right);

  std::vector<double> change;
  for (const unsigned int i : which)
    for (int d = 0; d < dim; ++d)
      {
        double sum = 0;
        for (int k = 0; k < n; ++k)
          sum += motion[k] * scale(k) * mode(k, d, arm(i));
        change.push_back(nodes[Node::inverse_mass + d][i] > 0 ? sum : 0.);
      }
  return change;
}

template <int dim>
void
SolidBody<dim>::make_room()
{
  this->node_columns = Columns(Node::n_columns);
  this->node_columns.resize(mesh().n_nodes());
  Columns rows = Columns(elements.rows().n_columns());
  rows.resize(mesh().n_elements());
  CarriedState<dim> state{this->node_columns, rows, {}};
  state.is_new_node.resize(mesh().n_nodes());
  follow_mesh(state);
}

template <int dim>
std::vector<double>
SolidBody<dim>::stress_jumps() const
{
  constexpr unsigned int n = Symmetric<dim, double>::size;
  const auto            &m = mesh();
  // Mass times stress, and mass.
  Columns means(n + 1);
  means.resize(m.n_nodes());
  double largest[2] = {0, 0};
  for (unsigned int e = 0; e < m.n_elements(); ++e)
    {
      largest[1] = std::max(largest[1], elements.mass(e));
      for (unsigned int c = 0; c < n; ++c)
        largest[0] = std::max(largest[0], std::fabs(elements.mass(e) * stress(e)[c]));
    }
  const SumGrid of_stress = sum_grid(largest[0]), of_mass = sum_grid(largest[1]);
  for (unsigned int e = 0; e < m.n_elements(); ++e)
    {
      const auto mean = stress(e);
      for (const unsigned int node : m.elements[e])
        {
          for (unsigned int c = 0; c < n; ++c)
            means[c][node] += of_stress.round(elements.mass(e) * mean[c]);
          means[n][node] += of_mass.round(elements.mass(e));
        }
    }
  for (const HangingNode &hanging : m.hanging_nodes)
    for (unsigned int c = 0; c <= n; ++c)
      for (const auto &[parent, weight] : hanging.parents)
        means[c][parent] += weight * means[c][hanging.node];
  m.exchange.sum_to_owners(means, 0, n + 1);
  for (unsigned int node = 0; node < m.n_owned_nodes(); ++node)
    for (unsigned int c = 0; c < n && means[n][node] > 0; ++c)
      means[c][node] /= means[n][node];
  m.exchange.update_ghosts(means, 0, n);
  for (const HangingNode &hanging : m.hanging_nodes)
    for (unsigned int c = 0; c < n; ++c)
      {
        means[c][hanging.node] = 0;
        for (const auto &[parent, weight] : hanging.parents)
          means[c][hanging.node] += weight * means[c][parent];
      }

  std::vector<double> result;
  for (unsigned int e = 0; e < m.n_elements(); ++e)
    {
      auto jump = stress(e);
      for (const unsigned int node : m.elements[e])
        for (unsigned int c = 0; c < n; ++c)
          jump[c] -= means[c][node] / m.nodes_per_element;
      double square = 0;
      for (unsigned int c = 0; c < n; ++c)
        square += (c < 3 ? 1 : 2) * jump[c] * jump[c];
      result.push_back(std::sqrt(square));
    }
  return result;
}

#define INSTANTIATE(dim)                                                                           \
  template typename SolidBody<dim>::Motion SolidBody<dim>::motion() const;                         \
  template bool                            SolidBody<dim>::refine(const std::vector<bool> &);      \
  template void                            SolidBody<dim>::make_room();                            \
  template void                            SolidBody<dim>::share_out();                            \
  template void                            SolidBody<dim>::take_mesh(const CarriedState<dim> &);   \
  template std::vector<double>             SolidBody<dim>::stress_jumps() const;                   \
  template void                            SolidBody<dim>::follow_mesh(const CarriedState<dim> &); \
  template void SolidBody<dim>::restore_motion(const Motion &, const CarriedState<dim> &);         \
  template std::vector<double> SolidBody<dim>::rigid_change(const std::vector<unsigned int> &,     \
                                                            const Motion &);

INSTANTIATE(2)
INSTANTIATE(3)
} // namespace coracle
