// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/box_tree.h>
#include <coracle/contact/facet_exchange.h>

namespace coracle::contact
{
/**
 * How far places are from the surfaces of structures, wherever these are owned: to the nearest
 * point of all facets, less half the thickness. Sides do not matter.
 */
template <int dim>
class SurfaceDistance
{
public:
  explicit SurfaceDistance(MPI_Comm communicator) : exchange(communicator) {}

  /**
   * Collective.
   * @param owned  facets that this rank owns
   * @param places boxes around the places that will be asked for
   * @param reach  the largest limit that will be asked for [m]
   */
  void reinit(const Surface<dim> &owned, const std::vector<Box> &places, const double reach);

  /// Distance [m], or `limit` if nothing is nearer than that.
  double operator()(const dealii::Point<dim> &place, const double limit) const;

  /// The same to some bodies: those with counts[body], by their index in Surface::bodies.
  double distance(const dealii::Point<dim> &place,
                  const double              limit,
                  const std::vector<bool>  &counts) const;

  /// Notes the facets of the bodies that count which are nearer to a place than `limit`.
  void
  note_near(const dealii::Point<dim> &place, const double limit, const std::vector<bool> &counts);
  /// Collective. Which nodes of the surface given to reinit() are corners of facets that any rank
  /// has noted.
  std::vector<bool> noted_nodes(const std::size_t n_owned_nodes) const;

private:
  FacetExchange<dim>                exchange;
  BoxTree                           tree;
  std::vector<Box>                  boxes;
  mutable std::vector<unsigned int> found;
  std::vector<bool>                 noted;
};
} // namespace coracle::contact
