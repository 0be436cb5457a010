// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/local_minimum.h>
#include <coracle/contact/nearest_point_boxes.h>
#include <coracle/contact/nearest_point_pack.h>

namespace coracle::contact
{
NearestPointPack
nearest_point_first(const Bilinear<Pack8> &facets)
{
  const DistanceAlongEta<Pack8> distance(facets);
  NearestPointPack              result;
  result.place = local_minimum(facets, distance, best_sample<3>(distance));
  result.proof = prove_global(facets, result.place, 1);
  return result;
}

NearestPointPack
nearest_point_second(const Bilinear<Pack8> &facets)
{
  const auto                    turned = transposed(facets);
  const DistanceAlongEta<Pack8> distance(turned);
  const auto                    found = local_minimum(turned, distance, best_sample<7>(distance));
  NearestPointPack              result;
  result.place = {found.eta, found.xi};
  result.proof = prove_global(facets, result.place, 5);
  return result;
}

NearestNaturalPoint
nearest_point_exact(const NearestPointBatch::Corners &corners, const NaturalPoint<double> &best)
{
  const auto facet = make_bilinear(corners);
  const auto place = nearest_point_boxes(facet, best);
  const auto x     = evaluate(facet, place).place;
  return {place, dot(x, x)};
}

NaturalPoint<double>
nearest_natural_point(const NearestPointBatch::Corners &corners)
{
  NaturalPoint<double> result{};
  NearestPointBatch    batch;
  batch.find(
    1,
    [&](const std::size_t) { return corners; },
    [&](const std::size_t, const double xi, const double eta, const double) {
      result = {xi, eta};
    });
  return result;
}
} // namespace coracle::contact
