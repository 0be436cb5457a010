// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <coracle/mesh/column_exchange.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace coracle
{
/// A piece of a body's surface on this rank: a boundary face of an element, or of a sheet.
template <int dim>
struct BoundaryFacet
{
  static constexpr unsigned int n_nodes = (dim == 2 ? 2 : 4);

  /// Local node numbers. 2-D: the body lies to the left of 0 -> 1; 3-D: counter-clockwise from
  /// outside; a triangle repeats its last node. A sheet has an outside only by name.
  std::array<unsigned int, n_nodes> nodes;
  /// Local number of the cell it belongs to.
  unsigned int element;
  unsigned int boundary_id;
  /// Unique over ranks and independent of their number.
  std::uint64_t key;
  /// Number of the sheet it belongs to, see sheet_patches.h; 0 for boundaries of elements.
  unsigned int sheet = 0;
};

/// A node on an edge or face of a larger neighbour: it moves as the mean of its parents.
struct HangingNode
{
  unsigned int                                 node;
  std::vector<std::pair<unsigned int, double>> parents;
};

/**
 * What a body of any kind of mesh shows of it: nodes and surface of this rank
 * with local numbers, owned nodes first, and cells for output. A rank may have
 * none of these.
 */
template <int dim>
class BodyMesh
{
public:
  BodyMesh()                            = default;
  BodyMesh(const BodyMesh &)            = delete;
  BodyMesh &operator=(const BodyMesh &) = delete;
  virtual ~BodyMesh()                   = default;

  unsigned int  n_owned_nodes() const { return exchange.n_owned(); }
  unsigned int  n_nodes() const { return exchange.n_local(); }
  std::uint64_t n_global_nodes() const { return exchange.indices()->size(); }
  /// Global number of a local node, the same for any rank that has it and for any number of ranks.
  std::uint64_t key(const unsigned int node) const
  {
    return exchange.indices()->local_to_global(node);
  }
  int      owner(const unsigned int node) const { return exchange.owner(node); }
  MPI_Comm communicator() const { return exchange.indices()->get_mpi_communicator(); }

  /// Sheets that the surface consists of, met on both faces; 0: it bounds a volume.
  virtual unsigned int  n_sheets() const          = 0;
  virtual std::uint64_t n_global_elements() const = 0;

  /// Elements or facets of this rank with 2^cell_dimension local nodes each, in deal.II's order.
  virtual unsigned int        cell_dimension() const = 0;
  virtual unsigned int        n_cells() const        = 0;
  virtual const unsigned int *cells() const          = 0;

  /// Layout of node columns, and their sums over ranks.
  ColumnExchange exchange;
  /// Reference positions of all local nodes [m].
  std::vector<dealii::Point<dim>> nodes;
  /// Surface of this rank's cells.
  std::vector<BoundaryFacet<dim>> facets;
  /// Of owned elements; none in a mesh without local refinement.
  std::vector<HangingNode> hanging_nodes;
};
} // namespace coracle
