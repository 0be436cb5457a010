# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshless water sloshes with the frequency of linear theory, keeps its volume and its energy."""
from run_case import Test


def frequency(times, values, mean):
    """From the first and last time that the values pass their mean."""
    passes = [t0 + (mean - a) / (b - a) * (t1 - t0)
              for t0, t1, a, b in zip(times[1:], times[2:], values[1:], values[2:]) if (a - mean) * (b - mean) < 0]
    return 0.5 * (len(passes) - 1) / (passes[-1] - passes[0])


test = Test()
for case, width, exact in (("sloshing", 0.5, 1.1966), ("longer", 1.0, 0.7582), ("deeper", 0.6, 1.1385)):
    values = {"Output/Particle format": "none", "Bodies/water/Spacing": f"{0.05 * width} m",
              "Time/Largest step": "10 ms", "End time": f"{3.2 / exact} s"}
    result = test.run(f"sloshing/{case}.prm", values)
    test.check(f"{case}: the verdict is OK", "verdict: OK" in result.text)
    found = frequency(result["time [s]"], result["water.centre.x [m]"], 0.5 * width)
    test.band(f"{case}: frequency over that of linear theory", found / exact, 0.98, 1.02)
    drift = max(map(abs, result["water.volume_drift"])) * 1000 / result["step"][-1]
    test.band(f"{case}: volume drift per 1000 steps", drift, 0, 1e-3)
test.finish()
