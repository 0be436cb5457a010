// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exact_sum.h>

#include <limits>
#include <type_traits>

namespace coracle
{
namespace
{
/// Digits hold 31 bits of carries before they must be passed on.
constexpr std::int64_t                  most_added = std::int64_t(1) << 29;
constexpr std::int64_t                  digit_mask = 0xFFFFFFFF;
__extension__ typedef unsigned __int128 Wide;
} // namespace

void
ExactSum::add(const double x)
{
  if (x == 0)
    return;
  if (!std::isfinite(x))
    {
      ++n_bad;
      return;
    }
  int                 exponent;
  const double        fraction = std::frexp(std::abs(x), &exponent);
  const std::uint64_t whole    = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
  // |x| = whole * 2^(exponent - 53); a denormal number has zeros at its end.
  int  place  = exponent - 53 - lowest_exponent;
  Wide places = whole;
  if (place < 0)
    {
      places >>= -place;
      place = 0;
    }
  else
    places <<= place % base_bits;
  const std::int64_t sign = x < 0 ? -1 : 1;
  for (int d = place / base_bits; places != 0; ++d, places >>= base_bits)
    digits[d] += sign * static_cast<std::int64_t>(places & digit_mask);
  if (++n_added >= most_added)
    carry();
}

void
ExactSum::add(const ExactSum &other)
{
  ExactSum copy = other;
  copy.carry();
  for (int d = 0; d < n_digits; ++d)
    digits[d] += copy.digits[d];
  n_bad += copy.n_bad;
  if (++n_added >= most_added)
    carry();
}

void
ExactSum::carry()
{
  for (int d = 0; d + 1 < n_digits; ++d)
    {
      digits[d + 1] += digits[d] >> base_bits;
      digits[d] &= digit_mask;
    }
  n_added = 0;
}

double
ExactSum::value() const
{
  if (n_bad > 0)
    return std::numeric_limits<double>::quiet_NaN();
  ExactSum positive = *this;
  positive.carry();
  const bool negative = positive.digits.back() < 0;
  if (negative)
    {
      for (auto &digit : positive.digits)
        digit = -digit;
      positive.carry();
    }
  double result = 0;
  for (int d = n_digits - 1; d >= 0; --d)
    result += std::ldexp(static_cast<double>(positive.digits[d]), base_bits * d + lowest_exponent);
  return negative ? -result : result;
}

void
ExactSum::sum(std::vector<ExactSum> &sums, MPI_Comm comm)
{
  static_assert(std::is_trivially_copyable_v<ExactSum> &&
                  sizeof(ExactSum) == (n_digits + 2) * sizeof(std::int64_t),
                "they travel as integers");
  for (ExactSum &sum : sums)
    sum.carry();
  MPI_Allreduce(
    MPI_IN_PLACE, sums.data(), sums.size() * (n_digits + 2), MPI_INT64_T, MPI_SUM, comm);
}

std::vector<double>
RankSums::total(MPI_Comm comm) const
{
  std::vector<double> result = plain;
  if (exact.empty())
    {
      MPI_Allreduce(MPI_IN_PLACE, result.data(), result.size(), MPI_DOUBLE, MPI_SUM, comm);
      return result;
    }
  std::vector<ExactSum> sums = exact;
  ExactSum::sum(sums, comm);
  for (const ExactSum &sum : sums)
    result.push_back(sum.value());
  return result;
}

std::vector<double>
RankSums::share(MPI_Comm comm) const
{
  if (exact.empty())
    return plain;
  std::vector<double> result = total(comm);
  int                 rank   = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank != 0)
    result.assign(result.size(), 0.);
  return result;
}

double
exact_sum(const std::vector<double> &values, MPI_Comm comm)
{
  std::vector<ExactSum> sum(1);
  for (const double value : values)
    sum[0].add(value);
  ExactSum::sum(sum, comm);
  return sum[0].value();
}
} // namespace coracle
