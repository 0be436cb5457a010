// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs a second of the three local searches on one core, as in Song, Liu & Zhang (2020), section
// 5.1: random points in [-1,1]^3, random facets with one corner in each quadrant, many tests of
// 200,000 pairs; and how many pairs each leaves away from the nearest point.
//   local_search [--tests n] [--pairs n] [--shape i] [--csv file]
//   local_search --oracle n      n pairs of every shape against the quintic
#include <coracle/contact/nearest_point_pack.h>
#include <coracle/contact/perpendicular_foot.h>
#include <coracle/contact/steepest_descent.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <string>

#include "../tests/contact/quintic_oracle.h"

namespace
{
using namespace coracle;
using namespace coracle::contact;
using quintic_oracle::Corners;
using quintic_oracle::Shape;

/// What a search finds: natural coordinates and squared distance, or nothing.
struct Found
{
  double xi, eta, distance_square;
};
constexpr double nothing = -1;

using Pairs   = std::vector<Corners>;
using Results = std::vector<Found>;

Pairs
random_pairs(const Shape shape, const std::size_t n, quintic_oracle::Random &random)
{
  Pairs pairs(n);
  for (auto &corners : pairs)
    {
      corners          = random.facet(shape);
      const auto point = random.point();
      for (auto &corner : corners)
        for (int d = 0; d < 3; ++d)
          corner[d] -= point[d];
    }
  return pairs;
}

template <typename T>
T
square_of(const Bilinear<T> &f, const NaturalPoint<T> &x)
{
  const auto place = evaluate(f, x).place;
  return dot(place, place);
}

/// One facet, or a pack of eight, at a time.
template <typename T, typename Search>
void
for_all(const Pairs &pairs, Results &results, const Search &search)
{
  constexpr std::size_t n_lanes = sizeof(T) / sizeof(double);
  for (std::size_t i = 0; i < pairs.size(); i += n_lanes)
    {
      std::array<Vector<3, T>, 4> x;
      alignas(64) double          lanes[n_lanes];
      for (unsigned int k = 0; k < 4; ++k)
        for (int d = 0; d < 3; ++d)
          {
            for (std::size_t l = 0; l < n_lanes; ++l)
              lanes[l] = pairs[std::min(i + l, pairs.size() - 1)][k][d];
            x[k][d] = load<T>(lanes);
          }
      search(make_bilinear(x), [&](const T &xi, const T &eta, const T &square) {
        double a[n_lanes], b[n_lanes], c[n_lanes];
        store(a, xi);
        store(b, eta);
        store(c, square);
        for (std::size_t l = 0; l < n_lanes && i + l < pairs.size(); ++l)
          results[i + l] = {a[l], b[l], c[l]};
      });
    }
}

/// @param relaxation alpha of Eq. 42; Song et al. set it "around 1", shorter steps go astray less
template <typename T>
void
descend(const Pairs &pairs, Results &results, const double relaxation)
{
  DescentControl control;
  control.relaxation = relaxation;
  for_all<T>(pairs, results, [&](const Bilinear<T> &f, const auto &found) {
    const auto x = steepest_descent(f, control);
    found(x.xi, x.eta, square_of(f, x));
  });
}

template <typename T>
void
foot(const Pairs &pairs, Results &results)
{
  for_all<T>(pairs, results, [&](const Bilinear<T> &f, const auto &found) {
    const auto x      = perpendicular_foot(f);
    const T    inside = select(abs(x.place.xi) <= splat<T>(1.),
                            select(abs(x.place.eta) <= splat<T>(1.), x.found, splat<T>(0.)),
                            splat<T>(0.));
    found(x.place.xi,
          x.place.eta,
          select(inside > splat<T>(0.), square_of(f, x.place), splat<T>(nothing)));
  });
}

void
nearest(const Pairs &pairs, Results &results)
{
  static NearestPointBatch batch;
  batch.find(
    pairs.size(),
    [&](const std::size_t i) { return pairs[i]; },
    [&](const std::size_t i, const double xi, const double eta, const double square) {
      results[i] = {xi, eta, square};
    });
}

struct Method
{
  const char                                   *name;
  std::function<void(const Pairs &, Results &)> run;
  std::vector<double>                           seconds{};
  std::size_t                                   n_other = 0, n_none = 0;
};

std::vector<Method>
all_methods()
{
  return {{"nearest point, packs (ours)", nearest},
          {"steepest descent, one by one",
           [](const Pairs &pairs, Results &results) { descend<double>(pairs, results, 1); }},
          {"the same, alpha = 0.5",
           [](const Pairs &pairs, Results &results) { descend<double>(pairs, results, 0.5); }},
          {"steepest descent, packs",
           [](const Pairs &pairs, Results &results) { descend<Pack8>(pairs, results, 1); }},
          {"perpendicular foot, one by one", foot<double>},
          {"perpendicular foot, packs", foot<Pack8>}};
}

double
median(std::vector<double> times)
{
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

/// How many tests took how long, as in Song's Fig. 13.
void
print_histogram(const std::vector<Method> &methods)
{
  std::printf("\ntests whose time is in the range [ms]; columns as the rows above\n");
  double low = 0;
  for (
    const double high :
    {2., 4., 6., 8., 10., 12., 15., 20., 25., 30., 40., 50., 60., 80., 100., 120., 150., 200., 1e9})
    {
      std::size_t       sum = 0;
      std::vector<long> counts;
      for (const auto &method : methods)
        {
          counts.push_back(
            std::count_if(method.seconds.begin(), method.seconds.end(), [&](const double s) {
              return 1e3 * s >= low && 1e3 * s < high;
            }));
          sum += counts.back();
        }
      if (sum > 0)
        {
          std::printf("%6.0f ... %-6.0f", low, std::min(high, 9999.));
          for (const long count : counts)
            std::printf(" %7ld", count);
          std::printf("\n");
        }
      low = high;
    }
}

void
speed(const Shape        shape,
      const std::size_t  n_tests,
      const std::size_t  n_pairs,
      const std::string &csv)
{
  auto                   methods = all_methods();
  quintic_oracle::Random random(1);
  Results                results(n_pairs);
  for (std::size_t test = 0; test < n_tests; ++test)
    {
      const auto pairs = random_pairs(shape, n_pairs, random);
      for (auto &method : methods)
        {
          const std::clock_t start = std::clock(); // processor time, as Song et al. give it
          method.run(pairs, results);
          method.seconds.push_back(double(std::clock() - start) / CLOCKS_PER_SEC);
          if (test < 3)
            for (std::size_t i = 0; i < n_pairs; ++i)
              {
                method.n_none += (results[i].distance_square == nothing);
                method.n_other += (results[i].distance_square != nothing &&
                                   std::sqrt(results[i].distance_square) >
                                     quintic_oracle::distance(pairs[i]) + 1e-6);
              }
        }
    }
  const double n_checked = n_pairs * std::min<std::size_t>(n_tests, 3),
               ours      = median(methods[0].seconds);
  std::printf("%s: %zu tests of %zu pairs, one core; medians\n\n", name(shape), n_tests, n_pairs);
  std::printf("%-32s %10s %12s %14s %12s %8s\n",
              "",
              "ms a test",
              "M pairs/s",
              "times as long",
              "not nearest",
              "none");
  for (const auto &method : methods)
    std::printf("%-32s %10.2f %12.2f %14.2f %11.4f%% %7.2f%%\n",
                method.name,
                1e3 * median(method.seconds),
                1e-6 * n_pairs / median(method.seconds),
                median(method.seconds) / ours,
                100 * method.n_other / n_checked,
                100 * method.n_none / n_checked);
  print_histogram(methods);
  if (csv.empty())
    return;
  std::FILE *file = std::fopen(csv.c_str(), "w");
  for (const auto &method : methods)
    std::fprintf(file, "%s \"%s [s]\"", &method == &methods[0] ? "" : ",", method.name);
  for (std::size_t test = 0; test < n_tests; ++test)
    for (const auto &method : methods)
      std::fprintf(file, "%s%.6e", &method == &methods[0] ? "\n" : ",", method.seconds[test]);
  std::fprintf(file, "\n");
  std::fclose(file);
}

/// Every shape against the oracle.
bool
check(const std::size_t n)
{
  constexpr std::size_t chunk = 100000;
  std::size_t           wrong = 0;
  std::printf("%-32s %12s %8s %24s\n", "", "pairs", "wrong", "largest excess [m]");
  for (unsigned int s = 0; s < quintic_oracle::n_shapes; ++s)
    {
      quintic_oracle::Random random(100 + s);
      Results                results(chunk);
      std::size_t            wrong_here = 0;
      double                 worst      = 0;
      for (std::size_t done = 0; done < n; done += chunk)
        {
          const auto pairs = random_pairs(Shape(s), chunk, random);
          nearest(pairs, results);
          for (std::size_t i = 0; i < chunk; ++i)
            {
              const double excess =
                std::sqrt(results[i].distance_square) - quintic_oracle::distance(pairs[i]);
              worst = std::max(worst, excess);
              wrong_here += (excess > 1e-9);
            }
        }
      std::printf("%-32s %12zu %8zu %24.2e\n",
                  name(Shape(s)),
                  (n + chunk - 1) / chunk * chunk,
                  wrong_here,
                  worst);
      std::fflush(stdout);
      wrong += wrong_here;
    }
  return wrong == 0;
}
} // namespace

int
main(int argc, char **argv)
{
  const auto option = [&](const std::string &name, const std::string &otherwise) {
    for (int i = 1; i + 1 < argc; ++i)
      if (name == argv[i])
        return std::string(argv[i + 1]);
    return otherwise;
  };
  const auto number = [&](const std::string &name, const char *otherwise) {
    return std::stoul(option(name, otherwise));
  };
  if (const std::size_t n = number("--oracle", "0"))
    return check(n) ? 0 : 1;
  speed(Shape(number("--shape", "0")),
        number("--tests", "100"),
        number("--pairs", "200000"),
        option("--csv", ""));
}
