// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace coracle
{
/// Weighted means of one quantity over the particles that are in each leaf.
class LeafMeans
{
public:
  void reinit(const unsigned int n_leaves) { sums.assign(n_leaves, Sum()); }

  void add(const unsigned int leaf, const double weight, const double value)
  {
    add_sums(leaf, weight, weight * value);
  }
  void add_sums(const unsigned int leaf,
                const double       weight,
                const double       weighted_value,
                const double       mass = 0)
  {
    sums[leaf].weight += weight;
    sums[leaf].value += weighted_value;
    sums[leaf].mass += mass;
  }

  double mean(const unsigned int leaf) const
  {
    return sums[leaf].weight > 0 ? sums[leaf].value / sums[leaf].weight : 0.;
  }

  /// Weight per mass: the mean specific volume where weights are volumes.
  double weight_per_mass(const unsigned int leaf) const
  {
    return sums[leaf].mass > 0 ? sums[leaf].weight / sums[leaf].mass : 0.;
  }

private:
  struct Sum
  {
    double weight = 0, value = 0, mass = 0;
  };
  std::vector<Sum> sums;
};
} // namespace coracle
