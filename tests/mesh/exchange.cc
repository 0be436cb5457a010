// SPDX-License-Identifier: GPL-3.0-or-later
// Counting elements at nodes, summed over ranks, gives the same on any number of ranks, also with
// hanging nodes and where a rank has nothing; and hanging nodes lie in the middle of their parents.
#include "mesh_sections.h"

using namespace coracle;

template <int dim>
void
report(const std::string &title, const std::string &lines)
{
  const auto     mesh = mesh_from<dim>(lines);
  const MPI_Comm comm = mesh->communicator();
  // Column 0: elements at each node; columns 1 to dim: global number times the direction.
  Columns columns(1 + dim);
  columns.resize(mesh->n_nodes());
  for (const auto &element : mesh->elements)
    for (const unsigned int n : element)
      ++columns[0][n];
  mesh->exchange.sum_to_owners(columns, 0, 1);
  double weighted = 0, total = 0;
  for (unsigned int n = 0; n < mesh->n_owned_nodes(); ++n)
    {
      total += columns[0][n];
      weighted += columns[0][n] * mesh->nodes[n].norm_square();
      for (int d = 1; d <= dim; ++d)
        columns[d][n] = d * mesh->key(n);
    }
  mesh->exchange.update_ghosts(columns, 1, dim);
  bool good = true;
  for (unsigned int n = 0; n < mesh->n_nodes(); ++n)
    for (int d = 1; d <= dim; ++d)
      good = good && columns[d][n] == d * double(mesh->key(n)) &&
             (mesh->owner(n) == int(dealii::Utilities::MPI::this_mpi_process(comm))) ==
               (n < mesh->n_owned_nodes());
  double worst = 0;
  for (const HangingNode &hanging : mesh->hanging_nodes)
    {
      dealii::Tensor<1, dim> x = mesh->nodes[hanging.node];
      for (const auto &[parent, weight] : hanging.parents)
        x -= weight * mesh->nodes[parent];
      worst = std::max(worst, x.norm());
    }
  namespace MPI = dealii::Utilities::MPI;
  deallog << title << ": corners " << MPI::sum(total, comm) << ", weighted "
          << MPI::sum(weighted, comm) << ", ghosts right " << (MPI::min(int(good), comm) == 1)
          << ", hanging nodes are middles " << (MPI::max(worst, comm) < 1e-14) << ", facets "
          << MPI::sum(mesh->facets.size(), comm) << ", closed "
          << (facet_sums(*mesh).area.norm() < 1e-12) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  report<2>("wedge of three", "set Type = wedge\nset Subdivisions = 1");
  report<2>("one element", "");
  report<2>("disc", "set Type = ball\nset Refinements = 3");
  report<3>("ball", "set Type = ball\nset Refinements = 2");
  report<2>("hanging", "set Subdivisions = 4\nset Refined region = 0, 0, 0.5, 0.7");
  report<3>("hanging", "set Subdivisions = 4\nset Refined region = 0, 0, 0, 0.5, 0.5, 0.5");
}
