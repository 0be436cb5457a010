// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/options.h>

namespace coracle::contact
{
namespace
{
Search
read_search(const std::string &name)
{
  return name == "bucket"      ? Search::bucket
         : name == "all pairs" ? Search::all_pairs
                               : Search::aabb_tree;
}

Law
read_law(const std::string &name)
{
  if (name == "stick/slip")
    return Law::stick_slip;
  return name == "blended" ? Law::blended : Law::split;
}

LocalMethod
read_local_search(const std::string &name)
{
  return name == "nearest per facet"    ? LocalMethod::nearest_per_facet
         : name == "perpendicular foot" ? LocalMethod::perpendicular_foot
                                        : LocalMethod::nearest_on_surface;
}

/// Where particles, structures and velocity fields meet.
void
declare_methods(Declaration &section)
{
  section.choice("Method",
                 "surface",
                 {"surface", "grid"},
                 "Where particles and structures meet. surface: particles and facets, nothing "
                 "passes; grid: on the nodes of the background grid (Chen et al. 2015, section "
                 "2.4), for comparison: particles pass where elements are larger than cells, and "
                 "structures do not meet each other");
  section.choice("Between fields",
                 "none",
                 {"none", "grid"},
                 "Whether material point bodies of different velocity fields meet. none: they do "
                 "not feel each other; grid: on the nodes of the background grid, with slip");
  section.when("Between fields", "grid")
    .quantity("Friction between fields",
              "0",
              "1",
              "mu",
              "Coulomb coefficient between material point bodies of different velocity fields",
              0);
}

/// What contacts ask for.
void
declare_laws(Declaration &section)
{
  section.quantity(
    "Friction", "0", "1", "mu", "Coulomb coefficient of surfaces that do not give their own", 0);
  section.choice(
    "Law",
    "split",
    {"split", "blended", "stick/slip"},
    "What contacts ask for. split: no approach beyond contact within the step, depth removed by "
    "moving positions only; blended: velocity and depth in one force, repeated (Song, Liu & Zhang "
    "2020, Eq. 65); stick/slip: each contact as if alone, once (Chen et al. 2015, Eqs. 48-52). The "
    "last two are there for comparison");
  section.when("Law", "blended")
    .quantity(
      "Blend", "0.3", "1", "alpha", "Share of the depth that is turned into velocity", 0, 1);
  section.when("Law", "split")
    .flag("Position correction",
          true,
          "Remove remaining depth by moving positions, never velocities");
  section.when("Law", "split")
    .integer(
      "Maximum position iterations",
      50,
      "Sweeps there and back of the position correction after which it goes on in the next step",
      1);
  section.when("Law", "split")
    .flag("Continuous check",
          true,
          "Follow particles and nodes of structures through the step and change the ends of paths "
          "that would come too near to a surface, or through it");
}
} // namespace

void
ContactOptions::declare(Declaration &section)
{
  declare_methods(section);
  declare_laws(section);
  section.flag("Structure contact",
               true,
               "Structures meet each other, and themselves where Self contact says so; false: they "
               "pass through each other");
  section.quantity("Tolerance",
                   "1e-4",
                   "1",
                   "",
                   "Residual of the contact conditions at which the solver stops, relative to the "
                   "greatest approach speed",
                   0,
                   1);
  section.integer(
    "Maximum iterations",
    1000,
    "Sweeps there and back of the contact solver after which a step counts as not converged",
    1);
  section.flag("Accelerate", true, "Momentum in the iterations of the contact solver");
  section.quantity("Skin",
                   "1",
                   "1",
                   "",
                   "How much farther than needed candidates are looked for, in contact distances; "
                   "more means rarer but longer searches. Down to half of it is taken where "
                   "particles are renumbered before more would be used up",
                   0.01);
  section.choice(
    "Search",
    "aabb tree",
    {"aabb tree", "bucket", "all pairs"},
    "How candidates are looked for, all with the same result. aabb tree: a tree of "
    "boxes around the facets (CGAL); bucket: points sorted into equal buckets of about "
    "a facet's size (Chen et al. 2015, section 3.1); all pairs: every point with every "
    "facet");
  section.choice(
    "Initial overlap",
    "refuse",
    {"refuse", "project"},
    "Particles that start in a body or nearer to a surface than the contact distance. "
    "refuse: an error that names them; project: they are moved out, without a change of "
    "velocity, density or stress");
  section.choice("Local search",
                 "nearest on surface",
                 {"nearest on surface", "nearest per facet", "perpendicular foot"},
                 "Which pairs of point and facet are contacts. nearest on surface: local minima of "
                 "the distance to the whole surface; for comparison, nearest per facet: every "
                 "facet's nearest point (Song, Liu & Zhang 2020), and perpendicular foot: every "
                 "facet that the foot of the perpendicular lies in (Chen et al. 2015), which "
                 "leaves cracks at convex edges");
}

ContactOptions::ContactOptions(const Parameters &section, const bool reproducible)
  : reproducible(reproducible)
{
  friction       = section.quantity("Friction");
  method         = (section.choice("Method") == "grid" ? Method::grid : Method::surface);
  between_fields = (section.choice("Between fields") == "grid");
  if (between_fields)
    friction_between_fields = section.quantity("Friction between fields");
  search             = read_search(section.choice("Search"));
  local_search       = read_local_search(section.choice("Local search"));
  law                = read_law(section.choice("Law"));
  tolerance          = section.quantity("Tolerance");
  maximum_iterations = section.integer("Maximum iterations");
  accelerate         = section.flag("Accelerate");
  skin               = section.quantity("Skin");
  if (section.choice("Initial overlap") == "project")
    initial_overlap = InitialOverlap::project;
  structure_contact = section.flag("Structure contact");
  if (law == Law::blended)
    alpha = section.quantity("Blend");
  if (law == Law::split)
    {
      position_correction = section.flag("Position correction");
      continuous_check    = section.flag("Continuous check");
      position_iterations = section.integer("Maximum position iterations");
    }
}
} // namespace coracle::contact
