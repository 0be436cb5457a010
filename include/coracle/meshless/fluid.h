// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
#include <coracle/base/columns.h>
#include <coracle/base/timer.h>
#include <coracle/meshless/fluid_operators.h>
#include <coracle/meshless/fluid_options.h>
#include <coracle/meshless/structure_walls.h>
#include <coracle/meshless/viscous_system.h>
#include <coracle/meshless/volume_change.h>

#include <map>
#include <optional>

namespace coracle::meshless
{
/// Columns of a point's state between steps; all doubles, so that rows migrate and restart as they
/// are. Ids are whole numbers below 2^53; walls are a sum of 2^face over the faces it slides on;
/// free is 1 at the free surface and in drops, was_free what it was when the elements were found;
/// sliding is 1 on the surface of a structure; region is that of FluidOptions, and stays.
template <int dim>
struct FluidLayout
{
  static constexpr int position = 0, velocity = dim, pressure = 2 * dim, spacing = 2 * dim + 1,
                       id = 2 * dim + 2, walls = 2 * dim + 3, free = 2 * dim + 4,
                       sliding = 2 * dim + 5, region = 2 * dim + 6, was_free = 2 * dim + 7,
                       n_columns = 2 * dim + 8;
};

/**
 * The meshless finite element fluid: points that move with it, and elements
 * between them that are found anew in every step. Incompressible; the pressure
 * is 0 at the free surface.
 *
 * Points that start on a face of the box, or reach it, slide on it from then on
 * (slip) or stay where they are (stick), so that the fluid's elements end in the
 * wall without a gap. A point without elements is a drop in free flight. Where the
 * box is periodic, images of points beyond one face are copies as those of other
 * ranks' points are; points are moved back into the box before new elements.
 *
 * A step splits the momentum equation (Eqs. 27, 29, 31; the mass matrix missing
 * in 31 is put back). With U^0 the old velocity, theta the time weight, and all
 * integrals over the elements halfway along the step,
 *
 *   (M + theta dt nu K) (U' - U^0) = dt (M (f - r) - nu K U^0),    U* = U' + dt r
 *   (theta dt / rho) S P = B (theta U* + (1 - theta) U^0)
 *   M U^1 = M U* - (dt / rho) B^T P
 *   X^1 = X^0 + dt (theta U^1 + (1 - theta) U^0).
 *
 * with r = M^-1 B^T P / rho of the pressure known so far (of the step before, then of
 * the iteration before). U* is left free at walls, so that a linear pressure is exact; the walls'
 * condition is that of the pressure equation, and is set in U^1. Elements move
 * by a velocity without divergence on the halfway elements, which keeps areas
 * exactly in the plane, and volumes to third order of the step in space.
 *
 * Regions of it are other fluids, of their own density and viscosity: M, S and K have those of the
 * elements, and K is that of the symmetric gradient (doc/theory.md).
 *
 * Source: Del Pin, Idelsohn, Onate & Calvo (2003); Codina (2001), J. Comput.
 * Phys. 170: the difference of S and B M^-1 B^T keeps the pressure stable.
 */
template <int dim>
class Fluid
{
public:
  using Vector = dealii::Tensor<1, dim>;
  using Layout = FluidLayout<dim>;

  Fluid(const std::string &name, const FluidOptions<dim> &options, const MPI_Comm comm);

  /// One more point of this rank, before the first step. Its row is the last one.
  void add_point(const dealii::Point<dim> &position,
                 const Vector             &velocity,
                 const std::uint64_t       id,
                 const unsigned int        region = 0);

  /**
   * Points go to their ranks, elements are found. After points were added, loaded or moved.
   * @param may_balance false: points stay on their ranks and in their order, as they were saved
   * Collective.
   */
  void remesh(const bool may_balance = true);

  /// Bound on the step from what points may move, on all ranks [s].
  double step_limit() const;
  /// Which point asks for it. Collective.
  std::string describe_limit() const;

  /// One step, without new elements: those come with remesh(). Velocities of structures are those
  /// of the middles of steps; `push_duration` is the time from one middle to the next, in which
  /// pressure acts on them [s]; 0: dt. Collective.
  void
  advance(const double time, const double dt, TimingTable &timed, const double push_duration = 0);
  /// Points that left, or are too near to others, go; gaps get new ones. Before remesh().
  /// Collective.
  void refill();

  /// Surfaces that the fluid meets, as they are now: before advance() with the velocities that
  /// their bodies would have without the fluid, before refill() and remesh() as they have moved.
  StructureWalls<dim> structures;
  /// Impulses of the step on rigid bodies, the same on all ranks, and by node of
  /// `structures.surface`, on those that this rank owns.
  std::vector<typename StructureWalls<dim>::Push> rigid_impulses;
  std::vector<Vector>                             node_impulses;
  /// Points that start in a structure, or nearer to a facet of one than half a spacing, go.
  /// Collective.
  void clear_structures();

  /// Points of the fluid on this rank; those of structures follow.
  std::size_t n_fluid() const { return columns.size(); }

  /// Between steps; remesh() is called when loaded. Collective.
  void serialize(Archive &archive);

  const std::string &name() const { return body_name; }

  /// The first thing that went wrong on this rank.
  std::optional<RunFailure> failure;

  /// What this rank's points did to energy so far [J]; kinetic is the present value. `internal` is
  /// the loss to the pressure's stabilisation, `transfer` that to new elements and time weight.
  struct Books
  {
    double kinetic = 0, internal = 0, damping = 0, transfer = 0, boundary = 0, external_work = 0;
  };
  const Books &books() const { return energy; }

  /// Over all ranks.
  struct Summary
  {
    std::uint64_t      n_points = 0, n_elements = 0, n_free = 0, n_isolated = 0;
    double             volume = 0; ///< [m^dim]
    double             mass   = 0; ///< [kg], in the plane per metre
    dealii::Point<dim> centre;     ///< of mass
    Vector             velocity;   ///< of the centre
  };
  /// Collective.
  Summary summary() const;
  /// Of the elements of each region: volume, mass, centre and velocity. Collective.
  std::vector<Summary> region_summaries() const;

  /// Since the start, on all ranks.
  struct Counts
  {
    std::uint64_t created = 0, inserted = 0, taken_out = 0, left = 0;
  };

  /// Volume at the start, and what appeared and disappeared with new elements so far [m^dim].
  double      initial_volume = 0, volume_appeared = 0, volume_disappeared = 0;
  Counts      counts;
  SolveReport last_pressure_solve, last_viscous_solve;
  /// Over all solves so far.
  std::uint64_t pressure_solves = 0, pressure_iterations = 0, unconverged_solves = 0;
  /// Of those where regions make viscosity vary.
  std::uint64_t unconverged_viscous_solves = 0;

  // The state between steps: own points, then for all but columns their copies.
  Columns                    columns;
  PointCloud<dim>            points;
  Halo                       halo;
  Tessellation<dim>          mesh;
  std::vector<Vector>        velocity;
  std::vector<double>        pressure;
  std::vector<unsigned char> walls, free_surface, isolated;
  /// By point; nodes of structures have none, which is any.
  std::vector<unsigned char> region;
  /// By element: that of all its points, or 0. Empty if there are no regions.
  std::vector<unsigned char> element_region;
  /// Lumped, of own points, and mass over the fluid's density [m^dim].
  std::vector<double> volume, mass;
  /// Acceleration besides gravity, or none.
  std::shared_ptr<dealii::Function<dim>> body_force;
  const FluidOptions<dim>                options;
  const Period<dim>                      period;

private:
  void         wrap();
  void         fill_cloud();
  void         find_free_surface();
  unsigned int held_walls(const std::size_t row) const;
  void         set_wall_velocity(const std::size_t row, Vector &v) const;
  void         move_elements(const double dt, const unsigned int iteration, TimingTable &timed);
  void         predict(const double time, const double dt);
  void         diffuse(const double dt, const std::vector<Vector> &acceleration);
  void         diffuse_regions(const double dt, const std::vector<Vector> &acceleration);
  void         stiffen(const double dt);
  /// Whether component d of a point's velocity is given by a wall, a structure or free flight.
  bool          is_held(const std::size_t row, const unsigned int d) const;
  void          find_element_regions();
  void          find_masses(const ElementRules<dim>   &of,
                            const std::vector<double> &volumes,
                            std::vector<double>       &masses) const;
  unsigned char region_between(const unsigned int i, const unsigned int j) const;
  Vector        facet_area(const typename Tessellation<dim>::Facet &facet) const;
  void          find_surface_areas();
  void          fit_surface_areas();
  void          add_surface_terms(double *result, const double *p);
  void          solve_pressure(const double dt, const unsigned int iteration, TimingTable &timed);
  void          correct(const double dt);
  void          move(const double dt);
  void          balance();
  void          find_moved_boundary();
  void          find_volume();
  void          book_step(const double dt);
  void          check_numbers();
  void          new_positions(std::vector<dealii::Point<dim>> &x) const;
  void          hold_wet_ridges();
  void          add_structure_points();
  void          carry_points();
  unsigned char faces_at(const dealii::Point<dim> &x) const;
  bool is_structure(const std::size_t row) const { return points.kind[row] == PointKind::wall; }
  /// A point of the fluid on the surface of a structure.
  bool is_sliding(const std::size_t row) const { return points.kind[row] == PointKind::sliding; }
  bool is_on_structure(const std::size_t row) const { return is_structure(row) || is_sliding(row); }
  bool stays_on_structure(const std::size_t row, const Vector &normal) const;
  void slide(const typename StructureWalls<dim>::Pushes &pushes);
  bool has_left(const Vector &normal, const typename StructureSurface<dim>::Place &place) const;
  void stay_on_structures();
  void put_on_structure(const std::size_t row, const typename StructureSurface<dim>::Place &place);
  void find_slid_together(std::vector<unsigned char> &taken_out);
  bool is_along_structure(const unsigned int                     i,
                          const unsigned int                     j,
                          const std::vector<dealii::Point<dim>> &x) const;
  void find_near_structures(const std::vector<dealii::Point<dim>> &x,
                            std::vector<double>                   &marks) const;
  void find_wall_areas();
  void move_structures();
  void add_structures(double *result, const double *p) const;
  void find_inside(const std::vector<dealii::Point<dim>> &x, std::vector<unsigned char> &taken_out);
  void find_flattened(const std::vector<dealii::Point<dim>> &x, std::vector<double> &marks) const;
  void find_encroaching(const std::vector<dealii::Point<dim>> &x, std::vector<double> &marks) const;
  /// A point that is about to be put in.
  struct NewPoint
  {
    dealii::Point<dim> position;
    unsigned char      region = 0;
  };
  /// By point, the same on all ranks as these are: whether it would end an element of a region.
  std::vector<unsigned char> find_intruders(const std::vector<NewPoint>           &new_points,
                                            const std::vector<dealii::Point<dim>> &x) const;
  void                       find_strays(std::vector<unsigned char> &taken_out);
  void                       find_corner_twins(std::vector<unsigned char> &taken_out);
  void                       find_crowded(const std::vector<dealii::Point<dim>> &x,
                                          std::vector<unsigned char>            &taken_out);
  /// An edge of an element that is too long, by its key.
  struct LongEdge;
  using LongEdges = std::map<std::array<double, 4>, LongEdge>;
  LongEdges find_long_edges(const std::vector<dealii::Point<dim>> &x) const;
  void      insert(const std::vector<dealii::Point<dim>> &x);
  void      insert_between(const std::array<unsigned int, 2>     &rows,
                           const std::vector<dealii::Point<dim>> &x,
                           const std::uint64_t                    id);

  static constexpr unsigned int steps_between_balances = 50;

  std::string       body_name;
  MPI_Comm          comm;
  ElementRules<dim> rules, moved_rules;
  ScalarSystem<dim> pressure_system;
  /// Where regions make viscosity vary.
  ViscousSystem<dim> viscous_system;
  /// With regions, of own points: the pressure's force that the viscous solution knew over dt [N],
  /// and what of the velocity after the pressure it changes.
  std::vector<Vector>        known_force, stiffened;
  std::vector<unsigned char> held_directions;
  /// By element, empty without regions: density over the fluid's and its inverse, viscosity [Pa s],
  /// and whether it is outside of regions.
  std::vector<double> relative_density, relative_lightness, viscosity, outside_regions;
  /// Of the step: U*, U^1 and the velocity that moves, on own points and copies.
  std::vector<Vector> predicted, corrected, moving, gradient, scratch;
  std::vector<double> moved_volume, moved_mass, swelling_volume, right_side;
  /// Where the pressure is not solved for: drops, or one point of a fluid without a surface.
  std::vector<unsigned char> no_pressure;
  /// Points beside a facet of the free surface, those of structures too.
  std::vector<unsigned char> at_surface;
  /// Facets of the free surface, and elements with a point of it, here.
  std::vector<typename Tessellation<dim>::Facet> surface_facets, wall_facets;
  std::vector<unsigned int>                      surface_elements;
  /// What flows through this rank's triangles of the surface more than through its faces [m^3/s].
  double fitting_flow = 0;
  /// a_i of own points and copies [m^(dim-1)].
  std::vector<Vector> surface_area, pushed;
  std::vector<double> surface_pressure, driven;
  /// The same of points on structures, facets on these; of structure nodes all; by own row.
  std::vector<Vector> wall_area;
  /// Own points on structures, and the unit normals there; of structure nodes none.
  std::vector<typename StructureWalls<dim>::Carried> carried;
  std::vector<Vector>                                carried_normal;
  std::size_t                                        n_cloud = 0;
  double                                             last_dt = 0, push_time = 0;
  Books                                              energy;
  std::uint64_t                                      next_id        = 0;
  double                                             current_volume = 0;
  /// Of the old elements at the end of the step.
  std::optional<std::vector<BoundaryFacet<dim>>> moved_boundary;
  /// Steps since points were shared out among ranks; so many of them, or an uneven share, ask for
  /// it.
  unsigned int steps_since_balance = steps_between_balances;
};
} // namespace coracle::meshless
