// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/contact_coupling.h>
#include <coracle/coupling/particle_refinement.h>
#include <coracle/coupling/refinement_criteria.h>
#include <coracle/coupling/structure_work.h>

namespace coracle
{
/// All that adaptivity and load balance remember from one step to the next; the same on all ranks.
struct AdaptivityState
{
  /// Of each body of material points: ids from here on have never been used.
  std::vector<std::uint64_t> next_id;
  /// Steps since the last adaptation and since the last look at the balance.
  std::uint64_t steps = 0, steps_since_balance = 0;
  /// How far anything can have moved since the last adaptation [m].
  double travelled = 0;
  /// Imbalance after the last sharing out: it is tried again only if it got worse.
  double reached_imbalance = 1;

  void serialize(Archive &archive);
};

/**
 * Between steps: the octree becomes finer and coarser as criteria ask, particles split and merge
 * with their cells, and all, elements of structures too, is shared out among the ranks anew where
 * the work has become uneven.
 */
template <int dim>
class Adaptivity
{
public:
  /// Sections `Grid/Adaptivity` and `Grid/Load balance`.
  static void declare(Declaration &grid);
  Adaptivity(const Parameters           &root,
             const StructureSystem<dim> &structure,
             const contact::Method       method);

  /// At the start: until nothing changes. Collective.
  void initialise(MaterialPointSystem<dim> &points,
                  StructureSystem<dim>     &structure,
                  ContactCoupling<dim>     &contacts);

  /// After a step of length dt: adapts and balances when due. Collective.
  void update(MaterialPointSystem<dim> &points,
              StructureSystem<dim>     &structure,
              ContactCoupling<dim>     &contacts,
              const double              time,
              const double              dt);

  /// Largest over mean work of the ranks: cells, particles, elements, contacts [1]. Collective.
  double imbalance(const MaterialPointSystem<dim> &points,
                   const StructureSystem<dim>     &structure,
                   const ContactCoupling<dim>     &contacts) const;

  /// Between steps: what makes the work uneven is shared out anew, if it is too uneven. Collective.
  /// @return has anything been shared out?
  bool balance(MaterialPointSystem<dim> &points,
               StructureSystem<dim>     &structure,
               ContactCoupling<dim>     &contacts);

  AdaptivityState state;

private:
  bool
  due(const MaterialPointSystem<dim> &points, StructureSystem<dim> &structure, const double dt);
  /// True if cells or particles have changed.
  bool adapt(MaterialPointSystem<dim> &points,
             StructureSystem<dim>     &structure,
             ContactCoupling<dim>     &contacts,
             const double              time);
  /// Per owned leaf, in particle-steps, besides one for the leaf.
  std::vector<double> work(const MaterialPointSystem<dim> &points,
                           const ContactCoupling<dim>     &contacts) const;

  /// This rank's work of the octree with its particles, then of each structure, solids first.
  std::vector<double> work_of_parts(const MaterialPointSystem<dim>            &points,
                                    const ContactCoupling<dim>                &contacts,
                                    const typename StructureWork<dim>::ByBody &elements) const;
  /// Which of them make the work uneven. Collective.
  static std::vector<bool> uneven_parts(const std::vector<double> &work, MPI_Comm comm);

  RefinementCriteria<dim> criteria;
  ParticleRefinement<dim> refinement;
  StructureWork<dim>      structure_work;
  unsigned int            interval, balance_interval;
  double                  interval_in_cells, largest_imbalance, contact_weight;
  /// Results do not depend on the ranks.
  bool reproducible;
};
} // namespace coracle
