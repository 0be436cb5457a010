// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/contact_coupling.h>

#include <vector>

namespace coracle
{
/**
 * What the elements of structures cost the rank that owns them, in particle-steps: an element its
 * stress, a facet that its nodes are published, searched and followed, and a node on the surface
 * its contacts with other structures. Contacts of particles are computed where the particles are.
 */
template <int dim>
class StructureWork
{
public:
  using ByBody = typename StructureSystem<dim>::Work;

  /// Into section `Grid/Load balance`.
  static void declare(Declaration &load_balance);
  explicit StructureWork(const Parameters &root);

  /// By body, solids first, and element (or facet of a sheet) of this rank; more than 0.
  ByBody of_elements(const StructureSystem<dim> &structure,
                     const ContactCoupling<dim> &contacts) const;

  /// May structures be shared out anew while the run goes on? Contact on the grid and the meshless
  /// fluid keep what they know of structures by its place.
  bool may_share_out() const { return may_move; }

private:
  /// Of one body, whose elements have this weight; sheets have facets only.
  std::vector<double> of_body(const StructuralBody<dim>  &body,
                              const StructurePoints<dim> &points,
                              const unsigned int          index,
                              const double                weight) const;

  double element_weight, contact_weight;
  bool   may_move;
};

extern template class StructureWork<2>;
extern template class StructureWork<3>;
} // namespace coracle
