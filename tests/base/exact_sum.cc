// SPDX-License-Identifier: GPL-3.0-or-later
// Exact sums have no error and do not depend on order or ranks; rounded summands make plain sums
// exact and lose no more than they say.
#include <coracle/base/exact_sum.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests.h"

using namespace coracle;

double
sum_of(const std::vector<double> &values)
{
  ExactSum sum;
  for (const double x : values)
    sum.add(x);
  return sum.value();
}

/// Numbers of all sizes, each with its opposite, and a few that are left.
void
test_cancelling(std::mt19937 &random)
{
  std::uniform_int_distribution<int>     exponent(-1060, 1000);
  std::uniform_real_distribution<double> fraction(0.5, 1);
  bool                                   right = true;
  for (unsigned int trial = 0; trial < 50; ++trial)
    {
      const double left = (trial % 2 ? -1 : 1) * std::ldexp(fraction(random), exponent(random));
      std::vector<double> values{left};
      for (unsigned int i = 0; i < 1000; ++i)
        {
          const double x = std::ldexp(fraction(random), exponent(random));
          values.push_back(x);
          values.push_back(-x);
        }
      std::shuffle(values.begin(), values.end(), random);
      right = right && sum_of(values) == left;
    }
  const double tiny = std::numeric_limits<double>::denorm_min();
  deallog << "what is left of numbers that cancel " << right << ", of denormal ones "
          << (sum_of({tiny, 1e308, tiny, -1e308, tiny}) == 3 * tiny) << ", nothing "
          << (sum_of({}) == 0) << ", no number "
          << std::isnan(sum_of({1, std::numeric_limits<double>::infinity()})) << std::endl;
}

void
test_many()
{
  // More than digits hold without carrying, in two ways: k copies, and doubled k times.
  ExactSum one, many;
  for (unsigned int i = 0; i < 3000000; ++i)
    one.add(-0.1);
  many.add(-0.1);
  for (unsigned int i = 0; i < 100; ++i)
    {
      const ExactSum copy = many;
      many.add(copy);
    }
  // 3e6 times the double next to 0.1 in integers: 0.1 = 0x1999999999999a / 2^56.
  const long double exact =
    -3000000.L * static_cast<long double>(0x1999999999999aull) / (1ull << 56);
  deallog << "many: " << (one.value() == static_cast<double>(exact)) << ' '
          << (many.value() == -std::ldexp(0.1, 100)) << std::endl;
}

void
test_ranks(std::mt19937 &random)
{
  // All ranks draw the same numbers; each takes its share, dealt out anew each time.
  const MPI_Comm     comm = MPI_COMM_WORLD;
  const unsigned int n    = dealii::Utilities::MPI::n_mpi_processes(comm),
                     me   = dealii::Utilities::MPI::this_mpi_process(comm);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<double>                    values(1000);
  bool                                   same = true;
  for (unsigned int trial = 0; trial < 20; ++trial)
    {
      for (double &x : values)
        x = std::ldexp(number(random), trial);
      std::vector<double> mine;
      RankSums            sums(2, true);
      for (unsigned int i = 0; i < values.size(); ++i)
        if ((i * (trial + 3)) % n == me)
          {
            mine.push_back(values[i]);
            sums.add(1, values[i]);
          }
      const double all   = sum_of(values);
      const auto   share = sums.share(comm);
      same               = same && exact_sum(mine, comm) == all && sums.total(comm)[1] == all &&
             dealii::Utilities::MPI::sum(share[1], comm) == all;
    }
  deallog << "the same on ranks " << !dealii::Utilities::MPI::logical_or(!same, comm) << std::endl;
}

void
test_grid(std::mt19937 &random)
{
  std::normal_distribution<double> number(0, 1e-3);
  std::vector<double>              values(1000);
  double                           largest = 0;
  for (double &x : values)
    {
      x       = number(random);
      largest = std::max(largest, std::abs(x));
    }
  const SumGrid high(largest, 12), low(high.largest_rest(), 12);
  double        worst = 0, plain_high = 0, plain_low = 0;
  ExactSum      exact_high, exact_low;
  bool          same = true;
  for (unsigned int trial = 0; trial < 20; ++trial)
    {
      std::shuffle(values.begin(), values.end(), random);
      double sum = 0, rests = 0;
      for (const double x : values)
        {
          const double a = high.round(x), b = low.round(x - a);
          worst = std::max(worst, std::abs((x - a) - b) / largest);
          sum += 0.25 * a;
          rests += 0.25 * b;
          if (trial == 0)
            {
              exact_high.add(0.25 * a);
              exact_low.add(0.25 * b);
            }
        }
      if (trial == 0)
        {
          plain_high = sum;
          plain_low  = rests;
        }
      same = same && sum == plain_high && rests == plain_low;
    }
  deallog << "rounded: the same in any order " << same << ", exact "
          << (plain_high == exact_high.value() && plain_low == exact_low.value())
          << ", two sums lose less than 1e-22 " << (worst < 1e-22) << ", no grid changes nothing "
          << (SumGrid().round(0.1) == 0.1) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  std::mt19937 random(1);
  test_cancelling(random);
  test_many();
  test_grid(random);
  test_ranks(random);
}
