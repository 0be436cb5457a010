// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/base/columns.h>
#include <coracle/base/exact_sum.h>
#include <coracle/particles/cut_points.h>
#include <coracle/particles/layout.h>
#include <coracle/particles/leaf_means.h>

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>

#include <cstdint>
#include <string>
#include <vector>

namespace coracle
{
/// created + split = present + removed + converted + merged, on all ranks together, after every
/// step.
struct ParticleLedger
{
  std::uint64_t created = 0, removed = 0, converted = 0;
  /// Particles more by splitting, and fewer by merging.
  std::uint64_t split = 0, merged = 0;

  std::int64_t expected() const
  {
    return std::int64_t(created + split) - std::int64_t(removed + converted + merged);
  }
};

/**
 * The particles of one material point body on this rank: columns, sorted by
 * the leaf of the octree ("cell" here, a plain number) they were in at the
 * last sort.
 *
 * Between sorts, rows stay where they are. A particle that left its home cell
 * is a *stray* and takes a slow path in the kernels; one that left the rank
 * leaves a *hole* (mass 0), which the kernels add without effect; one that
 * arrived is appended behind the sorted rows and is a stray as well. Sorting
 * every ten steps or so is enough. Rows that a sheet cuts off from some of
 * their grid nodes take a slow path too.
 */
template <int dim>
class MaterialPoints
{
public:
  using Layout = ParticleLayout<dim>;

  struct Stray
  {
    unsigned int row;
    /// Where it is now.
    int leaf;
  };

  MaterialPoints(const std::string &name, const ParticleNeeds &needs);

  const std::string &name() const { return body_name; }
  const Layout      &layout() const { return columns_layout; }

  /// Rows, holes included.
  std::size_t n_rows() const { return columns.size(); }
  /// Particles on this rank.
  std::size_t n_particles() const { return columns.size() - n_holes; }
  bool        is_hole(const std::size_t row) const { return columns[Layout::mass][row] == 0; }

  double       *column(const int c) { return columns[c]; }
  const double *column(const int c) const { return columns[c]; }
  Columns       columns;

  dealii::Point<dim> position(const std::size_t row) const;
  std::uint64_t      id(const std::size_t row) const { return columns[Layout::id][row]; }

  /// First row of each cell, and one more entry for the end of the sorted rows.
  const std::vector<unsigned int> &cell_begin() const { return begins; }
  /// Cells that have rows, in order: the hot loops run over these.
  const std::vector<unsigned int> &occupied_cells() const { return occupied; }

  std::vector<Stray> strays;

  /// In this step; they are left out of what is done with sorted rows and strays.
  CutPoints<dim> cuts;

  /// Rows that touch a surface, ascending, some of which may have become holes; of no use once rows
  /// are renumbered.
  std::vector<unsigned int> touched;
  /// Looks for them anew.
  void                            find_touched();
  dealii::SymmetricTensor<2, dim> touch(const std::size_t row) const;
  void set_touch(const std::size_t row, const dealii::SymmetricTensor<2, dim> &touch);

  /// Counting sort; drops holes and strays. `cell[row]` is the home of each row (any value for a
  /// hole).
  void sort(const unsigned int n_cells, const std::vector<int> &cell);

  /// Append one row, as migration and generation do.
  void append(const double *row);
  /// The row becomes a hole.
  void remove(const std::size_t row);

  /// No rows are left.
  void clear();

  /// Since the set-up, on this rank.
  ParticleLedger ledger;

  /// Results are not to depend on the ranks, bit by bit: particles of a cell are sorted by their
  /// ids.
  bool reproducible = false;

  /// Working space of the sweeps over cells.
  LeafMeans means;

  /// All state. On other ranks than have saved it, rows come as they are and belong to no cell yet.
  void serialize(Archive &archive);

  double      kinetic_energy() const;
  ExactSum    exact_kinetic_energy() const;
  double      mass() const;
  std::size_t memory_consumption() const
  {
    return columns.memory_consumption() + cuts.memory_consumption();
  }

private:
  std::string               body_name;
  Layout                    columns_layout;
  std::size_t               n_holes = 0;
  std::vector<unsigned int> begins, occupied, source;
};
} // namespace coracle
