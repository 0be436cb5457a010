// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/all_pairs_search.h>
#include <coracle/contact/bucket_search.h>
#include <coracle/contact/options.h>
#include <coracle/contact/tree_search.h>

#include <variant>

namespace coracle::contact
{
/**
 * Candidates of all points of the sets: facets whose box, enlarged by half the
 * thickness, the point's radius and `reach` [m], holds the point. How they are
 * looked for is chosen once; all ways give the same lists.
 */
template <int dim>
class GlobalSearch
{
public:
  explicit GlobalSearch(const Search method = Search::aabb_tree);

  void rebuild(const Surface<dim>               &surface,
               const std::vector<PointSet<dim>> &points,
               const double                      reach);

  const Candidates &candidates(const unsigned int set) const { return lists[set]; }

private:
  std::variant<TreeSearch, BucketSearch, AllPairsSearch> method;
  std::vector<Box>                                       boxes;
  std::vector<Candidates>                                lists;
};
} // namespace coracle::contact
