// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/bilinear.h>

namespace coracle::contact
{
/**
 * Nearest point of any bilinear facet, however warped: a box of natural
 * coordinates that cannot hold a nearer point than the best one known is
 * dropped, and so is one whose local minimum is proven to be its nearest point;
 * others are halved along their longer side.
 *
 * For the few pairs that the packs of nearest_point_pack.h leave in doubt. The result's
 * distance exceeds the smallest by at most 1e-10 of the facet's size.
 *
 * @param best a point of the facet, the nearer the better
 */
NaturalPoint<double> nearest_point_boxes(const Bilinear<double>     &facet,
                                         const NaturalPoint<double> &best);
} // namespace coracle::contact
