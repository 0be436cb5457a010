# SPDX-License-Identifier: GPL-3.0-or-later
"""The front and the height of a collapsing column of water follow the measurements of Martin & Moyce (1952)."""
import bisect

from run_case import Test

WIDTH, GRAVITY = 0.05715, 9.81
# Table 2, n^2 = 2: T = t sqrt(2 g / a), Z = x / a. One row beyond Z = 3, to interpolate to.
FRONT = {1.11: 0.41, 1.22: 0.84, 1.44: 1.19, 1.67: 1.43, 1.89: 1.63, 2.11: 1.83, 2.33: 1.98, 2.56: 2.20,
         2.78: 2.32, 3.00: 2.51, 3.22: 2.65, 3.44: 2.83}
# Table 6: tau = t sqrt(g / a), H = y / (2 a).
HEIGHT = {0.94: 0.56, 0.89: 0.77, 0.83: 0.93, 0.78: 1.08, 0.72: 1.28, 0.67: 1.46, 0.61: 1.66, 0.56: 1.84,
          0.50: 2.00, 0.44: 2.21, 0.39: 2.45, 0.33: 2.70, 0.28: 3.06}


def interpolate(x, places, values):
    i = min(max(bisect.bisect(places, x), 1), len(places) - 1)
    return values[i - 1] + (x - places[i - 1]) / (places[i] - places[i - 1]) * (values[i] - values[i - 1])


def errors(computed, measured, wanted, shift=0.0):
    """Relative, at the measured times of places that are `wanted`; both map a place to its time."""
    times, places = list(computed.values()), list(computed)
    return [interpolate(time - shift, times, places) / place - 1 for place, time in measured.items()
            if wanted(place)]


def main():
    test = Test()
    result = test.run("column_collapse/column_collapse.prm", {"Output/Particle format": "none"})
    test.check("no particle is lost", min(result["particles"]) == max(result["particles"]))
    test.check("the verdict is OK", "verdict: OK" in result.text)

    times, front, height = result["time [s]"], {1.0: 0.0}, {}
    for place in FRONT:
        inside = result[f"water.front {place:.2f}.particles"]
        front[place] = next(t for t, n in zip(times, inside) if n > 0) * (2 * GRAVITY / WIDTH) ** 0.5
    for place in HEIGHT:
        inside = result[f"water.height {place:.2f}.particles"]
        height[place] = max(t for t, n in zip(times, inside) if n > 0) * (GRAVITY / WIDTH) ** 0.5

    # The clock of the experiment starts when the diaphragm has burnt: at most 0.15 is free.
    shifts = [0.01 * i for i in range(-15, 16)]
    worst = min((max(map(abs, errors(front, FRONT, lambda z: z <= 3, s))), s) for s in shifts)
    test.band(f"front, largest error, clock shifted by {worst[1]:.2f}", worst[0], 0, 0.08)
    test.band("height, largest error", max(map(abs, errors(height, HEIGHT, lambda h: True))), 0, 0.07)
    test.finish()


main()
