// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/global_minimum.h>

#include <vector>

namespace coracle::contact
{
/// Eight facets with their nearest points, as far as they are proven.
struct NearestPointPack
{
  NaturalPoint<Pack8> place;
  Proof<Pack8>        proof;
};

/// A local minimum from a good start, which is nearly always the nearest point, with its proof.
NearestPointPack nearest_point_first(const Bilinear<Pack8> &facets);

/// For what the first search leaves in doubt: more starts along the other coordinate, and a
/// sharper proof.
NearestPointPack nearest_point_second(const Bilinear<Pack8> &facets);

/**
 * Nearest points of many pairs of a point and a quadrilateral, eight in the
 * lanes of packs. No pair is left in another local minimum: each result is
 * proven, in the first search, in the second, or by boxes.
 *
 * A pair's result depends on its point and corners alone, bit by bit, not on
 * the other pairs, their number or order.
 */
class NearestPointBatch
{
public:
  using Corners = std::array<Vector<3, double>, 4>;

  /**
   * @param corners (i): Corners of pair i's facet, relative to its point [m]
   * @param found   (i, xi, eta, distance_square): called once for each pair, in any order
   */
  template <typename CornersOf, typename Found>
  void find(const std::size_t n, const CornersOf &corners, const Found &found);

private:
  /// The pairs index(0) ... index(7).
  template <typename CornersOf, typename Index>
  Bilinear<Pack8> gather(const CornersOf &corners, const Index &index);

  struct Doubt
  {
    std::size_t          pair;
    NaturalPoint<double> best;
    double               distance_square;
  };
  std::vector<Doubt> doubts;
};

/// Of one pair, the same as in a batch.
NaturalPoint<double> nearest_natural_point(const NearestPointBatch::Corners &corners);

/// The last resort.
struct NearestNaturalPoint
{
  NaturalPoint<double> place;
  double               distance_square;
};
NearestNaturalPoint nearest_point_exact(const NearestPointBatch::Corners &corners,
                                        const NaturalPoint<double>       &best);

template <typename CornersOf, typename Index>
inline Bilinear<Pack8>
NearestPointBatch::gather(const CornersOf &corners, const Index &index)
{
  alignas(64) double lanes[4][3][pack_size];
  for (int l = 0; l < pack_size; ++l)
    {
      const Corners x = corners(index(l));
      for (unsigned int k = 0; k < 4; ++k)
        for (int d = 0; d < 3; ++d)
          lanes[k][d][l] = x[k][d];
    }
  std::array<Vector<3, Pack8>, 4> packs;
  for (unsigned int k = 0; k < 4; ++k)
    for (int d = 0; d < 3; ++d)
      packs[k][d] = load<Pack8>(lanes[k][d]);
  return make_bilinear(packs);
}

template <typename CornersOf, typename Found>
void
NearestPointBatch::find(const std::size_t n, const CornersOf &corners, const Found &found)
{
  doubts.clear();
  for (std::size_t i = 0; i < n; i += pack_size)
    {
      // Lanes that are too many repeat the last pair.
      const auto result =
        nearest_point_first(gather(corners, [&](const int l) { return std::min(i + l, n - 1); }));
      for (int l = 0; l < pack_size && i + l < n; ++l)
        if (result.proof.holds[l] > 0)
          found(i + l, result.place.xi[l], result.place.eta[l], result.proof.distance_square[l]);
        else
          doubts.push_back(
            {i + l, {result.place.xi[l], result.place.eta[l]}, result.proof.distance_square[l]});
    }
  for (std::size_t i = 0; i < doubts.size(); i += pack_size)
    {
      const auto result = nearest_point_second(gather(corners, [&](const int l) {
        return doubts[std::min(i + l, doubts.size() - 1)].pair;
      }));
      for (int l = 0; l < pack_size && i + l < doubts.size(); ++l)
        {
          auto &doubt = doubts[i + l];
          if (result.proof.holds[l] > 0 || result.proof.distance_square[l] < doubt.distance_square)
            {
              doubt.best            = {result.place.xi[l], result.place.eta[l]};
              doubt.distance_square = result.proof.distance_square[l];
            }
          if (!(result.proof.holds[l] > 0))
            {
              const auto exact      = nearest_point_exact(corners(doubt.pair), doubt.best);
              doubt.best            = exact.place;
              doubt.distance_square = exact.distance_square;
            }
          found(doubt.pair, doubt.best.xi, doubt.best.eta, doubt.distance_square);
        }
    }
}
} // namespace coracle::contact
