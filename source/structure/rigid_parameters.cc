// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/mesh/mesh_generation.h>
#include <coracle/structure/rigid_body.h>
#include <coracle/structure/selection.h>

#include <algorithm>

namespace coracle
{
template <int dim>
void
RigidBody<dim>::declare(Declaration &section)
{
  declare_mesh(section.section("Mesh", "Shape of the body: elements, or a sheet without volume"),
               true);
  RigidBody::declare_surface(section);
  section.quantity("Mass",
                   "0",
                   "kg",
                   "M",
                   "of the body, of one metre of depth in 2-D; spread evenly over the mesh. Give "
                   "this or Density",
                   0.);
  section.quantity("Density",
                   "0",
                   "kg/m^3",
                   "rho",
                   "of the body, or of a sheet with its Thickness; give this or Mass",
                   0.);
  section.text("Free directions",
               "",
               "in which the body moves by its inertia: some of x, y, z, rx, ry, rz (in 2-D x, y, "
               "rz), or all, or none; empty is all for Motion = none and otherwise none");
  section.list("Initial spin", "", "1/s", "omega_0", "about x, y, z; in 2-D one number");
  section.choice("Motion",
                 "none",
                 {"none", "velocity", "displacement"},
                 "how the directions that are not free move: not at all, or as a function of time");
  section.when("Motion", "velocity")
    .function("Velocity", "0", "m/s", "components of the centre's velocity in t");
  section.when("Motion", "displacement")
    .function("Displacement", "0", "m", "components of the centre's displacement in t");
  for (const char *motion : {"velocity", "displacement"})
    section.when("Motion", motion)
      .function("Spin", "0", "1/s", "about x, y, z in t; in 2-D one component");
}

template <int dim>
void
RigidBody<dim>::read_motion(const Parameters &body)
{
  const std::vector<std::string> directions =
    dim == 2 ? std::vector<std::string>{"x", "y", "rz"}
             : std::vector<std::string>{"x", "y", "z", "rx", "ry", "rz"};
  std::vector<std::string> allowed = directions;
  allowed.insert(allowed.end(), {"all", "none"});
  auto              words  = read_words(body, "Free directions", allowed);
  const std::string motion = body.choice("Motion");
  if (words.empty())
    words = {motion == "none" ? "all" : "none"};
  if (words.size() > 1 && words.count("all") + words.count("none") > 0)
    throw body.error("Free directions",
                     "contradicting words",
                     body.text("Free directions"),
                     "give `all` or `none` alone, or some of the directions");

  const auto is_free = [&](const std::string &word) {
    return words.count("all") > 0 || words.count(word) > 0;
  };
  std::array<bool, 3> free_axes{};
  unsigned int        n_free = 0;
  for (int d = 0; d < dim; ++d)
    inverse_mass_of_body[d] = is_free(directions[d]) ? 1. / body_mass : 0.;
  for (int d = (dim == 2 ? 2 : 0); d < 3; ++d)
    free_axes[d] = is_free(directions[dim == 2 ? 2 : 3 + d]);
  for (const std::string &direction : directions)
    n_free += is_free(direction);
  if (motion != "none" && n_free == directions.size())
    throw body.error("Free directions",
                     "motion of a body that is free in all directions",
                     "Motion = " + motion,
                     "leave out the directions that the function shall move");
  rotation = RigidRotation(inertia, free_axes);

  if (motion == "velocity" && body.is_set("Velocity"))
    velocity_function = body.template function<dim>("Velocity", dim);
  if (motion == "displacement" && body.is_set("Displacement"))
    displacement_function = body.template function<dim>("Displacement", dim);
  if (motion != "none" && body.is_set("Spin"))
    spin_function = body.template function<dim>("Spin", dim == 2 ? 1 : 3);
}

template <int dim>
void
RigidBody<dim>::read_initial_motion(const Parameters &body)
{
  const std::vector<double> entries = body.list("Initial spin");
  constexpr std::size_t     n       = (dim == 2 ? 1 : 3);
  if (!entries.empty() && entries.size() != n)
    throw body.error("Initial spin",
                     "wrong number of components",
                     std::to_string(entries.size()) + " of them",
                     "give " + std::to_string(n));
  Vector3 spin;
  std::copy(entries.begin(), entries.end(), spin.begin_raw() + (dim == 2 ? 2 : 0));
  rotation.set_spin(spin);
  body_velocity = body.template point<dim>("Initial velocity");
  for (int d = 0; d < dim; ++d)
    if (inverse_mass_of_body[d] == 0)
      body_velocity[d] = 0;
}

template void RigidBody<2>::declare(Declaration &);
template void RigidBody<3>::declare(Declaration &);
template void RigidBody<2>::read_motion(const Parameters &);
template void RigidBody<3>::read_motion(const Parameters &);
template void RigidBody<2>::read_initial_motion(const Parameters &);
template void RigidBody<3>::read_initial_motion(const Parameters &);
} // namespace coracle
