// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/structure/rigid_body.h>
#include <coracle/structure/solid_body.h>

#include "tests.h"

/// What a case declares, cut down to materials and bodies.
struct BodyCase
{
  explicit BodyCase(const std::string &text, const int dim) : file(declare(dim))
  {
    file.read_text(text);
    root = std::make_unique<coracle::Parameters>(file.parameters());
  }

  template <int dim>
  std::unique_ptr<coracle::SolidBody<dim>> solid(const dealii::Tensor<1, dim> &gravity = {}) const
  {
    return std::make_unique<coracle::SolidBody<dim>>(root->section("Bodies").section("body"),
                                                     coracle::MaterialLibrary(*root),
                                                     gravity,
                                                     MPI_COMM_WORLD);
  }

  template <int dim>
  std::unique_ptr<coracle::RigidBody<dim>> rigid(const dealii::Tensor<1, dim> &gravity = {}) const
  {
    return std::make_unique<coracle::RigidBody<dim>>(root->section("Bodies").section("body"),
                                                     gravity,
                                                     MPI_COMM_WORLD);
  }

  coracle::Parameters parameters() const { return *root; }

private:
  static const coracle::Declaration &declare(const int dim)
  {
    static coracle::Declaration declaration[2];
    static bool                 done[2] = {false, false};
    coracle::Declaration       &d       = declaration[dim - 2];
    if (!done[dim - 2])
      {
        done[dim - 2] = true;
        coracle::MaterialLibrary::declare(d);
        coracle::Declaration &body = d.named_sections("Bodies", "body", "All bodies");
        body.choice("Kind", "solid", {"solid", "rigid"}, "kind of body");
        if (dim == 2)
          {
            coracle::SolidBody<2>::declare(body.when("Kind", "solid"));
            coracle::RigidBody<2>::declare(body.when("Kind", "rigid"));
          }
        else
          {
            coracle::SolidBody<3>::declare(body.when("Kind", "solid"));
            coracle::RigidBody<3>::declare(body.when("Kind", "rigid"));
          }
      }
    return d;
  }

  coracle::ParameterFile               file;
  std::unique_ptr<coracle::Parameters> root;
};

/// A solid body's whole step, without contact.
template <int dim>
void
step(coracle::SolidBody<dim> &body, const double time, const double dt)
{
  body.assemble_forces(time);
  body.predict_velocities(dt);
  body.move(dt);
  body.update_stress(dt);
}

/// The same on all ranks.
template <int dim>
double
stable_step(const coracle::SolidBody<dim> &body)
{
  return dealii::Utilities::MPI::min(body.stable_time_step(), body.mesh().communicator());
}
