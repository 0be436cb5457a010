// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/aligned_vector.h>

#include <coracle/base/archive.h>
#include <coracle/base/columns.h>
#include <coracle/base/exact_sum.h>
#include <coracle/material/library.h>
#include <coracle/mesh/structure_mesh.h>
#include <coracle/structure/node_columns.h>

#include <array>
#include <vector>

namespace coracle
{
enum class Integration
{
  /// 2^dim Gauss points, volume change averaged over the element (F-bar).
  full,
  /// One point with the element's mean gradient, and Flanagan-Belytschko hourglass control.
  one_point
};

/**
 * The solid elements of one body on this rank, in packs of 8: connectivity,
 * stress and history of their points, in columns; element e is lane e % 8 of
 * pack e / 8. The last pack repeats its last element in the lanes that are left.
 *
 * Rate materials get the gradient of the step's displacement at the middle of
 * the step, hyperelastic ones F; with full integration the volumetric part of
 * either is the element's mean, and forces are the ones that do the same work.
 * Plane strain in 2-D, 1 m deep.
 *
 * Sources: Flanagan & Belytschko, Int. J. Numer. Meth. Engng 17 (1981) 679
 * (mean gradient, hourglass control); Hughes, Int. J. Numer. Meth. Engng 15
 * (1980) 1413 and de Souza Neto et al., Int. J. Solids Struct. 33 (1996) 3277
 * (B-bar, F-bar), here with the mean dilatation of Nagtegaal, Parks & Rice
 * (1974).
 */
template <int dim>
class Elements
{
public:
  static constexpr int n_nodes = 1 << dim;

  /// @param hourglass_coefficient times the shear modulus; 1 is about the stiffness of full
  /// integration [1]
  Elements(const StructureMesh<dim> &mesh,
           const MaterialVariant    &material,
           const Integration         integration,
           const double              hourglass_coefficient);

  /// Rows of the elements (as many as there are), to be carried to another mesh.
  Columns rows() const;
  /**
   * Row of one of the 2^dim parts of an element. Stress and history at its points are those that
   * vary linearly in each direction through the points of the whole, so that constant and linear
   * stresses stay as they are; with one point they are the whole's, and springs against hourglasses
   * have what is left of the whole's modes.
   */
  void child_row(const double *parent, const unsigned int child, double *row) const;
  /// The elements of another mesh, with what has been carried there; update() or hold() follows.
  void reinit(const StructureMesh<dim> &mesh, const Columns &rows);
  /**
   * Internal forces and stable step where nothing has moved since the last step of length dt:
   * stresses that are functions of the motion are computed anew, others stay. Throws as update().
   */
  void hold(Columns &nodes, const double dt);

  /// Forces are rounded from now on so that their sums on the nodes do not depend on the order and
  /// on the ranks; update() is then collective.
  void make_reproducible(MPI_Comm communicator);

  /// Lumped mass [kg] of all elements on their nodes, each share rounded by the grid and added to
  /// the column; no sum over ranks.
  void add_mass(double *nodal_mass, const StructureMesh<dim> &mesh, const SumGrid &grid) const;
  /// Of one element on this rank [kg].
  double largest_mass() const;
  double mass(const unsigned int element) const { return data.columns[Data::mass][element]; }

  /**
   * Stress and internal force at the end of a step from position and
   * increment; replaces the column `internal`, without sums over ranks.
   *
   * Throws RunFailure that names the element and its place where one is turned
   * inside out or a number is not finite.
   *
   * @param dt step [s]
   */
  void update(Columns &nodes, const double dt);

  /// Largest stable step of this rank's elements as of the last update, infinite without any [s].
  double stable_time_step() const { return stable_step; }

  /// @param keys of all elements, see StructureMesh::element_keys
  void serialize(Archive &archive, const std::vector<std::uint64_t> &keys);

  unsigned int size() const { return n_elements; }
  unsigned int n_points() const { return integration == Integration::full ? n_nodes : 1; }

  /// Cauchy stress, mean over the points: xx, yy, zz, xy (, yz, xz) [Pa].
  Symmetric<dim, double> stress(const unsigned int element) const;
  /// Hourglass energy of this rank's elements is added [J].
  void add_hourglass_energy(RankSums &sums, const unsigned int place) const;

  /// What a kernel works on: nodes of each pack, [node][lane], and the columns of its elements.
  struct Data
  {
    std::vector<unsigned int> connectivity;
    unsigned int              n_elements = 0, n_packs = 0;
    /// mass, reference volume, hourglass energy, hourglass forces, then stress and history of each
    /// point.
    Columns      columns;
    unsigned int n_history         = 0;
    double       hourglass_modulus = 0;
    /// Forces of the elements on their nodes, [pack][direction][node][lane], if they are wanted
    /// apart instead of summed [N].
    bool                 apart = false;
    std::vector<double>  forces;
    static constexpr int mass = 0, volume = 1, energy = 2, hourglass = 3;
    static constexpr int first_stress = 3 + dim * (dim == 2 ? 1 : 4);

    unsigned int node(const unsigned int element, const unsigned int n) const
    {
      return connectivity[(element / pack_size * n_nodes + n) * pack_size + element % pack_size];
    }
    unsigned int stress(const unsigned int point) const
    {
      return first_stress + point * (Symmetric<dim, double>::size + n_history);
    }
  };

private:
  void allocate(const StructureMesh<dim> &mesh);
  template <typename Material>
  void              update_with(const Material &material, Columns &nodes, const double dt);
  void              compute_reference(const StructureMesh<dim> &mesh);
  void              add_rounded_forces(Columns &nodes) const;
  [[noreturn]] void report_failure(const Columns &nodes) const;

  const MaterialVariant material;
  const Integration     integration;
  unsigned int          n_elements = 0;
  Data                  data;
  double                stable_step;
  MPI_Comm              communicator = MPI_COMM_NULL;
};

extern template class Elements<2>;
extern template class Elements<3>;
} // namespace coracle
