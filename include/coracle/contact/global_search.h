// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>
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

  /// The lists, of use to the same ranks only.
  void serialize(Archive &archive)
  {
    std::uint64_t n = lists.size();
    archive.own("n_lists", n);
    lists.resize(n);
    for (std::uint64_t i = 0; i < n; ++i)
      {
        const Archive::Section section(archive, std::to_string(i));
        archive.own("point", lists[i].point);
        archive.own("begin", lists[i].begin);
        archive.own("facet", lists[i].facet);
      }
  }

private:
  std::variant<TreeSearch, BucketSearch, AllPairsSearch> method;
  std::vector<Box>                                       boxes;
  std::vector<Candidates>                                lists;
};
} // namespace coracle::contact
