// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/structure_work.h>

#include <vector>

namespace coracle
{
/**
 * Between steps: meshes of solid and rigid bodies become finer where criteria ask for it, those of
 * a body's section `Adaptivity`. They never become coarser. Surfaces stay where they are, see
 * StructureMesh::refine; contact starts from the new facets and nodes.
 */
template <int dim>
class StructureAdaptivity
{
public:
  /// Section `Adaptivity` of a body with a mesh of elements.
  static void declare(Declaration &body, const bool is_deformable);

  /// Throws UserError.
  StructureAdaptivity(const Parameters               &root,
                      const MaterialPointSystem<dim> &points,
                      StructureSystem<dim>           &structure);

  /// At the start: until nothing changes. Collective.
  void initialise(MaterialPointSystem<dim> &points,
                  StructureSystem<dim>     &structure,
                  ContactCoupling<dim>     &contacts) const;

  /// After the step of this number: refines bodies that are due. Collective; throws RunFailure, on
  /// all ranks.
  void update(MaterialPointSystem<dim> &points,
              StructureSystem<dim>     &structure,
              ContactCoupling<dim>     &contacts,
              const std::uint64_t       step) const;

private:
  enum class Kind
  {
    contact_distance,
    error_estimator
  };

  struct Criterion
  {
    Kind         kind;
    double       threshold;
    unsigned int highest_level;
    /// Which surfaces and bodies of material points count, by their numbers.
    std::vector<bool> surfaces, particles;
  };

  /// What becomes of one body.
  struct Plan
  {
    unsigned int           interval = 1, first_level = 0;
    std::vector<Criterion> criteria;
  };

  static Criterion read(const Parameters &section);
  static void      refuse_impossible(const Parameters          &body,
                                     const Parameters          &root,
                                     const StructuralBody<dim> &mesh_of,
                                     const Plan                &plan);
  static void      read_bodies(const Parameters               &section,
                               const MaterialPointSystem<dim> &points,
                               const StructureSystem<dim>     &structure,
                               const unsigned int              body,
                               Criterion                      &criterion);
  /// True if anything has changed.
  bool adapt(MaterialPointSystem<dim> &points,
             StructureSystem<dim>     &structure,
             ContactCoupling<dim>     &contacts,
             const std::uint64_t       step) const;
  /// By element of a body. Collective.
  std::vector<bool> wanted(const Plan                     &plan,
                           const unsigned int              body,
                           const MaterialPointSystem<dim> &points,
                           StructureSystem<dim>           &structure) const;
  /// Elements with a facet near to something that counts.
  static std::vector<bool> near_others(const Criterion                &criterion,
                                       const unsigned int              body,
                                       const MaterialPointSystem<dim> &points,
                                       StructureSystem<dim>           &structure);

  /// By body, solids first; none: nothing is adapted.
  std::vector<Plan>        plans;
  const StructureWork<dim> work;
  /// Are changed meshes shared out by their work, and not evenly?
  bool by_work;
};
} // namespace coracle
