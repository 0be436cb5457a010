// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/coupling/refinement_measures.h>

#include <memory>
#include <string>
#include <vector>

namespace coracle
{
/**
 * Which leaves are to be finer or coarser: the finest that any criterion of the parameter file asks
 * for.
 *
 * A criterion compares a number of each leaf with two thresholds: beyond one of them it asks for a
 * level more, beyond the other it lets the leaf become coarser, in between the leaf stays as it is.
 * Where the number is known for any place, a leaf becomes coarser only if what it becomes would not
 * be refined again at once.
 */
template <int dim>
class RefinementCriteria
{
public:
  /// Section `Grid/Adaptivity/Criteria`.
  static void declare(Declaration &adaptivity);
  RefinementCriteria(const Parameters           &root,
                     const StructureSystem<dim> &structure,
                     const bool                  contact_on_surface);

  bool empty() const { return criteria.empty(); }
  /// Highest level that any asks for.
  unsigned int highest_level() const;
  bool         uses_contacts() const;

  /// Level for each owned leaf, at most one from what it has. Collective.
  std::vector<int> wanted_levels(const RefinementScene<dim> &scene) const;

private:
  enum class Kind
  {
    surface,
    contact_pressure,
    free_surface,
    velocity_jump,
    pressure_jump,
    function
  };

  struct Criterion
  {
    Kind   kind;
    double refine, coarsen;
    int    lowest, highest;
    /// Surfaces that count, by their number; empty: all.
    std::vector<bool>                      surfaces;
    std::shared_ptr<dealii::Function<dim>> function;

    /// Is the leaf refined where the number is below the threshold?
    bool fine_below() const { return kind == Kind::surface || kind == Kind::free_surface; }
    bool refines(const double value) const
    {
      return fine_below() ? value < refine : value > refine;
    }
    bool coarsens(const double value) const
    {
      return fine_below() ? value > coarsen : value < coarsen;
    }
  };

  static Criterion read(const Parameters &section);
  static void      read_surfaces(const Parameters           &section,
                                 const StructureSystem<dim> &structure,
                                 Criterion                  &criterion);

  /// Number of each owned leaf, and of its parent where that can be told.
  struct Values
  {
    std::vector<double> leaf, parent;
  };
  Values evaluate(const Criterion &criterion, const RefinementScene<dim> &scene) const;

  std::vector<Criterion> criteria;
};
} // namespace coracle
