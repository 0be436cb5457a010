// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>

#include <vector>

namespace coracle
{
/// What contact does to the particles in each owned leaf, since the octree changed or was last
/// looked at.
class LeafContacts
{
public:
  void reinit(const unsigned int n_leaves)
  {
    impulses.assign(n_leaves, 0.);
    numbers.assign(n_leaves, 0.);
    duration = 0;
    n_steps  = 0;
  }

  void begin_step(const double dt)
  {
    duration += dt;
    ++n_steps;
  }
  void add(const unsigned int leaf, const double impulse)
  {
    impulses[leaf] += impulse;
    numbers[leaf] += 1;
  }

  /// Mean of the sum of the contacts' forces, each taken by its size [N].
  double force(const unsigned int leaf) const
  {
    return duration > 0 ? impulses[leaf] / duration : 0.;
  }
  /// Contacts in a step, on average.
  double number(const unsigned int leaf) const
  {
    return n_steps > 0 ? numbers[leaf] / n_steps : 0.;
  }

  /// On other ranks leaves are others: what is known of them is forgotten.
  void serialize(Archive &archive, const unsigned int n_leaves)
  {
    if (!archive.is_exact())
      return reinit(n_leaves);
    archive.own("impulses", impulses);
    archive.own("numbers", numbers);
    archive.own("duration", duration);
    archive.own("n_steps", n_steps);
  }

private:
  std::vector<double> impulses, numbers;
  double              duration = 0;
  unsigned int        n_steps  = 0;
};
} // namespace coracle
