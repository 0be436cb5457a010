// SPDX-License-Identifier: GPL-3.0-or-later
// A body whose elements are halved while it moves keeps its mass, centre, momentum and angular
// momentum to round-off, and its energy in the books; a uniform strain stays one, without a force
// on any node inside; a vibrating bar goes on vibrating. In 2-D and 3-D, with both integrations,
// and several levels with hanging nodes on any number of ranks.
#include <coracle/base/mpi.h>

#include "bodies.h"

using namespace coracle;

namespace
{
std::string
text(const std::string &model,
     const std::string &integration,
     const std::string &mesh,
     const std::string &more = "")
{
  return "subsection Materials\n subsection m\n set Model = " + model +
         "\n set Density = 1000\n set Young modulus = 1 MPa\n set Poisson ratio = 0.3\n end\nend\n"
         "subsection Bodies\n subsection body\n set Material = m\n set Integration = " +
         integration + "\n" + more + " subsection Mesh\n" + mesh + "\n end\n end\nend\n";
}

template <int dim>
dealii::Point<dim>
centre_of(const StructureMesh<dim> &mesh, const unsigned int element)
{
  dealii::Point<dim> centre;
  for (const unsigned int n : mesh.elements[element])
    centre += mesh.nodes[n] / double(mesh.nodes_per_element);
  return centre;
}

/// Elements whose middle is this near to the origin.
template <int dim>
bool
refine_near(SolidBody<dim> &body, const double distance)
{
  std::vector<bool> wanted;
  for (unsigned int e = 0; e < body.mesh().n_elements(); ++e)
    wanted.push_back(centre_of(body.mesh(), e).norm() < distance);
  return body.refine(wanted);
}

/// Sums over the nodes, from their columns alone.
template <int dim>
struct Totals
{
  explicit Totals(const SolidBody<dim> &body)
  {
    using Node = NodeColumns<dim>;
    for (unsigned int n = 0; n < body.mesh().n_owned_nodes(); ++n)
      {
        const double m = body.nodes()[Node::mass][n];
        mass += m;
        first_moment += m * body.position(n);
        momentum += m * body.velocity(n);
        angular_momentum += moment_of<dim>(body.position(n), m * body.velocity(n));
        kinetic += 0.5 * m * body.velocity(n).norm_square();
      }
    const MPI_Comm comm = MPI_COMM_WORLD;
    mass                = mpi::sum(mass, comm);
    first_moment        = mpi::sum(first_moment, comm);
    momentum            = mpi::sum(momentum, comm);
    angular_momentum    = mpi::sum(angular_momentum, comm);
    kinetic             = mpi::sum(kinetic, comm);
  }
  double                 mass = 0, kinetic = 0;
  dealii::Tensor<1, dim> first_moment, momentum;
  dealii::Tensor<1, 3>   angular_momentum;
};

/// Positions and velocities of a turning, bending, rough motion, as one step.
template <int dim>
void
stir(SolidBody<dim> &body)
{
  using Node = NodeColumns<dim>;
  for (unsigned int n = 0; n < body.mesh().n_nodes(); ++n)
    {
      const auto   x = body.mesh().nodes[n];
      const double y = x[dim - 1];
      for (int d = 0; d < dim; ++d)
        {
          const double u                       = 0.02 * std::sin(2. * x[0] + d) + 0.03 * x[0] * y;
          body.nodes()[Node::increment + d][n] = u;
          body.nodes()[Node::position + d][n]  = x[d] + u;
          body.nodes()[Node::velocity + d][n]  = (d == 0 ? 1. : 0.3) +
                                                (d == 0 ? -5. : 5.) * x[1 - std::min(d, 1)] +
                                                std::cos(17. * x[0] + 11. * y + 3. * d);
        }
    }
  body.update_stress(1e-3);
}

/// Of all ranks: nothing but hanging nodes moves other than by itself.
template <int dim>
double
largest_misfit_of_hanging_nodes(const SolidBody<dim> &body)
{
  double worst = 0;
  for (const auto &hanging : body.mesh().hanging_nodes)
    {
      auto x = body.position(hanging.node);
      auto v = body.velocity(hanging.node);
      for (const auto &[parent, weight] : hanging.parents)
        {
          x -= weight * dealii::Tensor<1, dim>(body.position(parent));
          v -= weight * body.velocity(parent);
        }
      worst = std::max({worst, dealii::Tensor<1, dim>(x).norm(), v.norm()});
    }
  return mpi::max(worst, MPI_COMM_WORLD);
}

template <int dim>
void
conservation(const std::string &model, const std::string &integration)
{
  const BodyCase body_case(text(model, integration, "set Subdivisions = 3"), dim);
  const auto     body = body_case.solid<dim>();
  stir(*body);
  const Totals<dim> start(*body);
  const Energies    books = body->energies();
  bool              kept = true, in_books = true;
  for (const double distance : {0.9, 0.6, 0.3})
    {
      refine_near(*body, distance);
      const Totals<dim> now(*body);
      const double      size = start.mass * 5.;
      const double      worst =
        std::max({std::fabs(now.mass - start.mass) / start.mass,
                  (now.first_moment - start.first_moment).norm() / start.mass,
                  (now.momentum - start.momentum).norm() / size,
                  (now.angular_momentum - start.angular_momentum).norm() / size});
      kept             = kept && worst < 1e-14;
      const Energies e = body->energies();
      in_books         = in_books && std::fabs(e.kinetic - now.kinetic) < 1e-12 * now.kinetic &&
                 std::fabs((e.kinetic - books.kinetic) + (e.strain - books.strain) +
                           (e.hourglass - books.hourglass)) < 1e-12 * now.kinetic;
    }
  const Totals<dim> end(*body);
  unsigned int      n_hanging = 0;
  for (const auto &hanging : body->mesh().hanging_nodes)
    n_hanging += hanging.node < body->mesh().n_owned_nodes();
  deallog << dim << "-D, " << model << ", " << integration << ": "
          << body->mesh().n_global_elements() << " elements, " << body->mesh().n_global_nodes()
          << " nodes, hanging ones " << mpi::sum(n_hanging, MPI_COMM_WORLD)
          << ", all kept: " << kept << ", in the books: " << in_books
          << ", hanging nodes fit: " << (largest_misfit_of_hanging_nodes(*body) < 1e-14)
          << ", kinetic energy left " << end.kinetic / start.kinetic << std::endl;
}

template <int dim>
void
patch(const std::string &model, const std::string &integration)
{
  const std::string mesh = (dim == 2 ? "set Type = wedge\nset Subdivisions = 1"
                                     : "set Type = wedge\nset Subdivisions = 1\nset Length = 0.5");
  const BodyCase    body_case(text(model, integration, mesh), dim);
  const auto        body = body_case.solid<dim>();
  using Node             = NodeColumns<dim>;
  for (unsigned int n = 0; n < body->mesh().n_nodes(); ++n)
    {
      const auto x = body->mesh().nodes[n];
      for (int d = 0; d < dim; ++d)
        {
          const double u                        = 0.05 * x[d] - 0.03 * x[(d + 1) % dim];
          body->nodes()[Node::increment + d][n] = u;
          body->nodes()[Node::position + d][n]  = x[d] + u;
        }
    }
  body->update_stress(1e-3);
  auto mean = body->mesh().n_elements() > 0 ? body->stress(0) : Symmetric<dim, double>();
  for (int c = 0; c < mean.size; ++c)
    mean[c] = mpi::max(std::fabs(mean[c]), MPI_COMM_WORLD);
  for (const double distance : {0.4, 0.2})
    refine_near(*body, distance);

  double worst = 0, size = 0;
  for (unsigned int e = 0; e < body->mesh().n_elements(); ++e)
    for (int c = 0; c < mean.size; ++c)
      worst = std::max(worst, std::fabs(std::fabs(body->stress(e)[c]) - mean[c]));
  for (int c = 0; c < mean.size; ++c)
    size = std::max(size, mean[c]);
  // Condenses forces of hanging nodes.
  body->assemble_forces(0);
  Columns on_surface(1);
  on_surface.resize(body->mesh().n_nodes());
  for (const unsigned int n : body->surface_nodes())
    on_surface[0][n] = 1;
  body->mesh().exchange.sum_to_owners(on_surface, 0, 1);
  double inside = 0, outside = 0;
  for (unsigned int n = 0; n < body->mesh().n_owned_nodes(); ++n)
    for (int d = 0; d < dim; ++d)
      {
        double &largest = (on_surface[0][n] > 0 ? outside : inside);
        largest         = std::max(largest, std::fabs(body->nodes()[Node::internal + d][n]));
      }
  deallog << dim << "-D, " << model << ", " << integration << ": "
          << body->mesh().n_global_elements()
          << " elements, stress uniform: " << (mpi::max(worst, MPI_COMM_WORLD) < 1e-12 * size)
          << ", no force inside: "
          << (mpi::max(inside, MPI_COMM_WORLD) < 1e-12 * mpi::max(outside, MPI_COMM_WORLD))
          << std::endl;
}

/// The slowest vibration along a bar that is held at one end, for one period: half of its elements,
/// and later a quarter once more, are halved on the way. All kinetic energy must come back at the
/// end.
template <int dim>
void
vibrating_bar(const std::string &model, const std::string &integration)
{
  using Node           = NodeColumns<dim>;
  const unsigned int n = 16;
  const std::string  box =
    (dim == 2 ? "set Upper corner = 1, 0.125\nset Subdivisions = 16, 2"
              : "set Upper corner = 1, 0.125, 0.125\nset Subdivisions = 16, 2, 2");
  const std::string supports = " subsection Boundary conditions\n subsection held\n"
                               " set Boundary id = 0\n set Directions = x\n end\n end\n";
  std::string       whole    = text(model, integration, box, supports);
  whole.replace(whole.find("ratio = 0.3"), 11, "ratio = 0.0");
  const BodyCase body_case(whole, dim);
  const auto     body = body_case.solid<dim>();
  for (unsigned int i = 0; i < body->mesh().n_nodes(); ++i)
    body->nodes()[Node::velocity][i] =
      0.01 * std::sin(0.5 * dealii::numbers::PI * body->mesh().nodes[i][0]);
  const double   period = 4 / std::sqrt(1e6 / 1000), start = body->energies().kinetic;
  const Energies books = body->energies();
  double         time = 0, least = start;
  unsigned int   refinements = 0;
  while (time < period * (1 - 1e-12))
    {
      if (time > (refinements == 0 ? 0.15 : 0.6) * period && refinements < 2)
        refine_near(*body, refinements++ == 0 ? 0.5 : 0.25);
      const double dt = std::min(0.5 * stable_step(*body), period - time);
      step(*body, time, dt);
      time += dt;
      least = std::min(least, body->energies().kinetic);
    }
  const Energies e = body->energies();
  const double   balance =
    e.kinetic - start + e.strain - books.strain + e.hourglass - e.external_work;
  deallog << dim << "-D bar, " << model << ", " << integration << ": from "
          << n * (dim == 2 ? 2 : 4) << " to " << body->mesh().n_global_elements()
          << " elements, kinetic energy comes back to 0.5 %: "
          << (std::fabs(e.kinetic / start - 1) < 0.005)
          << ", and has been turned over: " << (least < 0.001 * start)
          << ", balance: " << (std::fabs(balance) < 1e-12 * start) << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  for (const char *integration : {"full", "one point"})
    for (const char *model : {"neo-Hookean", "linear elastic"})
      {
        conservation<2>(model, integration);
        conservation<3>(model, integration);
        patch<2>(model, integration);
        patch<3>(model, integration);
        vibrating_bar<2>(model, integration);
      }
  vibrating_bar<3>("linear elastic", "one point");
}
