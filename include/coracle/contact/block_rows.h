// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/contact.h>
#include <coracle/contact/ordered_copies.h>
#include <coracle/contact/point_set.h>

namespace coracle::contact
{
/**
 * Rows for results that do not depend on the ranks, bit by bit: contacts are
 * solved in blocks that every partition leaves whole (those of the points of one
 * group, or of one point), and each block has its own copies of the unknowns and rigid
 * bodies that it acts on. Sweeps then see only their own block, whatever
 * else is on the rank, and OrderedCopies brings the copies together after each
 * iteration (mass splitting as in SharedUnknowns).
 */
template <int dim>
class BlockRows
{
public:
  explicit BlockRows(MPI_Comm communicator);

  /// The block of each contact: the identity of the first point in it. Contacts are sorted by set
  /// and point.
  static std::vector<std::uint64_t> find_blocks(const std::vector<Contact<dim>>  &contacts,
                                                const std::vector<PointSet<dim>> &points);

  /// Collective.
  void reinit(const std::vector<std::uint64_t>     &block,
              const Rows                           &rows,
              const std::vector<Unknown<dim>>      &unknowns,
              const std::vector<RigidUnknown<dim>> &rigid);

  /// As given, but of copies.
  const Rows                           &rows() const { return list; }
  const std::vector<Unknown<dim>>      &unknowns() const { return copies_of_unknowns; }
  const std::vector<RigidUnknown<dim>> &rigid() const { return copies_of_bodies; }

  /// What a copy is one of: number of the unknown, and of the rigid body.
  unsigned int unknown(const unsigned int copy) const { return original[copy]; }
  unsigned int body(const unsigned int copy) const { return body_of_copy[copy]; }
  unsigned int n_bodies() const { return number_of_bodies; }

  OrderedCopies<dim> copies;

private:
  Rows                           list;
  std::vector<Unknown<dim>>      copies_of_unknowns;
  std::vector<RigidUnknown<dim>> copies_of_bodies;
  std::vector<unsigned int>      original, body_of_copy;
  std::vector<std::uint64_t>     block_of_copy;
  unsigned int                   number_of_bodies = 0;
};
} // namespace coracle::contact
