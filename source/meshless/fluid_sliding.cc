// SPDX-License-Identifier: GPL-3.0-or-later
// Points of the fluid that slide on structures.
#include <coracle/base/mpi.h>
#include <coracle/meshless/fluid.h>

namespace coracle::meshless
{
namespace
{
/// A point of the free surface lets go where a structure hangs over it by more than 30 degrees: a
/// floating body that sways by less must not lose its waterline.
constexpr double overhang = 0.5;
/// Shares of the spacing: an edge between points on a surface is along it if its middle is so near,
/// and points slide no nearer to a held node.
constexpr double along = 0.25, nearest_to_node = 0.25;
/// Cosine of the angle of normals by which a point has slid over an edge.
constexpr double over_edge = 0.866;
} // namespace

/// Which edges of structures are points of the fluid in the next step; where they meet the box they
/// are in any case.
template <int dim>
void
Fluid<dim>::hold_wet_ridges()
{
  if (!structures.slip || structures.empty())
    return;
  std::vector<typename StructureSurface<dim>::Place> sliding;
  std::vector<dealii::Point<dim>>                    near;
  typename StructureSurface<dim>::Place              place;
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (structures.surface.find_nearest(points.position[i], place))
      {
        near.push_back(points.position[i]);
        if (is_sliding(i))
          sliding.push_back(place);
      }
  std::vector<unsigned char> at_box;
  for (const auto &node : structures.surface.nodes)
    at_box.push_back(faces_at(node.position) != 0);
  structures.hold_wet_ridges(sliding, near, at_box, comm);
}

/// The points on structures, and what carries them there, in places of the start of the step.
template <int dim>
void
Fluid<dim>::carry_points()
{
  carried.clear();
  carried_normal.clear();
  typename StructureSurface<dim>::Place place;
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (is_sliding(i) && structures.surface.find_nearest(points.position[i], place))
      {
        carried.push_back({i, place.nodes, place.weights});
        carried_normal.push_back(place.normal);
      }
  for (std::size_t i = n_cloud; i < points.n_own; ++i)
    {
      carried.push_back(structures.carried(i, structures.nodes[i - n_cloud]));
      carried_normal.push_back({});
    }
}

/// Does a point stay on the structure that it is on? Drops may leave, and so may points of the
/// surface where gravity pulls them off.
template <int dim>
bool
Fluid<dim>::stays_on_structure(const std::size_t row, const Vector &normal) const
{
  return !isolated[row] &&
         !(free_surface[row] && normal * options.gravity > overhang * options.gravity.norm());
}

/// Across the surface points move as it does, along it as the fluid.
template <int dim>
void
Fluid<dim>::slide(const typename StructureWalls<dim>::Pushes &pushes)
{
  for (std::size_t k = 0; k < carried.size(); ++k)
    {
      const std::size_t i      = carried[k].row;
      const Vector     &normal = carried_normal[k];
      if (i >= n_cloud || !stays_on_structure(i, normal))
        continue;
      const Vector v =
        structures.velocity_of(carried[k]) + structures.velocity_of(carried[k], pushes);
      moving[i] += (normal * (v - moving[i])) * normal;
      corrected[i] += (normal * (v - corrected[i])) * normal;
      set_wall_velocity(i, moving[i]);
      set_wall_velocity(i, corrected[i]);
    }
}

/// Has a point that slid where the normal was this slid over an edge?
template <int dim>
bool
Fluid<dim>::has_left(const Vector &normal, const typename StructureSurface<dim>::Place &place) const
{
  return place.height > -1e-6 * options.spacing && normal * place.normal < over_edge;
}

/// To the place of a surface, with its velocity across.
template <int dim>
void
Fluid<dim>::put_on_structure(const std::size_t                            row,
                             const typename StructureSurface<dim>::Place &place)
{
  columns[Layout::sliding][row] = 1;
  Vector velocity;
  for (unsigned int d = 0; d < dim; ++d)
    velocity[d] = columns[Layout::velocity + d][row];
  velocity += (place.normal * (structures.surface.velocity(place) - velocity)) * place.normal;
  const unsigned int on      = columns[Layout::walls][row];
  const auto         corners = options.box.get_boundary_points();
  for (unsigned int d = 0; d < dim; ++d)
    {
      columns[Layout::position + d][row] = place.position[d];
      columns[Layout::velocity + d][row] = velocity[d];
      for (unsigned int side = 0; side < 2; ++side)
        if (on >> (2 * d + side) & 1)
          {
            columns[Layout::position + d][row] = side == 0 ? corners.first[d] : corners.second[d];
            columns[Layout::velocity + d][row] = 0;
          }
    }
}

/**
 * Structures have moved: points on them are put on their surfaces again but for those that have
 * slid over an edge; those that have come to a structure are on it from now on.
 */
template <int dim>
void
Fluid<dim>::stay_on_structures()
{
  if (!structures.slip || structures.empty())
    return;
  std::vector<Vector> normal(n_cloud);
  for (std::size_t k = 0; k < carried.size(); ++k)
    if (carried[k].row < n_cloud)
      normal[carried[k].row] = carried_normal[k];
  typename StructureSurface<dim>::Place place;
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      dealii::Point<dim> x;
      Vector             before, after;
      for (unsigned int d = 0; d < dim; ++d)
        {
          x[d]      = columns[Layout::position + d][i];
          before[d] = columns[Layout::velocity + d][i];
        }
      const bool was_sliding      = columns[Layout::sliding][i] > 0;
      columns[Layout::sliding][i] = 0;
      if (!structures.surface.find_nearest(x, place) || (!was_sliding && place.height > 0) ||
          (was_sliding && has_left(normal[i], place)))
        continue;
      put_on_structure(i, place);
      for (unsigned int d = 0; d < dim; ++d)
        after[d] = columns[Layout::velocity + d][i];
      const double stopped =
        0.5 * options.density * moved_volume[i] * (before.norm_square() - after.norm_square());
      energy.boundary += stopped;
      energy.kinetic -= stopped;
    }
  find_moved_boundary();
}

/// Points that slid to a held node; no two may be at one place.
template <int dim>
void
Fluid<dim>::find_slid_together(std::vector<unsigned char> &taken_out)
{
  if (!structures.slip || structures.empty())
    return;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < n_cloud; ++i)
    {
      if (columns[Layout::sliding][i] == 0 || taken_out[i])
        continue;
      dealii::Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = columns[Layout::position + d][i];
      for (unsigned int k = 0; k < structures.surface.nodes.size(); ++k)
        if (structures.is_held(k) && x.distance_square(structures.surface.nodes[k].position) <
                                       std::pow(nearest_to_node * points.spacing[i], 2))
          {
            taken_out[i] = 1;
            ++n;
            break;
          }
    }
  counts.taken_out += mpi::sum(n, comm);
}

/// Is the edge between two points on the surface of a structure?
template <int dim>
bool
Fluid<dim>::is_along_structure(const unsigned int                     i,
                               const unsigned int                     j,
                               const std::vector<dealii::Point<dim>> &x) const
{
  typename StructureSurface<dim>::Place place;
  return is_on_structure(i) && is_on_structure(j) && (is_sliding(i) || is_sliding(j)) &&
         structures.surface.find_nearest(x[i] + 0.5 * (x[j] - x[i]), place) &&
         std::fabs(place.height) < along * points.spacing[i];
}

/// Points inside the fluid so near to a structure that the flat elements between would soon have
/// too large spheres.
template <int dim>
void
Fluid<dim>::find_near_structures(const std::vector<dealii::Point<dim>> &x,
                                 std::vector<double>                   &marks) const
{
  if (!structures.slip || structures.empty())
    return;
  const double least = std::max(options.refill.nearest_to_wall, dim == 3 ? 0.4 : 0.);
  typename StructureSurface<dim>::Place place;
  for (std::size_t i = 0; i < n_cloud; ++i)
    if (columns[Layout::sliding][i] == 0 && !free_surface[i] && !isolated[i] &&
        structures.surface.find_nearest(x[i], place) && place.height < least * points.spacing[i])
      marks[i] += 1;
}

template class Fluid<2>;
template class Fluid<3>;
} // namespace coracle::meshless
