// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/columns.h>
#include <coracle/io/probes.h>
#include <coracle/particles/material_points.h>
#include <coracle/structure/structural_body.h>

namespace coracle
{
/// n neighbouring columns as one field.
Field columns_field(const std::string &name,
                    const std::string &unit,
                    const Columns     &columns,
                    const unsigned int first,
                    const unsigned int n);

/// Nodes as probes see them, where they lie. @param keys room for what the body does not hold
template <int dim>
NodeView node_view(const StructuralBody<dim> &body, std::vector<std::uint64_t> &keys);

/// Particles as probes see them, where they lie. @param pressure room for what they do not hold
template <int dim>
ParticleView particle_view(const MaterialPoints<dim> &points, std::vector<double> &pressure);
} // namespace coracle
