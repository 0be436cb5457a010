// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/rows.h>
#include <coracle/meshless/structure_surface.h>

#include <set>

namespace coracle::meshless
{
/**
 * The surfaces of structures and rigid bodies as the fluid meets them. Held nodes are points of the
 * fluid that move with the body: all of them without slip; with it those of edges and corners where
 * the fluid is on all sides, and of sheets. Elsewhere points of the fluid slide on the surface. The
 * fluid's pressure gives impulses to the nodes that carry its points.
 */
template <int dim>
class StructureWalls
{
public:
  using Vector  = dealii::Tensor<1, dim>;
  using Vector3 = dealii::Tensor<1, 3>;

  /// A held node that this rank owns.
  struct Node
  {
    dealii::Point<dim> position;
    Vector             velocity, inverse_mass;
    std::uint64_t      key;
    /// Number of the rigid body or -1.
    int rigid;
    /// Number in `surface`.
    unsigned int number;
  };

  /// A point of the fluid on a surface, by its row there, and the nodes of `surface` that carry it.
  struct Carried
  {
    std::size_t                             row;
    typename StructureSurface<dim>::Simplex nodes;
    std::array<double, dim>                 weights;
  };

  /// Impulse and its moment about the centre, of a rigid body [N s, N m s].
  struct Push
  {
    Vector  impulse;
    Vector3 moment;
  };

  /// By rigid body, and by node of `surface` for points that slide on deformable ones; the same on
  /// all ranks.
  struct Pushes
  {
    std::vector<Push>   rigid;
    std::vector<Vector> node;
  };

  /**
   * Take over what is published now. Collective.
   * @param rigid_of_node by node of the surface, -1: deformable
   */
  void update(const contact::Surface<dim>                   &published,
              const std::vector<int>                        &rigid_of_node,
              const std::vector<contact::RigidUnknown<dim>> &rigid_unknowns,
              const MPI_Comm                                 comm);

  /**
   * From now on, of the nodes on ridges those are held where the fluid is near on all facets that
   * meet there: where it leaves the body a held point would stop it.
   * @param sliding places of this rank's points that slide
   * @param taken   places of its points within `reach`: no node is held beside one
   * @param fixed   by node of `surface`: held whatever comes
   * Collective.
   */
  void hold_wet_ridges(const std::vector<typename StructureSurface<dim>::Place> &sliding,
                       const std::vector<dealii::Point<dim>>                    &taken,
                       const std::vector<unsigned char>                         &fixed,
                       const MPI_Comm                                            comm);

  /// Is a node of `surface` a point of the fluid?
  bool is_held(const unsigned int node) const
  {
    return !slip || (surface.nodes[node].is_sharp && dry.count(surface.nodes[node].key) == 0);
  }

  bool empty() const { return surface.facets.empty(); }

  /// Is the point inside a closed body, by the angle that the facets fill as seen from it?
  bool contains(const dealii::Point<dim> &x) const;
  /// Is a facet of a closed body nearer to the point than this [m]?
  bool is_nearer(const dealii::Point<dim> &x, const double reach) const;
  /// Longest edge of a facet between held nodes [m].
  double longest_edge() const;

  /// The nodes that carry a held node.
  Carried carried(const std::size_t row, const Node &node) const;

  /// Sum over ranks of p a, by row of the fluid, and its moment. Collective.
  Pushes sum_of_pressures(const double               *p,
                          const std::vector<Vector>  &area,
                          const std::vector<Carried> &points,
                          const MPI_Comm              comm) const;
  /// Does the impulse of one point change the velocity of others?
  bool acts_on_others() const { return !rigids.empty() || couples(); }
  /// What they change of the velocity of a point [m/s].
  Vector velocity_of(const Carried &point, const Pushes &pushes) const;
  /// That without pressure [m/s].
  Vector velocity_of(const Carried &point) const;
  /// a . M^-1 a of a point of a deformable body, if its nodes were not those of others [m^../kg].
  double softness(const Carried &point, const Vector &area) const;

  /// Do points slide?
  bool slip = false;
  /// How far points look for surfaces [m].
  double                                  reach = 1;
  StructureSurface<dim>                   surface;
  std::vector<Node>                       nodes;
  std::vector<contact::RigidUnknown<dim>> rigids;

private:
  /// Are there nodes of deformable bodies that carry several points?
  bool couples() const { return slip && deforms; }

  void               list_nodes();
  dealii::Point<dim> place_of(const Carried &point) const;

  bool deforms = false;
  /// Keys of nodes on ridges that are not held.
  std::set<std::uint64_t> dry;
  dealii::Point<dim>      low, high;
};
} // namespace coracle::meshless
