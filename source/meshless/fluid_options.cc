// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/meshless/fluid_options.h>

namespace coracle::meshless
{
namespace
{
double
or_else(const double given, const double otherwise)
{
  return given > 0 ? given : otherwise;
}

void
declare_refill(Declaration &body)
{
  body.flag(
    "Refill",
    true,
    "Points that come too near to others are taken out, and long edges between points get a "
    "new one in their middle. The outline of the fluid stays, so that no volume is made or "
    "lost; off: the points of the start are all there are, and gaps open where the fluid is "
    "stretched.");
  body.quantity("Nearest points",
                "0.45",
                "1",
                "",
                "Refill: of two points nearer than this share of the spacing one is taken out.",
                0.,
                1.);
  body.quantity(
    "Nearest to wall",
    "0.3",
    "1",
    "",
    "Refill: a point inside the fluid nearer than this share of the spacing to a face of "
    "the box, and not on it, is taken out.",
    0.,
    1.);
  body.quantity("Longest boundary edge",
                "1.5",
                "1",
                "",
                "Refill: an edge on the boundary that is longer, over the spacing, gets a point.",
                1.);
  body.quantity(
    "Longest edge",
    "1.7",
    "1",
    "",
    "Refill: an edge inside that is longer, over the spacing, gets a point. In space at "
    "least 1.8, the diagonal of a cube, is taken.",
    1.);
}

void
declare_solver(Declaration &body)
{
  body.quantity(
    "Time weight",
    "1",
    "1",
    "theta",
    "Share of the new velocity in the one that moves points: 1 damps, of first order in "
    "the step; 0.5 is of second order and damps nothing.",
    0.5,
    1.);
  body.integer("Iterations",
               2,
               "Solutions of a step, each on elements moved halfway along the motion that the one "
               "before gave.",
               1,
               20);
  body.quantity(
    "Largest move",
    "0.25",
    "1",
    "C",
    "Share of the spacing that a point may move in a step, by its velocity and by falling "
    "freely; bounds the step.",
    1e-6,
    1.);
  body.quantity(
    "Volume relaxation",
    "0",
    "s",
    "",
    "Time in which what appeared or disappeared as surfaces joined or tore is taken back, by "
    "shrinking or swelling everywhere; 0: never.",
    0.);
  body.quantity(
    "Pressure tolerance",
    "1e-9",
    "1",
    "",
    "Residual of the pressure equation over its right side, at which its solution ends.",
    1e-16,
    0.1);
  body.integer("Pressure iterations", 500, "Of conjugate gradients, at most.", 1);
  body.integer("Direct solver up to",
               500,
               "Up to so many points the pressure comes from a factorisation.",
               0);
}
} // namespace

template <int dim>
void
FluidOptions<dim>::declare(Declaration &body)
{
  body.quantity(
    "Spacing",
    "10 mm",
    "m",
    "h",
    "Distance between points at the start, adjusted in each direction so that it divides "
    "the box around the shape evenly, with points on its faces; and what distances are "
    "kept up.",
    1e-300);
  body.quantity(
    "Density", "1000", "kg/m^3", "rho", "Of the fluid, which is incompressible.", 1e-300);
  body.quantity("Viscosity", "0", "Pa s", "mu", "Dynamic; 0: none.", 0.);
  body.quantity(
    "Alpha",
    "0",
    "1",
    "alpha",
    "Elements are kept whose empty sphere's radius over the mean spacing of their points "
    "is at most this; the boundary of the fluid follows. A square of points has 0.71, a "
    "cube 0.87. 0: 1.3 in the plane, 1.5 in space.",
    0.,
    10.);
  body.quantity("Surface alpha",
                "0",
                "1",
                "",
                "As Alpha, for elements whose points were all at the free surface or drops in the "
                "step before, between the two where some were: how near surfaces come before they "
                "join. 0: 0.85 in the plane, 1.05 in space.",
                0.,
                10.);
  body.quantity(
    "Merge tolerance",
    "0",
    "1",
    "",
    "Share of the spacing within which centres of empty spheres count as one, so that the "
    "simplices of one sphere are one element, and below which the height of a simplex is "
    "none. 0: 1e-6 in the plane; 1e-3 in space, where flatter ones would spoil the pressure's "
    "system.",
    0.,
    0.1);
  body.choice(
    "Structures",
    "auto",
    {"auto", "slip", "stick"},
    "What the surfaces of structures do to the fluid. slip: it moves along them freely, and "
    "their facets may be larger than the spacing; stick: it moves as they do, and facets "
    "must be about as large as the spacing; auto: slip where Viscosity is 0 and there are no "
    "Regions. Sheets always stick, and so do edges and corners of bodies that are wet on all "
    "sides.");
  declare_refill(body);
  declare_solver(body);
}

template <int dim>
FluidOptions<dim>
FluidOptions<dim>::read(const Parameters &body, const dealii::Tensor<1, dim> &gravity)
{
  FluidOptions o;
  o.density            = body.quantity("Density");
  o.viscosity          = body.quantity("Viscosity");
  o.spacing            = body.quantity("Spacing");
  o.tessellation.alpha = or_else(body.quantity("Alpha"), dim == 2 ? 1.3 : 1.5);
  o.surface_alpha =
    std::min(o.tessellation.alpha, or_else(body.quantity("Surface alpha"), dim == 2 ? 0.85 : 1.05));
  o.tessellation.merge_tolerance =
    or_else(body.quantity("Merge tolerance"), dim == 2 ? 1e-6 : 1e-3);
  o.refill.enabled               = body.flag("Refill");
  o.refill.nearest               = body.quantity("Nearest points");
  o.refill.nearest_to_wall       = body.quantity("Nearest to wall");
  o.refill.longest_boundary_edge = body.quantity("Longest boundary edge");
  o.refill.longest_edge          = std::max(body.quantity("Longest edge"), dim == 3 ? 1.8 : 1.);
  o.solver.tolerance             = body.quantity("Pressure tolerance");
  o.solver.largest_iterations    = body.integer("Pressure iterations");
  o.solver.direct_up_to          = body.integer("Direct solver up to");
  o.time_weight                  = body.quantity("Time weight");
  o.n_iterations                 = body.integer("Iterations");
  o.largest_move                 = body.quantity("Largest move");
  o.volume_relaxation            = body.quantity("Volume relaxation");
  o.gravity                      = gravity;
  const std::string structures   = body.choice("Structures");
  o.slips_on_structures = structures == "slip" || (structures == "auto" && o.viscosity == 0);
  if (o.slips_on_structures && o.viscosity > 0)
    throw body.error("Structures",
                     "a viscous fluid does not slip on structures",
                     "Viscosity = " + std::to_string(o.viscosity) + " Pa s",
                     "set Structures to stick, or Viscosity to 0");
  if (o.tessellation.alpha < (dim == 2 ? 0.72 : 0.88))
    throw body.error("Alpha",
                     "no element can be kept",
                     "Alpha = " + std::to_string(o.tessellation.alpha) +
                       ", but the empty sphere of " +
                       (dim == 2 ? "a square of points has 0.71" : "a cube of points has 0.87") +
                       " spacings",
                     "give 1.2 to 1.5");
  return o;
}

template struct FluidOptions<2>;
template struct FluidOptions<3>;
} // namespace coracle::meshless
