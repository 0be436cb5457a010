// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace coracle
{
/**
 * Rounds numbers to multiples of a power of two that is so large that sums of
 * them are exact, and so do not depend on their order (pre-rounding; J. Demmel &
 * H. D. Nguyen, IEEE Trans. Comput. 64 (2015) 2060-2070, with a known bound).
 * Sums of such numbers times multiples of 2^-k are exact as well if the number of bits
 * is k greater.
 */
class SumGrid
{
public:
  SumGrid() = default;

  /**
   * @param largest no summand is larger [any unit]; must be the same on all ranks
   * @param bits    no sum is larger than 2^bits times that
   */
  SumGrid(const double largest, const int bits)
  {
    int exponent = 0;
    if (largest > 0 && std::isfinite(largest))
      std::frexp(largest, &exponent);
    shift = largest > 0 && std::isfinite(largest) ? std::ldexp(1.5, exponent + bits) : 0.;
  }

  double round(const double x) const { return (x + shift) - shift; }

  /// A bound of what rounding takes away, for a grid of the rests.
  double largest_rest() const { return std::ldexp(shift, -52); }

private:
  double shift = 0;
};

/**
 * A sum of doubles without any error, and so the same in any order: digits to
 * base 2^32 for all exponents there are (R. M. Neal, Fast exact summation using
 * small and large superaccumulators, arXiv:1505.05571). 550 bytes.
 */
class ExactSum
{
public:
  void add(const double x);
  void add(const ExactSum &other);

  /// Rounded; the same for the same exact sum. Not a number if any summand was none, or infinite.
  double value() const;

  /// Each becomes its sum over all ranks. Collective.
  static void sum(std::vector<ExactSum> &sums, MPI_Comm comm);

private:
  static constexpr int n_digits = 68, base_bits = 32, lowest_exponent = -1074;

  /// Every digit but the last into 0 ... 2^32 - 1.
  void carry();

  std::array<std::int64_t, n_digits> digits{};
  std::int64_t                       n_bad = 0, n_added = 0;
};

/// The sum of numbers over all ranks, the same in any order. Collective.
double exact_sum(const std::vector<double> &values, MPI_Comm comm);

/// Some sums over what a rank has and then over all ranks: plain ones, or exact ones that do not
/// depend on the order.
class RankSums
{
public:
  RankSums(const unsigned int n, const bool exact) : plain(exact ? 0 : n), exact(exact ? n : 0) {}

  void add(const unsigned int i, const double x)
  {
    if (exact.empty())
      plain[i] += x;
    else
      exact[i].add(x);
  }
  void add(const unsigned int i, const ExactSum &x)
  {
    if (exact.empty())
      plain[i] += x.value();
    else
      exact[i].add(x);
  }

  /// Over all ranks, known to all. Collective.
  std::vector<double> total(MPI_Comm comm) const;
  /// Parts that give the total in any sum over ranks: what this rank has or, if exact, all on rank
  /// 0 and nothing elsewhere (collective then).
  std::vector<double> share(MPI_Comm comm) const;

private:
  std::vector<double>   plain;
  std::vector<ExactSum> exact;
};
} // namespace coracle
