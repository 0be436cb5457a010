// SPDX-License-Identifier: GPL-3.0-or-later
// How a point's straight path meets one moving facet.
#include <coracle/contact/between.h>
#include <coracle/contact/continuous_check.h>

#include <algorithm>
#include <cmath>

namespace coracle::contact
{
namespace
{
/// A bilinear facet is cut into quarters this often.
constexpr unsigned int most_cuts = 14;

dealii::Tensor<1, 2>
mean_normal(const std::array<dealii::Point<2>, 2> &x)
{
  const auto t = x[1] - x[0];
  return dealii::Tensor<1, 2>({t[1], -t[0]});
}

dealii::Tensor<1, 3>
mean_normal(const std::array<dealii::Point<3>, 4> &x)
{
  return dealii::cross_product_3d(x[2] - x[0], x[3] - x[1]);
}

double
volume(const std::array<dealii::Tensor<1, 2>, 2> &v)
{
  return v[0][0] * v[1][1] - v[0][1] * v[1][0];
}

double
volume(const std::array<dealii::Tensor<1, 3>, 3> &v)
{
  return dealii::cross_product_3d(v[0], v[1]) * v[2];
}

/**
 * Bounds of the volume spanned by vectors that change linearly in time: the
 * smallest and the greatest of its Bernstein coefficients, which are means of
 * volumes of some vectors at the start and the others at the end.
 */
template <int dim>
std::array<double, 2>
volume_bounds(const std::array<dealii::Tensor<1, dim>, dim> &start,
              const std::array<dealii::Tensor<1, dim>, dim> &end)
{
  std::array<double, dim + 1>       sum{};
  std::array<unsigned int, dim + 1> n{};
  for (unsigned int choice = 0; choice < (1u << dim); ++choice)
    {
      std::array<dealii::Tensor<1, dim>, dim> v;
      unsigned int                            degree = 0;
      for (unsigned int i = 0; i < dim; ++i)
        {
          const bool last = (choice >> i) & 1;
          v[i]            = last ? end[i] : start[i];
          degree += last;
        }
      sum[degree] += volume(v);
      ++n[degree];
    }
  std::array<double, 2> result{{sum[0], sum[0]}};
  for (unsigned int i = 0; i <= dim; ++i)
    {
      result[0] = std::min(result[0], sum[i] / n[i]);
      result[1] = std::max(result[1], sum[i] / n[i]);
    }
  return result;
}
} // namespace

template <int dim>
NearestPoint<dim>
ContinuousCheck<dim>::nearest_on(const dealii::Point<dim> &x, const Vertices &vertices)
{
  if constexpr (dim == 3)
    if (vertices[2] == vertices[3])
      return nearest_point_triangle(x, vertices);
  return nearest_point(x, vertices);
}

// Does the facet stay behind a plane along it? Enough for all but a few pairs.
template <int dim>
bool
ContinuousCheck<dim>::certainly_apart(const dealii::Point<dim> &begin,
                                      const dealii::Point<dim> &end,
                                      const Near               &facet)
{
  const Vector normal = mean_normal(facet.start);
  const double length = normal.norm(), side = (begin - facet.start[0]) * normal > 0 ? 1 : -1;
  bool         result = true;
  for (unsigned int k = 0; k < n_vertices; ++k)
    result &= (side * ((begin - facet.start[k]) * normal) > facet.clearance * length) &
              (side * ((end - facet.end[k]) * normal) > facet.clearance * length);
  return result;
}

namespace
{
/// Point and facet at two times.
template <int dim>
using Points = std::array<dealii::Point<dim>, 2>;
template <int dim>
using Facets = std::array<std::array<dealii::Point<dim>, vertices_per_facet<dim>>, 2>;

bool
is_quad(const Facets<2> &)
{
  return false;
}

bool
is_quad(const Facets<3> &x)
{
  return !(x[0][3] == x[0][2] && x[1][3] == x[1][2]);
}

// Does the facet stay farther than `kept` along one direction, that from its middle to the point?
template <int dim>
bool
stays_behind_fixed_plane(const Points<dim> &p, const Facets<dim> &x, const double kept)
{
  dealii::Tensor<1, dim> direction;
  for (unsigned int e = 0; e < 2; ++e)
    for (const auto &corner : x[e])
      direction += p[e] - corner;
  const double length = direction.norm();
  bool         result = (length > 0);
  for (unsigned int e = 0; e < 2; ++e)
    for (const auto &corner : x[e])
      result &= ((p[e] - corner) * direction > kept * length);
  return result;
}

// Does the point stay on one side of a plane that moves with the facet, at least `kept` off it, and
// the facet's remaining node on the other? Knows of turning, unlike a fixed plane.
template <int dim>
bool
stays_behind_moving_plane(const Points<dim> &p, const Facets<dim> &x, const double kept)
{
  const bool         quad = is_quad(x);
  const unsigned int n = (dim == 2 ? 2 : quad ? 4 : 3), n_tries = quad ? 4 : 1;
  for (unsigned int first = 0; first < n_tries; ++first)
    {
      using Vectors = std::array<dealii::Tensor<1, dim>, dim>;
      std::array<Vectors, 2> v, w;
      for (unsigned int e = 0; e < 2; ++e)
        {
          for (unsigned int i = 1; i < dim; ++i)
            v[e][i] = w[e][i] = x[e][(first + i) % n] - x[e][first];
          v[e][0] = p[e] - x[e][first];
          w[e][0] = x[e][(first + n - 1) % n] - x[e][first];
        }
      // A bound of the normal's length.
      const auto longest = [&v](const unsigned int i) {
        return std::max(v[0][i].norm(), v[1][i].norm());
      };
      const double size   = (dim == 2 ? longest(1) : longest(1) * longest(dim - 1));
      const auto   bounds = volume_bounds<dim>(v[0], v[1]);
      const double side   = (bounds[0] > 0 ? 1 : -1);
      const double least  = (bounds[0] > 0 ? bounds[0] : -bounds[1]);
      if (least <= kept * size)
        continue;
      if (!quad)
        return true;
      const auto other = volume_bounds<dim>(w[0], w[1]);
      if ((side > 0 ? other[1] : -other[0]) < 0.1 * kept * size)
        return true;
    }
  return false;
}

/// The quarter of a bilinear facet at a corner.
std::array<dealii::Point<3>, 4>
quarter(const std::array<dealii::Point<3>, 4> &x, const unsigned int corner)
{
  const unsigned int              next = (corner + 1) % 4, last = (corner + 3) % 4;
  std::array<dealii::Point<3>, 4> result;
  result[corner]           = x[corner];
  result[next]             = between(x[corner], x[next], 0.5);
  result[last]             = between(x[corner], x[last], 0.5);
  result[(corner + 2) % 4] = between(between(x[0], x[1], 0.5), between(x[3], x[2], 0.5), 0.5);
  return result;
}

// A warped facet is nearer to a plane in parts.
template <int dim>
bool
stays_off(const Points<dim> &p, const Facets<dim> &x, const double kept, const unsigned int cuts)
{
  if (stays_behind_fixed_plane<dim>(p, x, kept) || stays_behind_moving_plane<dim>(p, x, kept))
    return true;
  if constexpr (dim == 3)
    if (cuts > 0 && is_quad(x))
      {
        for (unsigned int corner = 0; corner < 4; ++corner)
          if (!stays_off<3>(p, {{quarter(x[0], corner), quarter(x[1], corner)}}, kept, cuts - 1))
            return false;
        return true;
      }
  return false;
}
} // namespace

template <int dim>
bool
ContinuousCheck<dim>::meets(const dealii::Point<dim> &begin,
                            const dealii::Point<dim> &end,
                            const Near               &facet,
                            Meeting                  &meeting)
{
  double displacement = 0;
  for (unsigned int k = 0; k < n_vertices; ++k)
    displacement = std::max(displacement, ((end - begin) - (facet.end[k] - facet.start[k])).norm());
  if (displacement == 0)
    return false;
  const double kept = 0.9 * facet.clearance;
  double       t    = 0;
  for (unsigned int i = 0; i < 60; ++i)
    {
      const auto p        = between(begin, end, t);
      const auto x        = between(facet.start, facet.end, t);
      meeting.time        = t;
      meeting.nearest     = nearest_on(p, x);
      const double length = std::sqrt(meeting.nearest.distance_square);
      if (length > 0)
        meeting.normal = (p - meeting.nearest.place) / length;
      if (length <= facet.clearance && i > 0)
        return true;

      // How long the facet stays behind the plane at `kept` from it.
      double plane = 1;
      for (unsigned int k = 0; k < n_vertices; ++k)
        {
          const double now  = (p - x[k]) * meeting.normal - kept,
                       then = (end - facet.end[k]) * meeting.normal - kept;
          if (now <= 0)
            plane = 0;
          else if (then < 0)
            plane = std::min(plane, now / (now - then));
        }
      double next = std::max(t + plane * (1 - t), t + (length - kept) / displacement);
      if (next >= 1)
        return false;
      for (double part = 1; part > 1e-3; part *= 0.25)
        {
          const double s = t + part * (1 - t);
          if (s <= next)
            break;
          const Facets<dim> facets = {{x, between(facet.start, facet.end, s)}};
          if (stays_off<dim>({{p, between(begin, end, s)}}, facets, kept, most_cuts))
            {
              next = s;
              break;
            }
        }
      t = next;
      if (t >= 1)
        return false;
    }
  return true;
}

template <int dim>
bool
ContinuousCheck<dim>::first_meeting(const dealii::Point<dim> &begin,
                                    const dealii::Point<dim> &end,
                                    Meeting                  &meeting,
                                    unsigned int             &which) const
{
  bool    result = false;
  Meeting one{};
  for (unsigned int i = 0; i < near.size(); ++i)
    if (meets(begin, end, near[i], one) && (!result || one.time < meeting.time))
      {
        result  = true;
        meeting = one;
        which   = i;
      }
  return result;
}

template NearestPoint<2> ContinuousCheck<2>::nearest_on(const dealii::Point<2> &, const Vertices &);
template NearestPoint<3> ContinuousCheck<3>::nearest_on(const dealii::Point<3> &, const Vertices &);
template bool            ContinuousCheck<2>::certainly_apart(const dealii::Point<2> &,
                                                  const dealii::Point<2> &,
                                                  const Near &);
template bool            ContinuousCheck<3>::certainly_apart(const dealii::Point<3> &,
                                                  const dealii::Point<3> &,
                                                  const Near &);
template bool            ContinuousCheck<2>::meets(const dealii::Point<2> &,
                                        const dealii::Point<2> &,
                                        const Near &,
                                        Meeting &);
template bool            ContinuousCheck<3>::meets(const dealii::Point<3> &,
                                        const dealii::Point<3> &,
                                        const Near &,
                                        Meeting &);
template bool            ContinuousCheck<2>::first_meeting(const dealii::Point<2> &,
                                                const dealii::Point<2> &,
                                                Meeting &,
                                                unsigned int &) const;
template bool            ContinuousCheck<3>::first_meeting(const dealii::Point<3> &,
                                                const dealii::Point<3> &,
                                                Meeting &,
                                                unsigned int &) const;
} // namespace coracle::contact
