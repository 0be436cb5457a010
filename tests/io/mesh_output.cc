// SPDX-License-Identifier: GPL-3.0-or-later
// A sheared mesh has its exact area or volume in VTK's eyes, and its fields, also where a rank has
// no cell.
#include <coracle/io/mesh_output.h>

#include <deal.II/base/point.h>

#include "read_back.h"

using namespace coracle;

// A row of n cells from x = first; nodes stored with two unused ones in front and one behind.
template <int dim>
struct Row
{
  static constexpr unsigned int n_corners = 1 << dim;

  Row(const unsigned int first, const unsigned int n)
  {
    // Gradient of the deformation: an area doubled, then sheared.
    for (unsigned int i = 0; i < 2; ++i)
      nodes.emplace_back();
    for (unsigned int column = 0; n > 0 && column <= n; ++column)
      for (unsigned int corner = 0; corner < n_corners / 2; ++corner)
        {
          dealii::Point<dim> x;
          x[1] = corner % 2;
          if (dim == 3)
            x[dim - 1] = corner / 2;
          x[0] = 2. * (first + column) + 0.25 * x[1];
          nodes.push_back(x);
        }
    nodes.emplace_back();
    for (unsigned int c = 0; c < n; ++c)
      {
        std::array<unsigned int, n_corners> cell;
        for (unsigned int v = 0; v < n_corners; ++v)
          cell[v] = 2 + (c + v % 2) * (n_corners / 2) + v / 2;
        cells.push_back(cell);
        stress.push_back(first + c + 1.);
      }
    for (const auto &x : nodes)
      height.push_back(x[1]);
  }

  std::vector<dealii::Point<dim>>                  nodes;
  std::vector<std::array<unsigned int, n_corners>> cells;
  std::vector<double>                              stress, height;
};

template <int dim>
void
write(OutputDirectory &directory, const unsigned int rank, const unsigned int n_ranks)
{
  // Of three ranks the middle one has nothing.
  const Row<dim> row = (n_ranks == 1 ? Row<dim>(0, 5)
                        : rank == 0  ? Row<dim>(0, 2)
                        : rank == 2  ? Row<dim>(2, 3)
                                     : Row<dim>(0, 0));
  MeshOutput     output(directory, dim == 2 ? "plate" : "block");

  MeshView mesh;
  mesh.shape    = cell_shape<dim>;
  mesh.position = vector_field("position", "m", row.nodes);
  mesh.cells    = row.cells.empty() ? nullptr : row.cells[0].data();
  mesh.n_cells  = row.cells.size();
  for (const double time : {0., 1e-3})
    output.write(time,
                 mesh,
                 {scalar_field("height", "m", row.height)},
                 {scalar_field("stress", "Pa", row.stress)});
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  {
    OutputDirectory directory("meshes", MPI_COMM_WORLD);
    write<2>(directory, rank, n_ranks);
    write<3>(directory, rank, n_ranks);
    directory.write_parameters("set End time = 1 s\n");
  }
  if (rank == 0)
    {
      log_what_vtk_reads("meshes");
      std::ifstream parameters("meshes/parameters.prm");
      std::string   line;
      std::getline(parameters, line);
      deallog << "parameters as used: " << line << std::endl;
    }
}
