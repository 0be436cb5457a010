// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/bilinear.h>

namespace coracle::contact
{
/**
 * Nearest point of any bilinear facet, convex or not: strips of eta that cannot
 * hold a nearer point than the best one known are dropped, in the others xi is
 * narrowed likewise, and what is left is halved until the distance is convex or
 * monotonic there.
 * The result's distance exceeds the smallest by at most 1e-10 of the facet's size.
 */
NaturalPoint<double> minimise_by_strips(const Bilinear<double> &facet);
} // namespace coracle::contact
