// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace coracle
{
/**
 * Does the segment between a and b lie across the half line from p towards
 * larger x? Half open in y, so that of the two segments that meet at the height
 * of p exactly one, none or both count, as parity needs; and the same for
 * (a, b) and (b, a) to the last bit, so that shapes that share a segment agree.
 *
 * A and P have x and y at [0] and [1]; other components are not looked at.
 */
template <typename A, typename P>
bool
crosses_half_line(const A &a, const A &b, const P &p)
{
  const bool a_below = a[1] <= p[1], b_below = b[1] <= p[1];
  if (a_below == b_below)
    return false;
  const A &low = a_below ? a : b, &high = a_below ? b : a;
  return (high[0] - low[0]) * (p[1] - low[1]) > (p[0] - low[0]) * (high[1] - low[1]);
}
} // namespace coracle
