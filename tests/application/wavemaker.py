# SPDX-License-Identifier: GPL-3.0-or-later
"""A piston in meshless water makes waves as high as linear theory has them, H/S = 0.499, 0.982 and 1.682
at k h = 0.5, 1 and 2."""
from run_case import Test

test = Test()
# H / S, stroke, period, end of the run and of the flume, both shorter than in the case, points in a metre.
for case, exact, stroke, period, end, length, n in (("longer", 0.499, 0.040, 4.1733, 18, 30, 10),
                                                    ("wavemaker", 0.982, 0.020, 2.2987, 11, 18, 10),
                                                    ("shorter", 1.682, 0.012, 1.4447, 9, 14, 20)):
    values = {"Output/Particle format": "none", "Bodies/water/Spacing": 1 / n, "End time": end,
              "Bodies/piston/Mesh/Subdivisions": f"{round(0.3 * n)}, {round(1.3 * n)}",
              "Bodies/water/Upper corner": f"{length}, 1",
              "Grid/Upper corner": f"{length}, 1.5"}
    result = test.run(f"wavemaker/{case}.prm", values)
    test.check(f"{case}: the verdict is OK", "verdict: OK" in result.text)
    last = [height for time, height in zip(result["time [s]"], result["water.gauge.height [m]"])
            if time >= end - period]
    test.band(f"{case}: wave height over theory's", (max(last) - min(last)) / (exact * stroke), 0.9, 1.1)
    test.band(f"{case}: drift of the water's volume", max(map(abs, result["water.volume_drift"])), 0, 1e-4)
test.finish()
