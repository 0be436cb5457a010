// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/numbers.h>

#include <coracle/io/mesh_output.h>

namespace coracle
{
MeshOutput::MeshOutput(OutputDirectory   &directory,
                       const std::string &name,
                       const bool         single_precision)
  : series(directory, directory.claim(name), single_precision)
{}

void
MeshOutput::write(const double              time,
                  const MeshView           &mesh,
                  const std::vector<Field> &node_fields,
                  const std::vector<Field> &cell_fields)
{
  const std::size_t n_vertices = (mesh.shape == CellShape::line            ? 2
                                  : mesh.shape == CellShape::triangle      ? 3
                                  : mesh.shape == CellShape::quadrilateral ? 4
                                  : mesh.shape == CellShape::tetrahedron   ? 4
                                                                           : 8);

  // Number the nodes that are used, in the order in which cells meet them.
  std::vector<unsigned int> used, connectivity(mesh.n_cells * n_vertices), number_of_node;
  for (std::size_t i = 0; i < connectivity.size(); ++i)
    {
      const unsigned int node = mesh.cells[i];
      if (node >= number_of_node.size())
        number_of_node.resize(node + 1, dealii::numbers::invalid_unsigned_int);
      if (number_of_node[node] == dealii::numbers::invalid_unsigned_int)
        {
          number_of_node[node] = used.size();
          used.push_back(node);
        }
      connectivity[i] = number_of_node[node];
    }

  VtuPiece piece;
  piece.shape        = mesh.shape;
  piece.n_points     = used.size();
  piece.points       = &used;
  piece.position     = mesh.position;
  piece.point_fields = node_fields;
  piece.connectivity = std::move(connectivity);
  piece.n_cells      = mesh.n_cells;
  piece.cell_fields  = cell_fields;
  series.write(time, piece);
}
} // namespace coracle
