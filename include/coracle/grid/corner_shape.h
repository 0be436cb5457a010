// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>

#include <coracle/base/tensor.h>
#include <coracle/grid/nodal_field.h>

namespace coracle
{
/// One lane per corner of a cell, x fastest.
template <int dim>
using CornerPack = Pack<(1 << dim)>;

/// Coordinate (0 or 1) of each corner in direction d.
template <int dim>
inline CornerPack<dim>
corner_bits(const int d)
{
  CornerPack<dim> bits;
  for (int c = 0; c < (1 << dim); ++c)
    bits[c] = (c >> d) & 1;
  return bits;
}

/// Corner index in direction d as a number.
constexpr int
corner_bit(const int corner, const int d)
{
  return (corner >> d) & 1;
}

/**
 * Multilinear shape functions of one cell at one point, a lane per corner:
 * what a particle gives to the grid is then a few register operations.
 */
template <int dim>
struct CornerShape
{
  CornerPack<dim> value;
  /// Derivatives in unit coordinates; divide by the cell size for 1/m.
  Vector<dim, CornerPack<dim>> gradient;

  /// @param xi coordinates in the cell, 0 to 1
  explicit CornerShape(const Vector<dim, double> &xi)
  {
    Vector<dim, CornerPack<dim>> w, slope;
    for (int d = 0; d < dim; ++d)
      {
        const CornerPack<dim> bits = corner_bits<dim>(d);
        slope[d]                   = 2. * bits - 1.;
        w[d]                       = (1. - bits) + slope[d] * xi[d];
      }
    if constexpr (dim == 2)
      {
        value    = w[0] * w[1];
        gradient = {{slope[0] * w[1], slope[1] * w[0]}};
      }
    else
      {
        const CornerPack<dim> yz = w[1] * w[2];
        value                    = w[0] * yz;
        gradient = {{slope[0] * yz, slope[1] * (w[0] * w[2]), slope[2] * (w[0] * w[1])}};
      }
  }
};

/**
 * Sums of one cell's corners, kept in registers while the particles of the
 * cell are added, and given to the nodes once.
 */
template <int dim>
class CornerSums
{
public:
  using Gathered = typename NodalField<dim>::Gathered;

  CornerPack<dim>              mass{};
  Vector<dim, CornerPack<dim>> momentum{}, force{};

  void
  add_momentum(const CornerShape<dim> &shape, const double m, const Vector<dim, double> &velocity)
  {
    const CornerPack<dim> weight = shape.value * m;
    for (int d = 0; d < dim; ++d)
      momentum[d] += weight * velocity[d];
  }

  /// Velocity v + C (x_corner - x_p), C in 1/s, with r = x_corner - x_p [m] from the shape's xi and
  /// h.
  void add_affine_momentum(const CornerShape<dim>             &shape,
                           const double                        m,
                           const Vector<dim, double>          &velocity,
                           const Matrix<dim, double>          &affine,
                           const Vector<dim, CornerPack<dim>> &r)
  {
    const CornerPack<dim> weight = shape.value * m;
    for (int d = 0; d < dim; ++d)
      {
        CornerPack<dim> v = splat<CornerPack<dim>>(velocity[d]);
        for (int e = 0; e < dim; ++e)
          v += affine[d][e] * r[e];
        momentum[d] += weight * v;
      }
  }

  /// Internal force -V sigma grad N; `volume_per_size` = V/h.
  void
  add_pressure(const CornerShape<dim> &shape, const double pressure, const double volume_per_size)
  {
    const double factor = pressure * volume_per_size;
    for (int d = 0; d < dim; ++d)
      force[d] += factor * shape.gradient[d];
  }

  void add_stress(const CornerShape<dim>       &shape,
                  const Symmetric<dim, double> &stress,
                  const double                  volume_per_size)
  {
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        force[d] -= (volume_per_size * stress(d, e)) * shape.gradient[e];
  }

  void give_to(NodeRecords &records, const std::array<unsigned int, (1 << dim)> &nodes) const
  {
    for (int c = 0; c < (1 << dim); ++c)
      {
        NodeRecord &record = records[nodes[c]];
        record[Gathered::mass] += mass[c];
        for (int d = 0; d < dim; ++d)
          {
            record[Gathered::momentum + d] += momentum[d][c];
            record[Gathered::force + d] += force[d][c];
          }
      }
  }

  void give_to(NodalField<dim> &field, const std::array<unsigned int, (1 << dim)> &nodes) const
  {
    if (!field.reproducible())
      return give_to(field.gathered(), nodes);
    for (int c = 0; c < (1 << dim); ++c)
      {
        field.give(nodes[c], Gathered::mass, mass[c]);
        for (int d = 0; d < dim; ++d)
          {
            field.give(nodes[c], Gathered::momentum + d, momentum[d][c]);
            field.give(nodes[c], Gathered::force + d, force[d][c]);
          }
      }
  }
};

/**
 * Multilinear shape functions of one cell at a pack of points, a lane per
 * point: for what particles take from the grid.
 */
template <int dim>
struct PackShape
{
  Vector<dim, Pack8> one_minus, xi;

  explicit PackShape(const Vector<dim, Pack8> &xi) : xi(xi)
  {
    for (int d = 0; d < dim; ++d)
      one_minus[d] = 1. - xi[d];
  }

  Pack8 weight(const int corner, const int d) const
  {
    return corner_bit(corner, d) ? xi[d] : one_minus[d];
  }

  Pack8 value(const int corner) const
  {
    Pack8 result = weight(corner, 0) * weight(corner, 1);
    if constexpr (dim == 3)
      result *= weight(corner, 2);
    return result;
  }

  /// In unit coordinates.
  Pack8 gradient(const int corner, const int d) const
  {
    Pack8 result = corner_bit(corner, d) ? splat<Pack8>(1.) : splat<Pack8>(-1.);
    for (int e = 0; e < dim; ++e)
      if (e != d)
        result *= weight(corner, e);
    return result;
  }
};
} // namespace coracle
