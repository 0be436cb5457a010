// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/coupling/material_point_system.h>
#include <coracle/grid/corner_shape.h>
#include <coracle/grid/pieces.h>

namespace coracle
{
template <int dim>
void
MaterialPointSystem<dim>::add_body_forces(MaterialPointBody<dim> &body,
                                          const double            time,
                                          const double            dt)
{
  using Layout    = ParticleLayout<dim>;
  using Gathered  = typename NodalField<dim>::Gathered;
  auto    &points = body.points;
  auto    &to     = field(body);
  RankSums work(1, reproducible);
  body.body_force->set_time(time);
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      {
        const auto             x = points.position(row);
        const double           m = points.column(Layout::mass)[row];
        dealii::Tensor<1, dim> force;
        for (int d = 0; d < dim; ++d)
          {
            force[d] = m * body.body_force->value(x, d);
            work.add(0,
                     dt * force[d] *
                       (points.column(Layout::velocity + d)[row] + 0.5 * dt * force[d] / m));
          }
        if (points.cuts.contains(row))
          {
            const unsigned int i = points.cuts.find(row);
            for (std::size_t e = points.cuts.begin[i]; e < points.cuts.begin[i + 1]; ++e)
              for (int d = 0; d < dim; ++d)
                to.give(points.cuts.entries[e].node,
                        Gathered::force + d,
                        points.cuts.entries[e].value * force[d]);
            continue;
          }
        const double half = body.margin_of_shape() * points.column(Layout::size)[row];
        for_each_piece(octree,
                       x,
                       half,
                       [&](const int leaf, const auto &piece, const double fraction) {
                         const CornerShape<dim> shape(unit_coordinates(octree, leaf, piece));
                         for (int c = 0; c < (1 << dim); ++c)
                           for (int d = 0; d < dim; ++d)
                             to.give(octree.nodes(leaf)[c],
                                     Gathered::force + d,
                                     fraction * shape.value[c] * force[d]);
                       });
      }
  energy.external_work += work.share(octree.triangulation.get_communicator())[0];
}

template void
MaterialPointSystem<2>::add_body_forces(MaterialPointBody<2> &, const double, const double);
template void
MaterialPointSystem<3>::add_body_forces(MaterialPointBody<3> &, const double, const double);
} // namespace coracle
